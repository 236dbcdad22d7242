"""What a claim is, and in which ways it is compared."""

from collections.abc import Sequence
import dataclasses

TEXT, ROWS, CELLS, PART = 'text', 'rows', 'cells', 'part'
COPY, SUM, UNCHECKED = 'copy', 'sum', 'unchecked'
HOWS = {
  TEXT: 'every line of the block is printed again',
  ROWS: 'every row and every failure that is printed is in the block',
  CELLS: 'so is every cell of a sweep, with its limits',
  PART: 'counts of a part fit into those of the whole',
  COPY: 'every line is in another block too',
  SUM: 'it is the sum of the other blocks of its document',
  UNCHECKED: 'nothing is compared',
}


@dataclasses.dataclass(frozen=True)
class Claim:
  """A claim of a document.

  Attributes:
    block: The name that its block is marked with.
    how: One of `HOWS`.
    command: Arguments of `waggle` that make a part of it; may be empty.
    table: Number of the table in the block, from 0; None for any that fits.
    detail: Another block; blocks, and titles of tables, that are
      left out of a sum; or why nothing is compared.
  """

  block: str
  how: str
  command: Sequence[str] = ()
  table: int | None = None
  detail: str = ''


@dataclasses.dataclass(frozen=True)
class Sentence:
  """Numbers in a sentence that stand in blocks too.

  Attributes:
    document: Where the sentence is.
    pattern: What finds the numbers in it.
    blocks: Where they come from; of several the sum.
    source: What finds the numbers in these.
  """

  document: str
  pattern: str
  blocks: Sequence[str]
  source: str
