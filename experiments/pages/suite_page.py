"""The page of a suite: its tables beside the paper's, failures first.

Every line leads to the page of its run.
"""

from collections.abc import Sequence
import pathlib

from waggle_tasks.experiments.pages import document, markup
from waggle_tasks.experiments.results import suite_tables
from waggle_tasks.experiments.studies import case_rows

Row = case_rows.SuiteRow

tag = markup.tag


def write(folder: pathlib.Path) -> pathlib.Path:
  """Makes the page of a suite's result folder and returns its path.

  Raises:
    ArchiveError: if the folder holds no results, or damaged ones.
  """
  rows = case_rows.read_suite(folder)
  return document.save(folder, draw(rows, folder.resolve().name))


def draw(rows: Sequence[Row], name: str) -> markup.Markup:
  """The page as text.

  Args:
    rows: The results.
    name: What the suite is called.
  """
  body = [
    _head(rows, name),
    _failures(rows),
    *(_group(*each) for each in case_rows.by_group(rows).items()),
    tag('p', suite_tables.CAVEAT, class_='faint'),
  ]
  return document.page(f'{name} \u2013 waggle suite', body)


def _head(rows: Sequence[Row], name: str) -> markup.Markup:
  others = sum(not row.as_expected for row in rows)
  if others:
    words = f'{others} of {len(rows)} cases are not as expected'
  else:
    words = f'all {len(rows)} cases are as expected'
  receivers = ', '.join(sorted({row.receiver for row in rows}))
  simulated_s = sum(row.simulated_s for row in rows)
  return tag(
    'header',
    tag('h1', name, ' ', document.chip(not others, words)),
    tag(
      'p',
      f'receiver {receivers}; {simulated_s:.0f} s simulated; expected is that a'
      ' group passes, or fails as published',
      class_='faint',
    ),
  )


def _link(row: Row) -> markup.Markup:
  return tag('a', row.label, href=f'cases/{row.case}/{document.NAME}')


def _failures(rows: Sequence[Row]) -> markup.Markup | None:
  """Every failed check, those of unexpected cases first."""
  failed = [row for row in rows if not row.passed]
  if not failed:
    return None
  items = []
  for row in sorted(failed, key=lambda row: row.as_published):
    said = 'as published' if row.as_published else 'not as expected'
    causes = [
      tag('li', tag('b', outcome.observer), f': {failure}')
      for outcome in row.outcomes
      for failure in outcome.failures
    ]
    items.append(
      tag('li', _link(row), f' ({row.group}), {said}', tag('ul', *causes))
    )
  return tag(
    'section', tag('h2', 'What failed'), tag('ul', *items), class_='failed'
  )


def _group(group: str, rows: Sequence[Row]) -> markup.Markup:
  """A table in the shape of the paper's, ours beside what is published."""
  cells: list[list[markup.Content]] = []
  for row in rows:
    theirs = suite_tables.published(row) or ('\u2013', '\u2013')
    cells.append(
      [
        _link(row), row.observers, f'{row.correct}/{row.observers}',
        theirs[0], suite_tables.verdict(row.passed), theirs[1],
        document.chip(row.as_expected, _said(row)),
      ]
    )  # fmt: skip
  header = ('configuration', 'N', 'correct', 'paper', 'group', 'paper', '')
  return tag(
    'section',
    tag('h2', group),
    markup.table(header, cells),
    *(tag('p', line) for line in suite_tables.totals(rows)),
  )


def _said(row: Row) -> str:
  if row.as_published:
    return 'as published'
  said = 'passes' if row.passed else 'fails'
  return said if row.published is None else f'{said}, unlike published'
