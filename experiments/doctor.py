"""Checks that this machine can run the tasks, and says what to mend.

It looks at the installed versions against the pins of waggle_tasks, renders a
640x480 frame, and looks at the disk that runs are written to. Exit status: 0
when all is well, 1 when a check failed.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import gl, health

_OUTPUT = flags.DEFINE_string(
  'output', '.', 'Folder that runs will be written under.'
)
_TIMEOUT_S = launch.define_positive_float(
  'timeout_s', gl.TIMEOUT_S, 'Seconds to wait for the rendered frame.'
)


def main(argv: Sequence[str]) -> int:
  """Prints every check as it is made; returns 1 when one failed."""
  del argv  # All is in the flags.
  failed = 0
  for check in health.checks(_TIMEOUT_S.value, pathlib.Path(_OUTPUT.value)):
    print(check, flush=True)
    failed += bool(check.mend)
  print(f'{failed} to mend' if failed else 'all is well')
  return 1 if failed else 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__, check_versions=False))
