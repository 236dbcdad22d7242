"""Checks one claim, or the numbers of one sentence."""

from collections.abc import Sequence
import pathlib
import re
import subprocess
import sys
import tempfile

from waggle_tasks import errors
from waggle_tasks.experiments.claim_parts import (
  arithmetic,
  book,
  compare,
  documents,
  finding,
  kinds,
)
from waggle_tasks.experiments.studies import case_rows

# Launchers that leave a folder, and so are told where.
_LEAVES = (
  'broadcast', 'sweep', 'link', 'suite', 'sensitivity', 'ablate', 'colony',
)  # fmt: skip
_MOST = 1  # The exit status of a command that ran; above, it did not.


class RerunError(errors.WaggleError):
  """A command that did not run."""


def claim(
  each: kinds.Claim, library: documents.Library, workers: int
) -> list[finding.Finding]:
  """Makes what a claim is about again, and compares.

  Args:
    each: The claim.
    library: The documents.
    workers: How many processes fly.

  Raises:
    RerunError: if its command did not run.
  """
  block = library.blocks.get(each.block)
  if block is None:
    return [_lost(f'no block is marked <!-- claim: {each.block} -->')]
  if each.how == kinds.UNCHECKED:
    words = f'{len(block.lines)} lines: {each.detail}'
    return [finding.Finding(finding.UNCHECKED, block.place(), words)]
  if each.how == kinds.COPY:
    other = library.blocks.get(each.detail, documents.block_of(''))
    return compare.text(block, other)
  if each.how == kinds.SUM:
    return [_sum(block, library, each.detail.split())]
  with tempfile.TemporaryDirectory() as home:
    folder = pathlib.Path(home, 'out')
    printed = _run(each.command, folder, workers)
    match each.how:
      case kinds.TEXT:
        return compare.text(block, printed)
      case kinds.ROWS:
        return compare.rows(block, printed)
      case kinds.CELLS:
        rows = case_rows.read_sweep(folder)
        return compare.cells(block, rows, each.table)
    return compare.part(block, printed)


def _lost(words: str) -> finding.Finding:
  return finding.Finding(finding.DIFFERS, 'documents', words)


def _run(
  command: Sequence[str], folder: pathlib.Path, workers: int
) -> documents.Block:
  """Runs a command of this project, and returns what it printed."""
  name, *flags = command
  if name in _LEAVES:
    flags.append(f'--output={folder}')
  if name in _LEAVES and name != 'broadcast':
    flags.append(f'--workers={workers}')
  child = subprocess.run(
    [sys.executable, '-m', 'waggle_tasks', name, *flags],
    stdout=subprocess.PIPE, text=True, check=False,
  )  # fmt: skip
  if child.returncode not in range(_MOST + 1):
    raise RerunError(
      f'`waggle {" ".join(command)}` must run: it ended with exit status'
      f' {child.returncode}'
    )
  return documents.block_of(child.stdout)


def _sum(
  block: documents.Block, library: documents.Library, without: Sequence[str]
) -> finding.Finding:
  """A total beside the exposures of the other blocks of its document."""
  counts = [
    arithmetic.exposures(each, without)
    for name, each in library.blocks.items()
    if each.document == block.document and each != block
    if name not in without
  ]
  says = '{}/{}'.format(*arithmetic.exposures(block))
  made = f'{sum(a for a, _ in counts)}/{sum(b for _, b in counts)}'
  if says != made:
    return finding.differs(block.place(), says, made)
  words = f'{says} exposures are those of {len(counts)} other blocks'
  return finding.Finding(finding.AGREES, block.place(), words)


def sentence(
  each: kinds.Sentence, library: documents.Library
) -> finding.Finding:
  """The numbers of a sentence beside those of the blocks they stand for."""
  found = re.search(each.pattern, library.words.get(each.document, ''))
  if found is None:
    return _lost(f'{each.document} has no sentence like {each.pattern!r}')
  says = [number.replace(',', '') for number in found.groups()]
  sources = []
  for name in each.blocks:
    lines = library.blocks.get(name, documents.block_of('')).lines
    source = re.search(each.source, '\n'.join(lines), re.MULTILINE)
    if source is None:
      return _lost(f'block {name} has no line like {each.source!r}')
    sources.append(source.groups())
  made = [*sources[0]]
  if len(sources) > 1:
    made = [str(sum(map(int, column))) for column in zip(*sources, strict=True)]
  if says != made:
    return finding.differs(each.document, found[0], ', '.join(made))
  words = f'{found[0]!r} is what {", ".join(each.blocks)} say'
  return finding.Finding(finding.AGREES, each.document, words)


def figures(library: documents.Library) -> list[finding.Finding]:
  """Whether the figures of every block fit each other, and have a claim."""
  out = [
    one for block in library.blocks.values() for one in arithmetic.check(block)
  ]
  known = {each.block for each in book.CLAIMS.values()}
  for name, block in library.blocks.items():
    if name not in known:
      words = f'there is no claim {name}'
      out.append(finding.Finding(finding.DIFFERS, block.place(), words))
  out += [
    finding.Finding(finding.DIFFERS, place, 'no claim stands over this block')
    for place in library.unclaimed
  ]
  return out
