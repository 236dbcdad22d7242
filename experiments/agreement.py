"""Prints what both sides of a link know, as a file for `waggle decode`.

SOURCE is the name of an agreement, paper or mocom, or of a language;
config.json of a run; a JSON file of a language; or one that was printed here
and changed by hand, which is checked so. What is printed is the codebook, the
pauses, how far from its time a motion may come, the fields of the payload, the
camera, the rate and, where another one is spoken, the language:

waggle agreement mocom > mine.json
waggle decode film.mp4 --agreement=mine.json
"""

from collections.abc import Sequence
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.record import agreement_file

ARGUMENTS = 'SOURCE'


def main(argv: Sequence[str]) -> int:
  """Prints the agreement and returns the exit status."""
  if len(argv) != 2:
    raise flags.Error(f'takes one {ARGUMENTS}: got {argv[1:]}')
  print(agreement_file.text(agreement_file.find(argv[1])), end='')
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
