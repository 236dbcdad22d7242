"""Makes the page of a folder again from the data in it.

FOLDER is a run folder, as `waggle broadcast` leaves one, or the result folder
of `waggle suite`, `sweep`, `link` or `board`; its page is index.html, a
static file that needs neither a server nor a network.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.pages import (
  board_page,
  link_page,
  run_page,
  suite_page,
  sweep_output,
)
from waggle_tasks.experiments.results import board_file, goodput
from waggle_tasks.experiments.studies import board_cases, case_rows

ARGUMENTS = 'FOLDER'


def main(argv: Sequence[str]) -> int:
  """Writes the page and returns the exit status."""
  if len(argv) != 2:
    raise flags.Error(f'takes one {ARGUMENTS}: got {argv[1:]}')
  folder = pathlib.Path(argv[1])
  if (folder / board_file.FILE).exists():
    return _board(folder)
  if (folder / case_rows.JOURNAL).exists():
    rows = case_rows.read_sweep(folder)
    if board_cases.is_board(rows[0].cell):
      return _board(folder)
    shown = link_page if goodput.is_link(rows) else sweep_output
    print(shown.write(folder, rows))
    return 0
  is_suite = (folder / case_rows.RESULTS).exists()
  print((suite_page if is_suite else run_page).write(folder))
  return 0


def _board(folder: pathlib.Path) -> int:
  """Makes the page of a board again."""
  board = board_file.read(folder)
  print(board_page.write(folder, board, folder.resolve().name))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
