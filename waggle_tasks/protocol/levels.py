"""An alphabet of heights: a symbol is a level at which a vehicle arrives.

Up and down is what looks the same from all around, what four rotors fly best
and what a tracker measures best. START goes to the top and then to the bottom,
which tells a reader the scale, the clock and the middle; every symbol is one
stroke from the level before to its own, in the same time whatever its length;
END goes home.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, minimum_jerk
from waggle_tasks.protocol.symbols import Symbol

COUNTS = (2, 4, 8, 16)
# Minimum jerk over 1 m in 1 s accelerates by so many m/s^2 at most, at the
# root of 1 - 6 s + 6 s^2: 10 / sqrt(3).
_PEAK = 10 / math.sqrt(3)
_UP_MPS2 = 3.05  # Asked of a vehicle that has 3.15, see `limits`.


class LevelsError(errors.WaggleError):
  """Levels that cannot be told apart, or strokes that cannot be flown."""


@dataclasses.dataclass(frozen=True)
class Stroke:
  """From corner to corner by minimum jerk, at rest at each for an instant.

  Attributes:
    symbol: START, END or LEVEL.
    corners_m: (x right, z up) offsets from the hover point in m.
    legs_s: Seconds from each corner to the next.
  """

  symbol: Symbol
  corners_m: tuple[tuple[float, float], ...]
  legs_s: tuple[float, ...]

  @property
  def duration_s(self) -> float:
    """Seconds for the whole way."""
    return sum(self.legs_s)

  @property
  def end_m(self) -> np.ndarray:
    """(2,) where it comes to rest."""
    return np.array(self.corners_m[-1])

  def motion(
    self, elapsed_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offset in m, velocity in m/s and acceleration in m/s^2, each (2,)."""
    leg = 0
    while leg < len(self.legs_s) - 1 and elapsed_s > self.legs_s[leg]:
      elapsed_s -= self.legs_s[leg]
      leg += 1
    begin_m, end_m = np.array(self.corners_m[leg : leg + 2])
    return minimum_jerk.between(begin_m, end_m, elapsed_s, self.legs_s[leg])


@dataclasses.dataclass(frozen=True)
class Levels:
  """Heights about the hover point, equally spaced but for it.

  The hover point itself is none, so that END, which leads to it, is as far from
  every symbol as those are from each other.

  Attributes:
    count: How many there are: 2, 4, 8 or 16.
    reach_m: How high the highest is, and how deep the lowest, 0.02 to 0.6 m.
    rise_s: Seconds from the hover point to the highest or lowest, 0.1 to 10 s.
    stroke_s: Seconds for a stroke from any level to any, 0.1 to 10 s.
  """

  count: int = 8
  reach_m: float = 0.12
  rise_s: float = 0.48
  stroke_s: float = 0.68

  def __post_init__(self) -> None:
    bounds = {
      'reach_m': (0.02, 0.6),
      'rise_s': (0.1, 10.0),
      'stroke_s': (0.1, 10.0),
    }
    checks.settle_numbers(self, bounds, LevelsError)
    if self.count not in COUNTS:
      raise LevelsError(
        f'`count` must be one of {[*COUNTS]}: got {self.count!r}'
      )
    checks.settle(self, 'count', int(self.count))

  @property
  def size(self) -> int:
    """See `alphabets.Alphabet`, as for all below."""
    return self.count

  @property
  def states(self) -> int:
    """One for each level."""
    return self.count

  @property
  def rest_s(self) -> float:
    """None: strokes follow one another."""
    return 0.0

  @property
  def slot_s(self) -> float:
    """The time of a stroke."""
    return self.stroke_s

  @property
  def motions(self) -> tuple[Stroke, ...]:
    """The steepest of all that is flown."""
    last = self.count - 1
    strokes = self.stroke(0, last), self.stroke(last, 0)
    return (self.start, *strokes, self.end(0), self.end(last))

  @property
  def lowest_m(self) -> float:
    """The lowest level."""
    return -self.reach_m

  @property
  def highest_m(self) -> float:
    """The highest level."""
    return self.reach_m

  @property
  def spacing_m(self) -> float:
    """From one level to the next, or to the hover point."""
    return 2 * self.reach_m / self.count

  def height_m(self, level: int) -> float:
    """How high a level is, from the hover point."""
    above = level >= self.count // 2  # None is at the hover point.
    return self.spacing_m * (level + above) - self.reach_m

  @property
  def start(self) -> Stroke:
    """To the top and then to the bottom, which is level 0."""
    return self.path(0.0, Symbol.START)

  def stroke(self, begin: int, level: int) -> Stroke:
    """From one level to another, or a wait of the same length at one."""
    return self.path(self.height_m(begin), level)

  def after(self, symbol: int) -> int:
    """The level itself."""
    return symbol

  def end(self, begin: int) -> Stroke:
    """From a level to the hover point."""
    return self.path(self.height_m(begin), Symbol.END)

  def path(self, begin_m: float, token: Symbol | float) -> Stroke:
    """START, a level or END from any height."""
    if token is Symbol.START:
      rise_s = self.stroke_s if begin_m else self.rise_s
      heights_m: tuple[float, ...] = self.reach_m, -self.reach_m
      return self._stroke(begin_m, heights_m, (rise_s, self.stroke_s), token)
    if token is Symbol.END:
      return self._stroke(begin_m, (0.0,), (self.rise_s,), token)
    height_m = self.height_m(int(token))
    return self._stroke(begin_m, (height_m,), (self.stroke_s,), Symbol.LEVEL)

  def _stroke(
    self,
    begin_m: float,
    heights_m: tuple[float, ...],
    legs_s: tuple[float, ...],
    symbol: Symbol,
  ) -> Stroke:
    corners_m = tuple((0.0, each) for each in (begin_m, *heights_m))
    return Stroke(symbol, corners_m, legs_s)


def least_s(way_m: float) -> float:
  """The shortest time for a stroke of some length, to 0.01 s."""
  return math.ceil(100 * math.sqrt(_PEAK * way_m / _UP_MPS2)) / 100


def quickest(count: int, reach_m: float) -> Levels:
  """Levels with the quickest strokes that a vehicle can fly.

  Args:
    count: See `Levels`.
    reach_m: See `Levels`.
  """
  return Levels(count, reach_m, least_s(reach_m), least_s(2 * reach_m))
