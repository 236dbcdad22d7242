"""The page of a suite: its tables beside the paper's, failures first.

Every line leads to the page of its run.
"""

from collections.abc import Mapping, Sequence
import itertools
import pathlib

from waggle_tasks.experiments.pages import document, markup
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import suite_tables
from waggle_tasks.experiments.studies import suite_results

RESULTS = suite_results.RESULTS

tag = markup.tag


def write(folder: pathlib.Path) -> pathlib.Path:
  """Makes the page of a suite's result folder and returns its path.

  Raises:
    ArchiveError: if the folder holds no results, or damaged ones.
  """
  return document.save(folder, draw(read(folder), folder.resolve().name))


def read(folder: pathlib.Path) -> list[dict]:
  """The rows of a suite's results.

  Raises:
    ArchiveError: if there are none, or they are damaged.
    FormatError: if a newer program wrote them.
  """
  path = folder / RESULTS
  rows = archive.read_rows(path, suite_results.Row)
  if not rows:
    raise archive.ArchiveError(f'{path} holds no results')
  return rows


def draw(rows: Sequence[Mapping], name: str) -> markup.Markup:
  """The page as text.

  Args:
    rows: The lines of results.jsonl.
    name: What the suite is called.
  """
  groups = [
    (group, list(members))
    for group, members in itertools.groupby(rows, lambda row: row['group'])
  ]
  body = [
    _head(rows, name),
    _failures(rows),
    *(_group(group, members) for group, members in groups),
    tag('p', suite_tables.CAVEAT, class_='faint'),
  ]
  return document.page(f'{name} \u2013 waggle suite', body)


def _as_expected(row: Mapping) -> bool:
  """Whether a case passed, or failed as published."""
  return row['passed'] or _as_published(row)


def _as_published(row: Mapping) -> bool:
  ours = {'correct': row['correct'], 'passed': row['passed']}
  return row['published'] == ours


def _head(rows: Sequence[Mapping], name: str) -> markup.Markup:
  others = len(rows) - sum(map(_as_expected, rows))
  if others:
    words = f'{others} of {len(rows)} cases are not as expected'
  else:
    words = f'all {len(rows)} cases are as expected'
  receivers = ', '.join(sorted({row['receiver'] for row in rows}))
  simulated_s = sum(row['simulated_s'] for row in rows)
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


def _link(row: Mapping) -> markup.Markup:
  return tag('a', row['label'], href=f'cases/{row["case"]}/{document.NAME}')


def _failures(rows: Sequence[Mapping]) -> markup.Markup | None:
  """Every failed check, those of unexpected cases first."""
  failed = sorted((row for row in rows if not row['passed']), key=_as_published)
  if not failed:
    return None
  items = []
  for row in failed:
    said = 'as published' if _as_published(row) else 'not as expected'
    causes = [
      tag('li', tag('b', outcome['observer']), f': {failure}')
      for outcome in row['outcomes']
      for failure in outcome['failures']
    ]
    items.append(
      tag('li', _link(row), f' ({row["group"]}), {said}', tag('ul', *causes))
    )
  return tag(
    'section', tag('h2', 'What failed'), tag('ul', *items), class_='failed'
  )


def _group(group: str, rows: Sequence[Mapping]) -> markup.Markup:
  """A table in the shape of the paper's, ours beside what is published."""
  cells = []
  for row in rows:
    published, count = row['published'], row['observers']
    theirs = ('\u2013', '\u2013')
    if published is not None:
      theirs = f'{published["correct"]}/{count}', _word(published['passed'])
    cells.append(
      [
        _link(row), count, f'{row["correct"]}/{count}', theirs[0],
        _word(row['passed']), theirs[1],
        document.chip(_as_expected(row), _said(row)),
      ]
    )  # fmt: skip
  header = ('configuration', 'N', 'correct', 'paper', 'group', 'paper', '')
  return tag(
    'section',
    tag('h2', group),
    markup.table(header, cells),
    *(tag('p', line) for line in suite_tables.totals(rows)),
  )


def _word(passed: bool) -> str:
  return 'Pass' if passed else 'Fail'


def _said(row: Mapping) -> str:
  if _as_published(row):
    return 'as published'
  said = 'passes' if row['passed'] else 'fails'
  return said if row['published'] is None else f'{said}, unlike published'
