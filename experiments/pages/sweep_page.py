"""The page of a sweep: its envelope, its limits and all that failed."""

from collections.abc import Sequence
import itertools
import pathlib

from waggle_tasks.experiments.pages import document, heat_map, markup
from waggle_tasks.experiments.record import (
  eye_fields,
  provenance,
  scenario_fields,
)
from waggle_tasks.experiments.results import (
  envelope,
  heat,
  intervals,
  sweep_fit,
  sweep_tables,
)

_MOST_FAILURES = 500  # Listed with their commands; results.csv has all.

tag = markup.tag


def write(
  folder: pathlib.Path, rows: Sequence[envelope.Row], origin: dict | None
) -> pathlib.Path:
  """Makes the page of a sweep and returns its path.

  Args:
    folder: Where it is put.
    rows: The results of one sweep or of several.
    origin: provenance.json of the sweep; None for several.
  """
  return document.save(folder, draw(rows, folder.resolve().name, origin))


def draw(
  rows: Sequence[envelope.Row], name: str, origin: dict | None
) -> markup.Markup:
  """The page as text.

  Args:
    rows: The results.
    name: What the sweep is called.
    origin: See `write`.
  """
  maps = envelope.panels(rows)
  body = [
    _head(rows, name),
    _envelope(maps),
    failures(envelope.failures(rows)),
    *map(_table, maps),
    made_by(origin),
  ]
  return document.page(f'{name} \u2013 waggle sweep', body)


def _head(rows: Sequence[envelope.Row], name: str) -> markup.Markup:
  got = envelope.count(rows)
  misled = got.wrong + got.unauthorised
  receivers = ', '.join(sorted({row.receiver for row in rows}))
  return tag(
    'header',
    tag('h1', name),
    tag(
      'p',
      document.chip(not got.wrong, f'{got.wrong} wrong messages'),
      ' ',
      document.chip(
        not got.unauthorised, f'{got.unauthorised} unauthorised motions'
      ),
      class_='chips',
    ),
    *(tag('p', line) for line in sweep_tables.totals(rows)),
    tag(
      'p',
      f'receiver {receivers}; {len(rows)} cases;'
      f' {sum(row.simulated_s for row in rows):.0f} s simulated',
      class_='faint',
    ),
    class_='failed' if misled else None,
  )


def _envelope(maps: Sequence[envelope.Panel]) -> markup.Markup:
  figures = [
    tag(
      'figure',
      tag('figcaption', tag('b', heat.title(each))),
      heat_map.draw(each),
    )
    for each in maps
  ]
  fits = [tag('p', line) for each in maps for line in sweep_fit.lines(each)]
  return tag(
    'section',
    tag('h2', 'The envelope'),
    tag('div', *figures, class_='maps'),
    tag(
      'p',
      'each cell: exposures that were right, of all; blank cells were not'
      ' flown',
      class_='faint',
    ),
    tag('p', sweep_tables.weak_cells(maps)[0].rstrip(':.') + '.'),
    *fits,
  )


def failures(found: Sequence[envelope.Failure]) -> markup.Markup | None:
  """What failed, with the commands that repeat it."""
  if not found:
    return None
  items = []
  shown = found[:_MOST_FAILURES]
  for row, members in itertools.groupby(shown, lambda each: each.row):
    reasons = (
      tag('div', tag('b', each.observer), f': {each.reason}')
      for each in members
    )
    name = tag('b', row.case)
    items.append(tag('li', name, *reasons, tag('pre', repeat(row))))
  more = len(found) - len(shown)
  return tag(
    'section',
    tag('h2', 'What failed'),
    tag('ul', *items),
    tag('p', f'and {more} more, see results.csv') if more else None,
    class_='failed',
  )


def repeat(row: envelope.Row) -> str:
  """The shell line that flies a case again, with its report."""
  given = [f'--receiver={row.receiver}']
  usual = scenario_fields.defaults()
  whole = eye_fields.filled(row.scenario, usual, row.cell)
  given += scenario_fields.flags(whole)
  return provenance.command_line('broadcast', given)


def _table(panel: envelope.Panel) -> markup.Markup:
  """Every cell of a map with its limits."""
  lines: list[list[markup.Content]] = []
  for (down, across), rows in panel.cells.items():
    got = envelope.count(rows)
    low, high = intervals.clopper_pearson(got.right, got.exposures)
    lines.append(
      [
        heat.label(down), heat.label(across), f'{got.right}/{got.exposures}',
        f'{low:.1%} to {high:.1%}', got.wrong, got.unauthorised,
      ]
    )  # fmt: skip
  header = (
    heat.axis(panel.down), heat.axis(panel.across), 'right',
    '95 % interval (Clopper-Pearson)', 'wrong', 'unauthorised',
  )  # fmt: skip
  return tag(
    'section',
    tag('h2', ': '.join(filter(None, ('Every cell', heat.title(panel))))),
    markup.table(header, lines),
  )


def made_by(origin: dict | None) -> markup.Markup | None:
  """What made results; see `write`."""
  if origin is None:
    return None
  versions = ', '.join(f'{n} {v}' for n, v in origin['versions'].items())
  return tag(
    'section',
    tag('h2', 'How it was made'),
    tag('pre', origin['command']),
    tag('p', f'{origin["renderer"]}; {versions}', class_='faint'),
    tag('p', f'sources {origin["source_digest"]}', class_='faint'),
  )
