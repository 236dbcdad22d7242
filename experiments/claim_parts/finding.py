"""What comparing a document with something else brought to light."""

from collections.abc import Iterable
import dataclasses
import re

AGREES, DIFFERS, UNCHECKED = 'agrees', 'DIFFERS', 'not checked'
_COUNT = re.compile(r'^(\d+)/(\d+)')


@dataclasses.dataclass(frozen=True)
class Finding:
  """One line for people.

  Attributes:
    verdict: `AGREES`, `DIFFERS` or `UNCHECKED`.
    place: Where in a document, such as 'docs/sweeps.md:12'.
    words: What was compared, or what differs.
  """

  verdict: str
  place: str
  words: str


def differs(place: str, says: str, made: str) -> Finding:
  """A difference."""
  return Finding(DIFFERS, place, f'says {says!r}, made {made!r}')


def gathered(
  place: str, found: Iterable[Finding | None], what: str
) -> list[Finding]:
  """Every difference; without one, a line that says how much agrees.

  Args:
    place: Of the line.
    found: A difference, or None, for everything that was compared.
    what: What was compared, several of them.
  """
  found = list(found)
  wrong = [each for each in found if each is not None]
  if wrong:
    return wrong
  if not found:
    return [Finding(DIFFERS, place, f'no {what} to compare')]
  return [Finding(AGREES, place, f'{len(found)} {what}')]


def fraction(cell: str) -> tuple[int, int] | None:
  """The counts of a cell such as '4/5 28-99'; None where it has none."""
  found = _COUNT.match(cell)
  return found and (int(found[1]), int(found[2]))
