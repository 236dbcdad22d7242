"""The page of a link: what each scheme delivers, and all that failed."""

import base64
from collections.abc import Sequence
import pathlib

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import document, markup, sweep_page
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import (
  envelope,
  goodput,
  link_figure,
  link_tables,
)
from waggle_tasks.experiments.results import figures as figures_lib
from waggle_tasks.experiments.studies import (
  case_rows,
  link_cases,
  link_conditions,
)

tag = markup.tag


def write(
  folder: pathlib.Path,
  rows: Sequence[goodput.Row],
  airtime_s: float | None = None,
) -> pathlib.Path:
  """Writes everything that follows from a link's results.

  Args:
    folder: Its own.
    rows: Its results, finished or not.
    airtime_s: See `link_tables.report`; None for the usual one.

  Returns:
    The page.
  """
  rows = goodput.whole(rows)
  if not rows:
    raise archive.ArchiveError(f'{folder} holds no whole message yet')
  airtime_s = airtime_s or link_tables.usual_airtime_s()
  text = link_tables.report(rows, airtime_s)
  files.replace(folder / case_rows.SUMMARY, f'{text}\n')
  origin = folder / case_rows.PROVENANCE
  known = archive.read_json(origin) if origin.exists() else None
  picture = None
  if figures_lib.can_draw():
    picture = link_figure.draw(rows, folder)[0].read_bytes()
  name = folder.resolve().name
  return document.save(folder, draw(rows, name, known, airtime_s, picture))


def draw(
  rows: Sequence[goodput.Row],
  name: str,
  origin: dict | None,
  airtime_s: float,
  picture: bytes | None,
) -> markup.Markup:
  """The page as text.

  Args:
    rows: The results of whole messages.
    name: What the link is called.
    origin: provenance.json of the link, if it is there.
    airtime_s: See `link_tables.report`.
    picture: An SVG of `link_figure`, if there is one.
  """
  body = [
    _head(rows, name),
    _picture(picture),
    tag(
      'section',
      tag('h2', 'What is delivered'),
      *(markup.table(*each) for each in link_tables.tables(rows, airtime_s)),
      *(
        tag('p', line, class_='faint') for line in link_tables.legend(airtime_s)
      ),
      _conditions(rows),
    ),
    sweep_page.failures(envelope.failures(rows)),
    sweep_page.made_by(origin),
  ]
  return document.page(f'{name} \u2013 waggle link', body)


def _head(rows: Sequence[goodput.Row], name: str) -> markup.Markup:
  got = envelope.count(rows)
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
    *(tag('p', line) for line in link_tables.totals(rows)),
    class_='failed' if got.wrong or got.unauthorised else None,
  )


def _picture(picture: bytes | None) -> markup.Markup | None:
  if picture is None:
    return None
  data = base64.b64encode(picture).decode()
  return tag(
    'section',
    tag('h2', 'Delivery and goodput'),
    tag(
      'img',
      src=f'data:image/svg+xml;base64,{data}',
      style='max-width: 100%',
      alt='messages delivered in each condition, a line for each scheme',
    ),
  )


def _conditions(rows: Sequence[goodput.Row]) -> markup.Markup:
  """What the conditions are."""
  names = dict.fromkeys(row.cell[link_cases.CONDITION] for row in rows)
  known = link_conditions.CONDITIONS
  items = [
    tag('li', tag('b', each), f': {known[each].text}')
    for each in names
    if each in known
  ]
  return tag('ul', *items)
