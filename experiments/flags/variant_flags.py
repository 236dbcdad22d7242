"""Flags of launchers that run a suite again and again, moved or in parts."""

from collections.abc import Mapping
import dataclasses
import pathlib
from typing import Any

from absl import flags

from waggle_tasks import suites
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.flags import engine_flag, foresight, receiver_flag
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.studies import variants
from waggle_tasks.protocol import checks

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()


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
  engine_flag.define()
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


def run(
  command: str, known: Mapping[str, variants.Variant]
) -> variants.Results:
  """Runs the variants that the flags ask for, one after the other.

  Each is a suite of its own; ended at any moment, the same command goes on
  where it was.

  Args:
    command: The launcher's name.
    known: All there are, by name.

  Returns:
    By name, the rows of each one.

  Raises:
    WaggleError: if a flag names what does not exist, or the suite cannot run.
  """
  values: dict[str, Any] = flags.FLAGS.flag_values_dict()
  suite, wanted, names = (values[name] for name in ('suite', 'case', 'variant'))
  cases = suites.find(suite)
  for name in wanted:
    checks.choice('case', name, [c.name for c in cases], suites.SuiteError)
  for name in names:
    checks.choice('variant', name, [*known], suites.SuiteError)
  asked = [f'--receiver={each}'] if (each := receiver()) is not None else []
  engine, _ = engine_flag.engine()
  moved = {
    name: [
      dataclasses.replace(
        case, scene=dataclasses.replace(case.scene, **known[name].changes)
      )
      for case in cases
      if not wanted or case.name in wanted
    ]
    for name in names or known
  }
  for name, some in moved.items():
    foresight.tell([case.scene for case in some], known[name].receiver)
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.studies import runner, suite_study

  results = {}
  for name, some in moved.items():
    print(f'{name}: {known[name].label}', flush=True)
    line = provenance.command_line(
      command, [f'--suite={suite}', *asked, f'--variant={name}']
    )
    results[name] = runner.run(
      suite_study.Suite(some, known[name].receiver, run_page.leave),
      pathlib.Path(values['output']) / name, engine, line,
    )  # fmt: skip
  return results
