"""Symbols as people are shown them: a gesture by name, a level by number."""

from collections.abc import Iterable
import dataclasses

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import alphabets, levels, schedule, sights
from waggle_tasks.protocol.symbols import BITS, Symbol


@dataclasses.dataclass(frozen=True)
class Mark:
  """A symbol with its name.

  Attributes:
    symbol: What it is, which has a colour.
    label: Its name where there is little room: 'START', '0', or '5' of a level.
  """

  symbol: Symbol
  label: str

  @property
  def words(self) -> str:
    """Its name in a sentence, which tells a level from a bit."""
    is_level = self.symbol is Symbol.LEVEL
    return f'level {self.label}' if is_level else self.label


def of(symbol: Symbol) -> Mark:
  """A symbol that is told by its own name."""
  return Mark(symbol, str(symbol))


def of_path(path: schedule.Path, agreement: agreement_lib.Agreement) -> Mark:
  """What is flown.

  Args:
    path: The path; a level is told by where it ends.
    agreement: What both sides know.
  """
  alphabet = agreement.spoken.alphabet if path.symbol is Symbol.LEVEL else None
  if not isinstance(alphabet, levels.Levels):
    return of(path.symbol)
  end_m = float(path.end_m[1])
  heights_m = [alphabet.height_m(level) for level in range(alphabet.count)]
  level = min(
    range(alphabet.count), key=lambda each: abs(heights_m[each] - end_m)
  )
  return Mark(Symbol.LEVEL, sights.name_of(alphabet, level))


def of_word(
  word: Iterable[int], agreement: agreement_lib.Agreement
) -> tuple[Mark, ...]:
  """The symbols of a word: what a frame has between START and END."""
  alphabet = agreement.spoken.alphabet
  return tuple(
    Mark(
      BITS[symbol] if isinstance(alphabet, alphabets.Gestures)
      else Symbol.LEVEL,
      sights.name_of(alphabet, symbol),
    )
    for symbol in word
  )  # fmt: skip
