"""Shows what languages are like: how long, how quick, how far apart.

Prints a line for each: its time and bits, the most that it asks of a vehicle,
which vehicles can fly it, and how far apart its two nearest symbols look, from
which side. Nothing is flown. A language of your own is a JSON file: what
`waggle_tasks.to_plain` makes of a `languages.Language`, such as
{"alphabet": {"waggle_tasks.protocol.levels:Levels": {"count": 4, "reach_m":
0.1, "rise_s": 0.44, "stroke_s": 0.62}}, "coding": {"parity": 1}}; what is left
out has its default. Without a name all languages are shown. --output draws
them.
"""

from collections.abc import Iterator, Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import folders, language_file
from waggle_tasks.experiments.results import language_figure, language_measure

ARGUMENTS = '[NAME or FILE.json ...]'

_OUTPUT = flags.DEFINE_string(
  'output', None,
  'Folder to draw languages.svg and languages.png in; needs matplotlib.',
)  # fmt: skip


def main(argv: Sequence[str]) -> int:
  """Prints the table and draws the picture; returns the exit status."""
  names = argv[1:] or language_file.NAMES
  shown = {name: language_file.find(name) for name in names}
  if _OUTPUT.value is not None:
    folders.check_writable(pathlib.Path(_OUTPUT.value))
  found = {n: language_measure.measure(each) for n, each in shown.items()}
  rows = [each.row(name) for name, each in found.items()]
  print(table.render(language_measure.HEADER, rows))
  print(f'\n{language_measure.ABOUT}')
  for line in _refusals(found):
    print(line)
  if _OUTPUT.value is not None:
    drawn = language_figure.draw(shown, pathlib.Path(_OUTPUT.value))
    print(*drawn, sep='\n')
  return 0


def _refusals(
  found: dict[str, language_measure.Measured],
) -> Iterator[str]:
  """Why vehicles cannot fly what they cannot."""
  for name, each in found.items():
    for dynamics, reason in each.refusals.items():
      if reason:
        yield f'{name}, {dynamics}: {reason}'


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
