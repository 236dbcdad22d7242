"""Flies receivers over the tiers of the board and ranks what they deliver.

A tier is a frozen suite of scenes, danced in the paper's language and in
another. Seeds are public; with --referee=NUMBER they follow from a number that
nobody else knows. A receiver is shown what it can read; what it cannot is told.
Leaves board.json, results.jsonl, results.csv, a text, a picture of each tier
and a page. Ended at any moment, the same command goes on where it was. Exit
status 0 when no observer read a wrong message or moved without a right one, 1
otherwise, 2 on bad input. --merge flies nothing: it makes one board of those in
FOLDERs, which must be of the same suite, seeds, sources and versions.
"""

from collections.abc import Sequence
import pathlib
import shutil
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import engine_flag, receiver_flag
from waggle_tasks.experiments.pages import board_page
from waggle_tasks.experiments.record import folders, provenance
from waggle_tasks.experiments.results import board_file, board_tables
from waggle_tasks.experiments.studies import (
  board_cases,
  board_tiers,
  sweep_cases,
)

ARGUMENTS = '[FOLDER ...]'
# Of a core: for an episode, and for a simulated second of one observer with its
# receiver, whose camera stands still or moves: then all of an image is drawn,
# and what is seen is laid over what was seen before.
_START_S, _STILL_S, _MOVING_S = 2.0, 0.09, 0.7

_TIERS = flags.DEFINE_list(
  'tiers', [*board_tiers.TIERS], f'Some of {", ".join(board_tiers.TIERS)}.'
)
_RECEIVERS = flags.DEFINE_list(
  'receivers', ['klt', 'view_bank', 'joint'],
  f'Receivers with a comma between them. Each: {receiver_flag.RULE}'
  ' Numbers of one receiver are parted by semicolons here.',
)  # fmt: skip
_LANGUAGES = flags.DEFINE_list(
  'languages', [*board_tiers.LANGUAGES],
  f'Some of {", ".join(board_tiers.LANGUAGES)}.',
)  # fmt: skip
_REFEREE = flags.DEFINE_integer(
  'referee', None, 'A number from which private seeds follow; unset, seeds are'
  ' public.',
)  # fmt: skip
engine_flag.define()
_OUTPUT = flags.DEFINE_string('output', 'runs/board', 'Result folder.')
_MERGE = flags.DEFINE_boolean(
  'merge', False, 'Only make one board of those in FOLDERs, in --output.'
)


def main(argv: Sequence[str]) -> int:
  """Flies, or merges, a board and returns the exit status."""
  folder = pathlib.Path(_OUTPUT.value)
  if _MERGE.value:
    return _merge(argv[1:], folder)
  if argv[1:]:
    raise flags.Error(f'takes only flags, --name=value: got {argv[1]!r}.')
  readers = [each.replace(';', ',') for each in _RECEIVERS.value]
  plan = board_cases.Plan(
    _TIERS.value, readers, _REFEREE.value, _LANGUAGES.value
  )
  cases, unread = board_cases.cases(plan)
  # Imported here: to merge boards, no simulator is needed.
  from waggle_tasks.experiments.studies import board_study, runner
  from waggle_tasks.experiments.video import board_films, board_pictures

  engine, what = engine_flag.engine()
  workers = engine_flag.workers()
  cases, lacking = board_films.can_be_made(cases)
  for line in lacking:
    print(f'not flown: {line}', file=sys.stderr)

  def tell(waiting: Sequence[sweep_cases.Sample]) -> None:
    core_s = sum(map(_core_s, waiting))
    print(
      f'{len(waiting)} of {len(cases)} cases to fly with {what}: about'
      f' {core_s / workers / 60:.0f} min'
    )

  # Files do not tell the number of a referee.
  given = [
    '--referee=NUMBER' if each.startswith('--referee=') else each
    for each in launch.given_flags()
  ]
  command = provenance.command_line('board', given)
  study = board_study.Board(cases, board_films.Films(), tell)
  rows = runner.run(study, folder, engine, command)
  board_pictures.draw(
    plan.tiers, plan.referee, folder / board_study.PICTURES,
    folder / board_study.FILMS,
  )  # fmt: skip
  known = board_study.readers(readers)
  board = board_file.Board.of(plan, known, unread, rows, command)
  return _show(folder, board)


def _core_s(case: sweep_cases.Sample) -> float:
  """How long a core takes for a case, about."""
  scene = case.scene
  moves = scene.drift.observer_hover != 'none' or scene.estimator != 'none'
  second_s = _MOVING_S if moves or scene.air.wind_mps else _STILL_S
  return _START_S + second_s * scene.episode_s * scene.observers


def _merge(names: Sequence[str], folder: pathlib.Path) -> int:
  """Makes one board of several."""
  if len(names) < 2:
    raise flags.Error(f'--merge takes two FOLDERs or more: got {len(names)}.')
  if not _OUTPUT.present:
    raise flags.Error('--merge needs --output, a new folder for the board.')
  boards = {name: board_file.read(pathlib.Path(name)) for name in names}
  merged = board_file.merged(boards)
  with folders.new_folder(folder) as draft:
    for name in reversed(names):
      pictures = pathlib.Path(name, board_page.PICTURES)
      if pictures.is_dir():
        shutil.copytree(
          pictures, draft / board_page.PICTURES, dirs_exist_ok=True
        )
    board_file.write(draft, merged)
    board_page.write(draft, merged, folder.resolve().name)
  print(board_tables.report(merged))
  print(f'\n{len(merged.results)} results, {folder / "index.html"}')
  return 0 if board_tables.is_safe(merged) else 1


def _show(folder: pathlib.Path, board: board_file.Board) -> int:
  """Writes and prints a board, and returns the exit status."""
  board_file.write(folder, board)
  page = board_page.write(folder, board, folder.resolve().name)
  print(board_tables.report(board))
  print(f'\n{len(board.results)} results, {page}')
  return 0 if board_tables.is_safe(board) else 1


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
