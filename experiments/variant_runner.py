"""Runs a suite again and again, each time with something moved or left out.

Each variant is a suite of its own in the output folder; ended at any moment,
the same command goes on where it was.
"""

from collections.abc import Mapping
import dataclasses
import pathlib
from typing import Any

from absl import flags

from waggle_tasks import suites
from waggle_tasks.agents import receivers
from waggle_tasks.experiments import launch, provenance, receiver_flag
from waggle_tasks.protocol import checks

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

Results = Mapping[str, list[dict[str, Any]]]


@dataclasses.dataclass(frozen=True)
class Variant:
  """What is moved, or left out.

  Attributes:
    label: Its description, for tables.
    changes: Fields of `Scenario` and their new values.
    receiver: The receiver.
  """

  label: str
  changes: dict[str, Any] = dataclasses.field(default_factory=dict)
  receiver: str = 'klt'


def define(suite: str, output: str) -> None:
  """Defines the flags for the launcher that calls this.

  Args:
    suite: The default suite.
    output: The default folder.
  """
  known = ', '.join(suites.SUITES)
  flags.DEFINE_string('suite', suite, f'One of {known}.')
  receiver_flag.define(None)
  flags.DEFINE_list('case', [], 'Only these cases, by name.')
  flags.DEFINE_list('variant', [], 'Only these variants, by name.')
  flags.DEFINE_integer(
    'workers', None, 'How many processes; unset, one for each core.'
  )
  flags.DEFINE_string('output', output, 'Folder of the results.')


def receiver() -> str | None:
  """The receiver that the flags ask for, None without one.

  Raises:
    ReceiverError: if it is not known.
  """
  name = flags.FLAGS['receiver'].value
  if name is not None:
    receivers.make(name)
  return name


def run(command: str, variants: Mapping[str, Variant]) -> Results:
  """Runs the variants that the flags ask for.

  Args:
    command: The launcher's name.
    variants: All there are, by name.

  Returns:
    By name, the rows of each one's results.jsonl.

  Raises:
    WaggleError: if a flag names what does not exist, or the suite cannot run.
  """
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments import suite_runner

  values: dict[str, Any] = flags.FLAGS.flag_values_dict()
  suite, wanted, names = (values[name] for name in ('suite', 'case', 'variant'))
  cases = suites.find(suite)
  for name in wanted:
    checks.choice('case', name, [c.name for c in cases], suites.SuiteError)
  for name in names:
    checks.choice('variant', name, [*variants], suites.SuiteError)
  chosen = [c for c in cases if not wanted or c.name in wanted]
  workers = launch.worker_count('workers', values['workers'])
  asked = [f'--receiver={each}'] if (each := receiver()) is not None else []
  results = {}
  for name in names or variants:
    variant = variants[name]
    print(f'{name}: {variant.label}', flush=True)
    line = provenance.command_line(
      command, [f'--suite={suite}', *asked, f'--variant={name}']
    )
    folder = pathlib.Path(values['output']) / name
    moved = [_moved(case, variant) for case in chosen]
    results[name] = suite_runner.run(
      moved, variant.receiver, folder, workers, line
    )
  return results


def _moved(case: suites.Case, variant: Variant) -> suites.Case:
  scene = dataclasses.replace(case.scene, **variant.changes)
  return dataclasses.replace(case, scene=scene)
