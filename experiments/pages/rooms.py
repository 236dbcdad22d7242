"""The rooms of this project and who imports whom, as a picture.

A table of all rooms by all rooms: a row is a room, a column what it imports,
a number how many imports there are. Rooms are in the order of their floors, so
that an import that runs up would stand right of the diagonal.
"""

import collections
from collections.abc import Mapping

from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import imports, provenance
from waggle_tasks.experiments.results import palette

COMMANDS, SCENARIOS = 'commands', 'scenarios'
COMMON, SETTINGS = 'common', 'settings'
ROOMS = (
  COMMON, 'protocol', SETTINGS, 'agents', 'entities', 'arenas', 'tasks',
  SCENARIOS, 'rl', 'machine', 'record', 'episodes', 'studies', 'results',
  'pages', 'video', 'bench_parts', 'claim_parts', 'flags', COMMANDS,
)  # fmt: skip
# Modules beside the rooms.
_BESIDE = {
  '_version': COMMON, 'doors': COMMON, 'errors': COMMON, 'msh': COMMON,
  'runtime': COMMON, 'appearance': SETTINGS, 'eyes': SETTINGS,
  'sensor': SETTINGS,
  '__main__': COMMANDS,
}  # fmt: skip
_CELL, _LEFT, _ABOVE = 34, 108, 96  # Units of the SVG.
_TURN_DEG = -45


def room_of(module: str) -> str:
  """The room of a module, by its name."""
  first, *rest = module.split('.')[1:]
  if first == 'experiments':
    return rest[0] if rest[0] in ROOMS else COMMANDS
  return first if first in ROOMS else _BESIDE.get(first, SCENARIOS)


def counts() -> dict[tuple[str, str], int]:
  """How many imports one room has of another one."""
  out: collections.Counter[tuple[str, str]] = collections.Counter()
  paths = {
    module: path
    for module, path in provenance.source_paths().items()
    if path.name != '__init__.py'
  }
  for module, path in paths.items():
    for other in paths.keys() & {*imports.named(module, path)}:
      out[room_of(module), room_of(other)] += 1
  return dict(out)


def draw(found: Mapping[tuple[str, str], int]) -> markup.Markup:
  """The table as an SVG file."""
  size = _CELL * len(ROOMS)
  out = []
  for i, row in enumerate(ROOMS):
    middle = _ABOVE + _CELL * (i + 0.5)
    out.append(plot.text(_LEFT - 8, middle + 4, row, text_anchor='end'))
    x = _LEFT + _CELL * (i + 0.5)
    turn = f'rotate({_TURN_DEG} {x:g} {_ABOVE - 8})'
    out.append(plot.text(x, _ABOVE - 8, row, transform=turn))
    for j, column in enumerate(ROOMS):
      out += _cell(i, j, found.get((row, column), 0))
  background = markup.tag('rect', width='100%', height='100%', fill='#fff')
  return markup.tag(
    'svg', background, *out, xmlns='http://www.w3.org/2000/svg',
    viewBox=f'0 0 {_LEFT + size + 70} {_ABOVE + size + 10}', role='img',
    font_family='sans-serif', font_size='13',
    aria_label='how many imports each room has of each other one',
  )  # fmt: skip


def _cell(i: int, j: int, count: int) -> list[markup.Markup]:
  x, y = _LEFT + _CELL * j, _ABOVE + _CELL * i
  fill = palette.GREY if i == j else '#f2f4f6'
  if count and i != j:
    fill = palette.SKY if j < i else palette.VERMILLION
  box = markup.tag(
    'rect', x=x, y=y, width=_CELL, height=_CELL, fill=fill, stroke='#fff'
  )
  if not count or i == j:
    return [box]
  word = plot.text(
    x + _CELL / 2, y + _CELL / 2 + 4, str(count), text_anchor='middle',
    fill=palette.ink(fill),
  )  # fmt: skip
  return [box, word]
