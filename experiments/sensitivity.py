"""Reruns a suite with each open choice moved both ways, and shows what changes.

The paper leaves choices open: how large and how long gestures are, how the
room looks, where the eye sits, how corners are picked. Each of them is moved
alone, up and down; then every vehicle starts with a jitter of 1 cm, seeds 0 to
9. --receiver does it for another one, whose own numbers stay. Each variant is a
suite of its own in the output folder; ended at any moment, the same command
goes on where it was.
"""

from collections.abc import Sequence
import sys

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import variant_flags
from waggle_tasks.experiments.studies import variants

variant_flags.define('standard', 'runs/sensitivity')


def main(argv: Sequence[str]) -> int:
  """Runs the variants and prints which cases change; 0 when it is done."""
  del argv
  moved = variants.VARIANTS
  if (name := variant_flags.receiver()) is not None:
    moved = variants.of(name)
  results = variant_flags.run('sensitivity', moved)
  print(variants.report(results))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
