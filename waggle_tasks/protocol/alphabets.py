"""What a frame is flown with: START, one stroke for each symbol, END."""

from collections.abc import Iterable
import dataclasses
from typing import Protocol

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, gestures, schedule
from waggle_tasks.protocol.symbols import BITS, Symbol

Token = Symbol | int | float


class AlphabetError(errors.WaggleError):
  """An alphabet that has no common clock, or a rest that nobody keeps."""


class Alphabet(Protocol):
  """Symbols as strokes, each in a slot of its own.

  A stroke may depend on where the one before ended, its state: a gesture
  begins and ends at the hover point, a level is reached from another one.
  """

  @property
  def size(self) -> int:
    """How many symbols there are."""
    ...

  @property
  def states(self) -> int:
    """In how many places a stroke can begin; START ends in the first."""
    ...

  @property
  def rest_s(self) -> float:
    """Stillness after START and after each stroke."""
    ...

  @property
  def slot_s(self) -> float:
    """From the begin of one stroke to the begin of the next."""
    ...

  @property
  def start(self) -> schedule.Path:
    """What begins a frame at the hover point."""
    ...

  def stroke(self, state: int, symbol: int) -> schedule.Path:
    """What says a symbol."""
    ...

  def path(self, begin_m: float, token: 'Token') -> schedule.Path:
    """START, a symbol or END from any height, from the hover point on."""
    ...

  @property
  def motions(self) -> tuple[schedule.Path, ...]:
    """The steepest of all that is flown."""
    ...

  @property
  def lowest_m(self) -> float:
    """How high its lowest point is, from the hover point: negative below."""
    ...

  @property
  def highest_m(self) -> float:
    """How high its highest point is, from the hover point."""
    ...

  def after(self, symbol: int) -> int:
    """The state in which the stroke of a symbol ends."""
    ...

  def end(self, state: int) -> schedule.Path:
    """What ends a frame at the hover point."""
    ...


@dataclasses.dataclass(frozen=True)
class Gestures:
  """Bits as gestures of a codebook, with a rest between two of them.

  Attributes:
    codebook: The gestures; those of 0 and 1 take the same time.
    rest_s: The rest, 0 to 60 s.
  """

  codebook: gestures.Codebook
  rest_s: float

  def __post_init__(self) -> None:
    if not isinstance(self.codebook, gestures.Codebook):
      raise AlphabetError(
        f'`codebook` must be a gestures.Codebook: got {self.codebook!r}'
      )
    checks.settle_numbers(self, {'rest_s': (0.0, 60.0)}, AlphabetError)
    zero_s, one_s = (self.codebook[bit].duration_s for bit in BITS)
    if zero_s != one_s:
      raise AlphabetError(
        '`codebook` must give 0 and 1 the same time, so that every symbol has'
        f' its slot: got {zero_s:g} s and {one_s:g} s'
      )

  @property
  def size(self) -> int:
    """See `Alphabet`."""
    return len(BITS)

  @property
  def states(self) -> int:
    """See `Alphabet`."""
    return 1

  @property
  def slot_s(self) -> float:
    """See `Alphabet`."""
    return self.codebook[Symbol.ZERO].duration_s + self.rest_s

  @property
  def motions(self) -> tuple[gestures.Gesture, ...]:
    """See `Alphabet`."""
    return self.codebook.gestures

  @property
  def lowest_m(self) -> float:
    """See `Alphabet`."""
    return self.codebook.lowest_m

  @property
  def highest_m(self) -> float:
    """See `Alphabet`."""
    return self.codebook.highest_m

  @property
  def start(self) -> gestures.Gesture:
    """See `Alphabet`."""
    return self.codebook[Symbol.START]

  def stroke(self, state: int, symbol: int) -> gestures.Gesture:
    """See `Alphabet`."""
    del state  # All are flown from the hover point.
    return self.codebook[BITS[symbol]]

  def path(self, begin_m: float, token: 'Token') -> gestures.Gesture:
    """See `Alphabet`."""
    del begin_m  # It is the hover point.
    symbol = token if isinstance(token, Symbol) else BITS[int(token)]
    return self.codebook[symbol]

  def after(self, symbol: int) -> int:
    """See `Alphabet`."""
    del symbol
    return 0

  def end(self, state: int) -> gestures.Gesture:
    """See `Alphabet`."""
    del state
    return self.codebook[Symbol.END]


def lay_out(
  alphabet: Alphabet, tokens: Iterable[Token], begin_s: float
) -> tuple[schedule.Slot, ...]:
  """Flies tokens one after another, whether they are a frame or not.

  Args:
    alphabet: What they are flown with.
    tokens: START, symbols, END in any order; a number that is not whole is a
      rest of so many seconds.
    begin_s: When the first begins.
  """
  slots: list[schedule.Slot] = []
  place_m, at_s = 0.0, begin_s
  for token in tokens:
    if isinstance(token, float):
      at_s += token
      continue
    slots.append(schedule.Slot(alphabet.path(place_m, token), at_s))
    place_m = float(slots[-1].gesture.end_m[1])
    at_s = slots[-1].end_s + alphabet.rest_s
  return tuple(slots)


def places(path: schedule.Path, times_s: np.ndarray) -> np.ndarray:
  """(T, 3) offsets: right, up and away; after its end a path rests there.

  Args:
    path: The path.
    times_s: (T,) seconds since its begin.
  """
  out = np.zeros((len(times_s), 3))
  for row, at_s in zip(out, np.minimum(times_s, path.duration_s), strict=True):
    place = path.motion(float(at_s))[0]
    row[: len(place)] = place
  return out


def sample(path: schedule.Path, points: int) -> np.ndarray:
  """(points, 3) offsets at equal times: right, up and away."""
  return places(path, np.linspace(0.0, path.duration_s, points))
