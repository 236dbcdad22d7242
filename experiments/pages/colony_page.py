"""The page of a colony: what swarms chose, and how long it took them."""

import base64
from collections.abc import Sequence
import pathlib

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import document, markup, sweep_page
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import (
  colony_figure,
  colony_tables,
  figures,
)
from waggle_tasks.experiments.studies import case_rows, colony_study

tag = markup.tag


def write(
  folder: pathlib.Path, rows: Sequence[colony_study.Row]
) -> pathlib.Path:
  """Writes everything that follows from a colony's results.

  Args:
    folder: Its own.
    rows: Its results.

  Returns:
    The page.
  """
  text = colony_tables.report(rows)
  files.replace(folder / case_rows.SUMMARY, f'{text}\n')
  origin = folder / case_rows.PROVENANCE
  known = archive.read_json(origin) if origin.exists() else None
  picture = None
  if figures.can_draw():
    picture = colony_figure.draw(rows, folder)[0].read_bytes()
  name = folder.resolve().name
  body = [
    tag('header', tag('h1', name), tag('p', colony_tables.legend(rows)[0])),
    _picture(picture),
    tag(
      'section',
      tag('h2', 'What swarms chose'),
      markup.table(*colony_tables.table(rows)),
      *(
        tag('p', line, class_='faint')
        for line in colony_tables.legend(rows)[1:]
      ),
    ),
    _courses(rows),
    sweep_page.made_by(known),
  ]
  return document.save(
    folder, document.page(f'{name} \u2013 waggle colony', body)
  )


def _picture(picture: bytes | None) -> markup.Markup | None:
  if picture is None:
    return None
  data = base64.b64encode(picture).decode()
  return tag(
    'section',
    tag('h2', 'Accuracy and time'),
    tag(
      'img',
      src=f'data:image/svg+xml;base64,{data}',
      style='max-width: 100%',
      alt='share of swarms that chose the best site and their time, against'
      ' the quality of the second site',
    ),
  )


def _courses(rows: Sequence[colony_study.Row]) -> markup.Markup:
  """The state of one swarm of each case over its time."""
  header = ('case', 'site', *(f'{tenth * 10} %' for tenth in range(11)))
  lines = []
  for row in rows:
    swarm = row.case.swarm
    name = f'{swarm.model}, {swarm.vehicles}, {swarm.watching.condition}'
    for site, quality in enumerate(swarm.qualities):
      shares = [f'{each[site]:.0%}' for each in row.course]
      lines.append((name, f'{quality:g}', *shares))
  return tag(
    'section',
    tag('h2', 'One swarm of each case over its time'),
    tag('p', 'Share of the vehicles that are for each site.'),
    markup.table(header, lines),
  )
