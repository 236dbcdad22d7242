"""Whether the figures of a block fit each other; nothing is flown for that.

A count that was changed by hand no longer has its limits, or its total.
"""

from collections.abc import Callable, Container, Iterator
import re

from waggle_tasks import suites
from waggle_tasks.experiments.claim_parts import documents, finding
from waggle_tasks.experiments.results import suite_tables, sweep_tables
from waggle_tasks.experiments.studies import case_rows

_RIGHT = re.compile(r'^right: (\d+)/(\d+) exposures')
_EVENTS = re.compile(r'^([a-z ]+): (\d+) in (\d+) exposures')
_CELL = re.compile(r'^(\d+)/(\d+) \d+-\d+$')
_ROW_UNLIKE = re.compile(r'^(\S+) (\d+)/(\d+) not (\d+)/\d+$')

_Found = Iterator[finding.Finding | None]


def check(block: documents.Block) -> list[finding.Finding]:
  """Everything that can be worked out from a block alone."""
  found = [
    *_limits(block), *_lines(block), *_sum(block), *_suite(block),
    *_moved(block), *_equal(block),
  ]  # fmt: skip
  if not found:
    return []
  return finding.gathered(block.place(), found, 'figures fit each other')


def exposures(
  block: documents.Block, without: Container[str] = ()
) -> tuple[int, int]:
  """How many exposures of a block were right, and of how many.

  Args:
    block: The block.
    without: Titles of tables that do not count.
  """
  for line in block.lines:
    if found := _RIGHT.match(line):
      return int(found[1]), int(found[2])
  counts = [counts for _, _, counts in _cells(block, without)]
  return sum(a for a, _ in counts), sum(b for _, b in counts)


def _cells(
  block: documents.Block, without: Container[str] = ()
) -> Iterator[tuple[str, str, tuple[int, int]]]:
  """Place, text and counts of every cell of a sweep."""
  for table in block.tables:
    if table.title in without:
      continue
    for number, row in enumerate(table.rows):
      for cell in row[1:]:
        if found := _CELL.match(cell):
          place = f'{block.document}:{table.place(number)}'
          yield place, cell, (int(found[1]), int(found[2]))


def _same(place: str, says: str, made: str) -> finding.Finding | None:
  return None if says == made else finding.differs(place, says, made)


def _limits(block: documents.Block) -> _Found:
  """The limits of each cell follow from its counts."""
  for place, cell, counts in _cells(block):
    yield _same(place, cell, _try(sweep_tables.cell, *counts))


def _lines(block: documents.Block) -> _Found:
  """So do those of the totals."""
  for index, line in enumerate(block.lines):
    if found := _RIGHT.match(line):
      made = _try(sweep_tables.right_line, int(found[1]), int(found[2]))
    elif found := _EVENTS.match(line):
      events = int(found[2]), int(found[3])
      made = _try(sweep_tables.event_line, found[1], *events)
    else:
      continue
    yield _same(block.place(index), line, made)


def _try(make: Callable[..., str], *arguments: object) -> str:
  """What a function makes of counts, which may be impossible ones."""
  try:
    return make(*arguments)
  except ValueError as error:
    return f'nothing: {error}'


def _sum(block: documents.Block) -> _Found:
  """Cells are all that their total counts."""
  counts = [counts for _, _, counts in _cells(block)]
  for index, line in enumerate(block.lines):
    if counts and (found := _RIGHT.match(line)):
      made = f'{sum(a for a, _ in counts)}/{sum(b for _, b in counts)}'
      yield _same(block.place(index), f'{found[1]}/{found[2]}', made)


def _suite(block: documents.Block) -> _Found:
  """The totals of a suite follow from its rows."""
  for table in block.tables:
    if not table.header[0].endswith(': configuration'):
      continue
    control = table.header[0].startswith('controls')
    rows = [_result(row, control) for row in table.rows]
    for index, line in enumerate(suite_tables.totals(rows)):
      at = table.place(len(rows)) + index - block.first
      says = block.lines[at] if at < len(block.lines) else ''
      yield _same(block.place(at), says, line)


def _result(row: tuple[str, ...], control: bool) -> case_rows.SuiteRow:
  """A line of a suite, as much of it as its totals need."""
  (correct, _), (theirs, _) = (
    finding.fraction(cell) or (0, 0) for cell in row[2:4]
  )
  observers = int(row[1])
  return case_rows.SuiteRow(
    case='', group='', label=row[0], identity='', receiver='',
    observers=observers, expecting=0 if control else observers,
    correct=correct, passed=row[4] == 'Pass', simulated_s=0.0,
    published=suites.Published(theirs, row[5] == 'Pass'), outcomes=(),
    scenario={},
  )  # fmt: skip


def _moved(block: documents.Block) -> _Found:
  """Counts of a moved choice are the paper's but for the rows it names."""
  paper = suites.find('standard')
  known = {c.name: c.published for c in paper if c.published is not None}
  correct = sum(each.correct for each in known.values())
  passed = sum(each.passed for each in known.values())
  of = sum(case.scene.observers for case in paper)
  was = {name: each.passed for name, each in known.items()}
  for table in block.tables:
    if table.header[-1] != 'rows unlike the paper':
      continue
    for number, (_, *cells) in enumerate(table.rows):
      more, passes = 0, 0
      for found in map(_ROW_UNLIKE.match, cells[-1].split('; ')):
        if found:
          more += int(found[2]) - int(found[4])
          passes += (found[2] == found[3]) - was.get(found[1], False)
      made = f'{correct + more}/{of} {passed + passes}/{len(paper)}'
      place = f'{block.document}:{table.place(number)}'
      yield _same(place, ' '.join(cells[:2]), made)


def _equal(block: documents.Block) -> _Found:
  """As many logs are equal as the last line says."""
  for table in block.tables:
    if table.header[-1] != 'event logs':
      continue
    equal = sum(row[-1] == 'equal' for row in table.rows)
    made = f'{equal} of {len(table.rows)} event logs are equal.'
    yield _same(block.place(len(block.lines) - 1), block.lines[-1], made)
