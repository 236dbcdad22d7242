"""Takes parts out of the receivers and shows what each of them is good for.

Both trackers with both kinds of templates, and then, one at a time, without
null separators, without the confirmation by a final null, and without the
forward-backward check. Each variant is a suite of its own in the output
folder; ended at any moment, the same command goes on where it was.
"""

from collections.abc import Sequence
import sys

from waggle_tasks.experiments import ablations, launch, variant_runner

variant_runner.define('paper', 'runs/ablate')


def main(argv: Sequence[str]) -> int:
  """Runs the variants and prints the table; 0 when it is done."""
  del argv
  results = variant_runner.run('ablate', ablations.ABLATIONS)
  print(ablations.report(results))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
