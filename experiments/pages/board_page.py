"""The page of a board: its table, and a part with a picture for each tier."""

import base64
import pathlib

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import document, markup
from waggle_tasks.experiments.results import board_file, board_tables
from waggle_tasks.experiments.studies import board_tiers, case_rows

PICTURES = 'pictures'
tag = markup.tag


def write(
  folder: pathlib.Path, board: board_file.Board, name: str
) -> pathlib.Path:
  """Writes the text and the page of a board, and returns the page.

  Args:
    folder: Its own; pictures of tiers are in it.
    board: The board.
    name: What it is called.
  """
  text = board_tables.report(board)
  files.replace(folder / case_rows.SUMMARY, f'{text}\n')
  pictures = {
    tier: path.read_bytes()
    for tier in board_tables.tiers(board)
    if (path := folder / PICTURES / f'{tier}.png').exists()
  }
  return document.save(folder, draw(board, name, pictures))


def draw(
  board: board_file.Board, name: str, pictures: dict[str, bytes]
) -> markup.Markup:
  """The page as text.

  Args:
    board: The board.
    name: What it is called.
    pictures: PNG files by tier, as far as there are any.
  """
  names = board_tables.tiers(board)
  body = [
    _head(board, name),
    _overview(board),
    *(_tier(board, each, pictures.get(each)) for each in names),
    _pairs(board),
    _made_by(board),
  ]
  return document.page(f'{name} \u2013 waggle board', body)


def _head(board: board_file.Board, name: str) -> markup.Markup:
  wrong = sum(each.wrong > 0 for each in board.results)
  moved = sum(each.moved > 0 for each in board.results)
  return tag(
    'header',
    tag('h1', name),
    tag(
      'p',
      document.chip(not wrong, f'{wrong} wrong messages'),
      ' ',
      document.chip(not moved, f'{moved} unauthorised motions'),
      class_='chips',
    ),
    *(tag('p', line) for line in board_tables.heading(board)),
    class_='failed' if wrong or moved else None,
  )


def _overview(board: board_file.Board) -> markup.Markup:
  """What each receiver delivered of each tier, all languages together."""
  names = board_tables.tiers(board)
  rows: list[list[markup.Content]] = []
  for receiver in board.receivers:
    mine = [each for each in board.results if each.receiver == receiver]
    cells = [_share([r for r in mine if r.tier == name]) for name in names]
    rows.append([receiver, *cells, _share(mine)])
  return tag(
    'section',
    tag('h2', 'Delivered'),
    markup.table(('receiver', *names, board_tables.ALL), rows),
    tag(
      'p',
      'messages that every observer read as sent, of those danced in a'
      ' language that the receiver reads',
      class_='faint',
    ),
    *(tag('p', line) for line in board_tables.reasons(board)),
  )


def _share(results: list[board_file.Result]) -> markup.Content:
  """A share as words, with a bar below them."""
  if not results:
    return '-'
  got = board_tables.Tally.of(results)
  if not got.sent:
    return '-'
  percent = 100 * got.delivered / got.sent
  return tag(
    'div',
    f'{got.delivered}/{got.sent}',
    tag(
      'div',
      style=f'height: 4px; width: {percent:.0f}%; background: var(--a)',
    ),
  )


def _tier(
  board: board_file.Board, name: str, picture: bytes | None
) -> markup.Markup:
  rows = [line[1:] for line in board_tables.lines(board, name)]
  image = None
  if picture is not None:
    data = base64.b64encode(picture).decode()
    image = tag(
      'img',
      src=f'data:image/png;base64,{data}',
      style='max-width: 100%',
      alt=f'what observers see in some scenes of the tier {name}',
    )
  return tag(
    'section',
    tag('h2', name),
    tag('p', f'{board_tiers.TIERS[name].text}'),
    image,
    markup.table(board_tables.HEADER[1:], rows),
  )


def _pairs(board: board_file.Board) -> markup.Markup:
  tests = board_tables.pairs(board)
  table = markup.table(board_tables.PAIRS, tests) if tests else None
  legend = [*board_tables.LEGEND, board_tables.PAIRS_LEGEND]
  return tag(
    'section',
    tag('h2', 'Receivers side by side') if tests else None,
    table,
    *(tag('p', line, class_='faint') for line in legend),
  )


def _made_by(board: board_file.Board) -> markup.Markup:
  versions = ', '.join(f'{n} {v}' for n, v in board.versions.items())
  return tag(
    'section',
    tag('h2', 'How it was made'),
    *(tag('pre', command) for command in board.commands),
    tag('p', versions, class_='faint'),
    tag('p', f'sources {board.sources}', class_='faint'),
  )
