"""The page of a suite: its tables beside the paper's, failures first.

Every line leads to the page of its run.
"""

from collections.abc import Mapping, Sequence
import itertools
import json
import pathlib

from waggle_tasks.experiments import archive, suite_tables
from waggle_tasks.experiments.pages import document, markup

RESULTS = 'results.jsonl'

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
  """
  path = folder / RESULTS
  try:
    lines = path.read_text(encoding='utf-8').splitlines()
    rows = [json.loads(line) for line in lines]
  except (OSError, ValueError) as error:
    raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
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


def _differs(row: Mapping) -> bool:
  """Whether a case did not give what is published for it."""
  published = row['published']
  if published is None:
    return not row['passed']
  ours = {'correct': row['correct'], 'passed': row['passed']}
  return ours != published


def _head(rows: Sequence[Mapping], name: str) -> markup.Markup:
  others = sum(map(_differs, rows))
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
      f'receiver {receivers}; {simulated_s:.0f} s simulated; expected is what'
      ' the paper published, or else that the group passes',
      class_='faint',
    ),
  )


def _link(row: Mapping) -> markup.Markup:
  return tag('a', row['label'], href=f'cases/{row["case"]}/{document.NAME}')


def _failures(rows: Sequence[Mapping]) -> markup.Markup | None:
  """Every failed check, those of unexpected cases first."""
  failed = sorted(
    (row for row in rows if _differs(row) or not row['passed']),
    key=lambda row: not _differs(row),
  )
  if not failed:
    return None
  items = []
  for row in failed:
    said = 'not as expected' if _differs(row) else 'as published'
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
        document.chip(not _differs(row), _same(row)),
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


def _same(row: Mapping) -> str:
  return 'differs' if _differs(row) else 'as expected'
