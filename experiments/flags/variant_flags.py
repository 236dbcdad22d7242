"""Flags of launchers that run a suite again and again, moved or in parts."""

from collections.abc import Mapping
import pathlib
from typing import Any

from absl import flags

from waggle_tasks import suites
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.flags import engine_flag, receiver_flag
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.studies import variant_runner
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
  command: str, variants: Mapping[str, variant_runner.Variant]
) -> variant_runner.Results:
  """Runs the variants that the flags ask for.

  Args:
    command: The launcher's name.
    variants: All there are, by name.

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
    checks.choice('variant', name, [*variants], suites.SuiteError)
  asked = [f'--receiver={each}'] if (each := receiver()) is not None else []
  return variant_runner.run(
    {name: variants[name] for name in names or variants},
    [c for c in cases if not wanted or c.name in wanted],
    pathlib.Path(values['output']),
    engine_flag.engine()[0],
    [command, f'--suite={suite}', *asked],
    run_page.leave,
  )
