"""Reruns a suite with each open choice moved both ways, and shows what changes.

The paper leaves choices open: how large and how long gestures are, how the
room looks, where the eye sits, how corners are picked. Each of them is moved
alone, up and down; then every vehicle starts with a jitter of 1 cm, seeds 0 to
9. Each variant is a suite of its own in the output folder; ended at any
moment, the same command goes on where it was.
"""

from collections.abc import Sequence
import dataclasses
import pathlib
import sys

from absl import flags

from waggle_tasks import suites
from waggle_tasks.experiments import (
  launch,
  provenance,
  suite_runner,
  variants,
)
from waggle_tasks.protocol import checks

_SUITE = flags.DEFINE_string(
  'suite', 'standard', f'One of {", ".join(suites.SUITES)}.'
)
_CASE = flags.DEFINE_list('case', [], 'Only these cases, by name.')
_VARIANT = flags.DEFINE_list('variant', [], 'Only these variants, by name.')
_WORKERS = flags.DEFINE_integer(
  'workers', None, 'How many processes; unset, one for each core.'
)
_OUTPUT = flags.DEFINE_string(
  'output', 'runs/sensitivity', 'Folder of the results.'
)


def main(argv: Sequence[str]) -> int:
  """Runs the variants and prints which cases change; 0 when it is done."""
  del argv
  cases = suites.find(_SUITE.value)
  known = [case.name for case in cases]
  for wanted in _CASE.value:
    checks.choice('case', wanted, known, suites.SuiteError)
  for wanted in _VARIANT.value:
    checks.choice('variant', wanted, [*variants.VARIANTS], suites.SuiteError)
  cases = [c for c in cases if not _CASE.value or c.name in _CASE.value]
  workers = launch.worker_count(_WORKERS)

  def run(name: str, variant: variants.Variant) -> list[dict[str, object]]:
    print(f'{name}: {variant.label}', flush=True)
    folder = pathlib.Path(_OUTPUT.value) / name
    command = provenance.command_line(
      'sensitivity', [f'--suite={_SUITE.value}', f'--variant={name}']
    )
    moved = [
      dataclasses.replace(
        case, scene=dataclasses.replace(case.scene, **variant.changes)
      )
      for case in cases
    ]
    return suite_runner.run(moved, variant.receiver, folder, workers, command)

  print(variants.report(run, _VARIANT.value or [*variants.VARIANTS]))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
