"""Takes parts out of the receivers and shows what each of them is good for.

Both trackers with both kinds of templates, and then, one at a time, without
null separators, without the confirmation by a final null, and without the
forward-backward check; with --receiver one receiver, and without each of its
switches. Each variant is a suite of its own in the output folder; ended at any
moment, the same command goes on where it was.
"""

from collections.abc import Sequence
import sys

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import variant_flags
from waggle_tasks.experiments.studies import ablations

variant_flags.define('paper', 'runs/ablate')


def main(argv: Sequence[str]) -> int:
  """Runs the variants and prints the table; 0 when it is done."""
  del argv
  chosen = ablations.ABLATIONS
  if (name := variant_flags.receiver()) is not None:
    chosen = ablations.of(name)
  results = variant_flags.run('ablate', chosen)
  print(ablations.report(results, chosen))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
