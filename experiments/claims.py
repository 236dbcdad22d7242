"""Flies a fixed part of every table again and compares it with the documents.

README.md and docs/ mark what was printed with the name of a claim. For each a
small part is flown again with the command's own functions; a line says whether
both agree. Figures that follow from others are worked out anew, every one of
them, as `figures`; nothing is flown for that, nor for numbers in sentences.
Times are not compared, which is said too. All of it takes about an hour on two
cores that have other work. Exit status 0 when everything agrees, 1 otherwise, 2
on bad input.
"""

from collections.abc import Iterator, Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.claim_parts import (
  book,
  check,
  documents,
  finding,
  kinds,
)
from waggle_tasks.experiments.flags import engine_flag
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import checks

FIGURES = 'figures'

_ONLY = flags.DEFINE_list('only', [], 'Only these claims, by name.')
_LIST = flags.DEFINE_boolean('list', False, 'Name all claims and fly nothing.')
_ROOT = flags.DEFINE_string('root', '.', 'Folder of README.md and docs/.')
engine_flag.define_workers()


class ClaimError(errors.WaggleError):
  """A claim that there is not."""


def main(argv: Sequence[str]) -> int:
  """Checks claims and returns the exit status."""
  if argv[1:]:
    raise flags.Error(f'takes only flags, --name=value: got {argv[1]!r}.')
  if _LIST.value:
    print(listing())
    return 0
  names = [FIGURES, *book.SENTENCES, *book.CLAIMS]
  for name in _ONLY.value:
    checks.choice('only', name, names, ClaimError)
  library = documents.read(pathlib.Path(_ROOT.value))
  workers, verdicts = engine_flag.workers(), []
  for name in _ONLY.value or names:
    for found in _found(name, library, workers):
      verdicts.append(found.verdict)
      line = f'{found.verdict:12}{name:22}{found.place}: {found.words}'
      print(line, flush=True)
  counts = (
    f'{verdicts.count(verdict)} {words}'
    for verdict, words in (
      (finding.AGREES, 'agree'), (finding.DIFFERS, 'differ'),
      (finding.UNCHECKED, 'not checked'),
    )
  )  # fmt: skip
  print(', '.join(counts))
  return 1 if finding.DIFFERS in verdicts else 0


def _found(
  name: str, library: documents.Library, workers: int
) -> Iterator[finding.Finding]:
  """What there is to say about a claim."""
  if name == FIGURES:
    yield from check.figures(library)
  elif name in book.SENTENCES:
    yield check.sentence(book.SENTENCES[name], library)
  else:
    yield from check.claim(book.CLAIMS[name], library, workers)


def listing() -> str:
  """Every claim, how it is compared, and the command that is run for it."""
  rows = [
    (FIGURES, 'all blocks', 'figures of a block fit each other', ''),
    *(
      (name, each.document, 'numbers are those of blocks', '')
      for name, each in book.SENTENCES.items()
    ),
    *(
      (name, each.block, kinds.HOWS[each.how], ' '.join(each.command))
      for name, each in book.CLAIMS.items()
    ),
  ]
  lines = []
  for name, place, how, command in rows:
    lines.append((name, place, how))
    if command:
      lines.append(('', '', f'waggle {command}'))
  return table.render(('claim', 'stands over', 'compared'), lines)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
