"""What was flown again beside what a document says."""

from collections.abc import Iterator, Mapping, Sequence
import itertools
import re
from typing import Any

from waggle_tasks.experiments.claim_parts import documents, finding
from waggle_tasks.experiments.results import envelope, heat, sweep_tables

_UNLIKE = 'rows unlike the paper'
_COUNTED = re.compile(r'^(right|[a-z ]+): (\d+)(?:/| in )(\d+) exposures')

_Found = Iterator[finding.Finding | None]


def text(
  block: documents.Block, printed: documents.Block
) -> list[finding.Finding]:
  """Every line of a block is among those that were printed."""
  found = (
    None
    if line in printed.lines
    else finding.differs(block.place(index), line, 'no such line')
    for index, line in enumerate(block.lines)
    if line
  )
  return finding.gathered(block.place(), found, 'lines were made again')


def rows(
  block: documents.Block, printed: documents.Block
) -> list[finding.Finding]:
  """Every row of a table, and every failure, is in the block."""
  found = [*_rows(block, printed), *_failures(block, printed)]
  return finding.gathered(block.place(), found, 'rows were made again')


def _rows(block: documents.Block, printed: documents.Block) -> _Found:
  for made in printed.tables:
    known = [
      (f'{block.document}:{table.place(number)}', row)
      for table in block.tables
      if table.header[0] == made.header[0]
      for number, row in enumerate(table.rows)
    ]
    for row in made.rows:
      if any(_stripped(row) == _stripped(each) for _, each in known):
        yield None
        continue
      near = [(at, each) for at, each in known if each[:2] == row[:2]] or [
        (at, each) for at, each in known if each[0] == row[0]
      ]
      place, says = near[0] if near else (block.place(), ())
      yield finding.differs(place, '  '.join(says), '  '.join(row))


def _stripped(row: Sequence[str]) -> list[str]:
  """A row without empty cells at its end, which tables may leave out."""
  return '\0'.join(row).rstrip('\0').split('\0')


def _failures(block: documents.Block, printed: documents.Block) -> _Found:
  lines = itertools.dropwhile(lambda line: line != 'failures:', printed.lines)
  for line in lines:
    if line.startswith('  ') and 'failures:' in block.lines:
      known = line in block.lines
      name = line.partition(':')[0]
      near = [each for each in block.lines if each.startswith(f'{name}:')]
      index = block.lines.index(near[0]) if near else 0
      yield (
        None
        if known
        else finding.differs(block.place(index), ''.join(near[:1]), line)
      )


def cells(
  block: documents.Block,
  results: Sequence[envelope.Row],
  number: int | None,
) -> list[finding.Finding]:
  """Every cell of a sweep, which has to be whole, is in the block.

  Args:
    block: The block.
    results: What was flown.
    number: Of the table; None for any that fits.
  """
  tables = block.tables if number is None else block.tables[number : number + 1]
  found = [
    _cell(block, tables, cell, [*members])
    for cell, members in itertools.groupby(results, lambda row: row.cell)
  ]
  return finding.gathered(block.place(), found, 'cells were flown again')


def _cell(
  block: documents.Block,
  tables: Sequence[documents.Table],
  cell: Mapping[str, Any],
  members: Sequence[envelope.Row],
) -> finding.Finding | None:
  got = envelope.count(members)
  made = sweep_tables.cell(got.right, got.exposures)
  for table in tables:
    if (place := _place(table, cell)) is not None:
      row, column = place
      says = table.rows[row][column]
      if says == made:
        return None
      where = f'{block.document}:{table.place(row)}'
      return finding.differs(where, says, made)
  return finding.differs(block.place(), 'no such cell', f'{dict(cell)}: {made}')


def _place(
  table: documents.Table, cell: Mapping[str, Any]
) -> tuple[int, int] | None:
  """Row and column of a cell in a table; None when it is in another."""
  names = [name for name in table.header[0].split(' \\ ') if name != 'all']
  if not cell.keys() >= {*names}:
    return None
  rest = {name: value for name, value in cell.items() if name not in names}
  title = heat.title(envelope.Panel(rest, None, None, [], [], {}))
  if ' = ' in table.title and table.title != title:
    return None
  labels = [heat.label(cell[name]) for name in names]
  row, column = [*labels, 'right', 'right'][:2]
  first = [each[0] for each in table.rows]
  if row not in first or column not in table.header:
    return None
  return first.index(row), table.header.index(column)


def part(
  block: documents.Block, printed: documents.Block
) -> list[finding.Finding]:
  """Counts of a part are no more than those of the whole allow."""
  found = [*_parts(block, printed), *_totals(block, printed)]
  return finding.gathered(block.place(), found, 'counts hold for a part')


def _parts(block: documents.Block, printed: documents.Block) -> _Found:
  for made, table in itertools.product(printed.tables, block.tables):
    panels = ' = ' in table.title and made.title != table.title
    if made.header[0] != table.header[0] or panels:
      continue
    known = {row[0]: (at, row) for at, row in enumerate(table.rows)}
    for row in made.rows:
      if row[0] not in known:
        yield finding.differs(block.place(), 'no such row', row[0])
        continue
      at, whole = known[row[0]]
      says = dict(zip(table.header, whole, strict=True))
      for title, cell in zip(made.header, row, strict=True):
        if title in says:
          yield from _counts(block, table.place(at), title, says[title], cell)
        else:
          yield finding.differs(block.place(), 'no such column', title)


def _counts(
  block: documents.Block, line: int, title: str, says: str, made: str
) -> _Found:
  """One cell of a part beside that of the whole."""
  place = f'{block.document}:{line}'
  if title == _UNLIKE:
    for each in made.split('; '):
      # Of the rows unlike the paper, the part has those that were flown.
      known = made == 'none' or each in says.split('; ')
      yield None if known else finding.differs(place, says, made)
  elif (some := finding.fraction(made)) and (all_ := finding.fraction(says)):
    fits = some[0] <= all_[0] and some[1] - some[0] <= all_[1] - all_[0]
    yield None if fits else finding.differs(place, says, f'{made} of a part')


def _totals(block: documents.Block, printed: documents.Block) -> _Found:
  """The totals of a sweep, of which a part was flown."""
  made = {
    found[1]: (int(found[2]), int(found[3]))
    for found in map(_COUNTED.match, printed.lines)
    if found
  }
  for index, line in enumerate(block.lines):
    if (found := _COUNTED.match(line)) and found[1] in made:
      some, of = made[found[1]]
      fits = some <= int(found[2]) and of - some <= int(found[3]) - int(
        found[2]
      )
      yield (
        None
        if fits
        else finding.differs(
          block.place(index), line, f'{some} of {of} in a part'
        )
      )
