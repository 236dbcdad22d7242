"""Documents read back: the blocks that claims stand over, and their tables.

A block is what stands between fences below a line such as
`<!-- claim: envelope-map -->`, which readers of the document do not see.
"""

from collections.abc import Mapping, Sequence
import dataclasses
import itertools
import pathlib
import re

from waggle_tasks import errors

NAMES = ('README.md', 'docs')
_MARK = re.compile(r'^<!-- claim: ([\w-]+) -->$')
_SHELL = ('sh', 'python', 'json', 'toml')  # Written, and not what came out.
_RULE = re.compile(r'^-+( +-+)*$')


class DocumentError(errors.WaggleError):
  """A document that cannot be read, or that marks a claim twice."""


@dataclasses.dataclass(frozen=True)
class Table:
  """A plain text table of a block.

  Attributes:
    title: The line above it, or ''.
    header: The titles of its columns.
    rows: Its rows, with as many cells each.
    line: Number of its header in the document.
  """

  title: str
  header: tuple[str, ...]
  rows: tuple[tuple[str, ...], ...]
  line: int

  def place(self, row: int) -> int:
    """The number of a row in the document."""
    return self.line + 2 + row


@dataclasses.dataclass(frozen=True)
class Block:
  """What a document says that a command prints.

  Attributes:
    document: Its name, from the folder of all documents.
    first: Number of its first line in the document.
    lines: Its lines.
  """

  document: str
  first: int
  lines: tuple[str, ...]

  def place(self, index: int = 0) -> str:
    """Where a line of it is, such as 'docs/sweeps.md:12'."""
    return f'{self.document}:{self.first + index}'

  @property
  def tables(self) -> list[Table]:
    """Its tables, in their order."""
    out = []
    for index, line in enumerate(self.lines):
      if index and _RULE.match(line):
        spans = [found.span() for found in re.finditer('-+', line)]
        body = self.lines[index + 1 :]
        ends = [k for k, each in enumerate(body) if not _fits(each, spans)]
        title = self.lines[index - 2].rstrip(':') if index > 1 else ''
        out.append(
          Table(
            title,
            _cells(self.lines[index - 1], spans),
            tuple(
              _cells(each, spans) for each in body[: min(ends, default=None)]
            ),
            self.first + index - 1,
          )
        )
    return out


def _fits(line: str, spans: Sequence[tuple[int, int]]) -> bool:
  """Whether a line is a row of a table: words stand in its columns alone."""
  outside = [line[a:b] for (_, a), (b, _) in itertools.pairwise(spans)]
  outside.append(line[spans[-1][1] :])
  return any(_cells(line, spans)[1:]) and not ''.join(outside).strip()


def _cells(line: str, spans: Sequence[tuple[int, int]]) -> tuple[str, ...]:
  return tuple(line[left:right].strip() for left, right in spans)


def block_of(text: str) -> Block:
  """What a command printed, as a block."""
  return Block('', 1, tuple(text.splitlines()))


@dataclasses.dataclass(frozen=True)
class Library:
  """All documents.

  Attributes:
    blocks: By the name of its claim, what it stands over.
    unclaimed: Where blocks stand that no claim is about.
    words: The text of each document, by its name, on one line.
  """

  blocks: Mapping[str, Block]
  unclaimed: Sequence[str]
  words: Mapping[str, str]


def read(root: pathlib.Path) -> Library:
  """Reads README.md and docs/ of a folder.

  Raises:
    DocumentError: if they are not there, or one claim stands over two blocks.
  """
  paths = [root / 'README.md', *sorted((root / 'docs').glob('*.md'))]
  blocks, unclaimed, words = {}, [], {}
  for path in paths:
    name = path.relative_to(root).as_posix()
    try:
      text = path.read_text(encoding='utf-8')
    except OSError as error:
      raise DocumentError(
        f'`root` must be the folder of README.md and docs/: {path}:'
        f' {error.strerror}'
      ) from None
    words[name] = ' '.join(text.split())
    for claim, block in _blocks(name, text.splitlines()):
      if claim is None:
        unclaimed.append(block.place())
      elif claim in blocks:
        raise DocumentError(f'{block.place()}: claim {claim} stands twice')
      else:
        blocks[claim] = block
  return Library(blocks, unclaimed, words)


def _blocks(name: str, lines: Sequence[str]) -> list[tuple[str | None, Block]]:
  """Every block of a document that is no command, and its claim."""
  out: list[tuple[str | None, Block]] = []
  claim: str | None = None
  begun, shell = 0, False  # The line that began the block, from 1.
  for number, line in enumerate(lines, 1):
    if not begun and (mark := _MARK.match(line)):
      claim = mark[1]
    elif not begun and line.startswith('```'):
      # What the site makes, in braces, is none of it either.
      begun, shell = number, line[3:] in _SHELL or line[3:4] == '{'
    elif line == '```':
      if not shell:
        body = tuple(lines[begun : number - 1])
        out.append((claim, Block(name, begun + 1, body)))
        claim = None
      begun = 0
  return out
