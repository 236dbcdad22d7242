"""The codebook: which path and duration stands for which symbol."""

import dataclasses
import itertools

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, minimum_jerk
from waggle_tasks.protocol.symbols import MOTIONS, Symbol

# Two gestures whose normalised paths are closer than this RMSE cannot both
# be accepted under the paper's margin of 0.075 (section 'RGB optical flow').
MINIMUM_SEPARATION = 0.15
NUM_SAMPLES = 80  # arc-length positions, paper, section 'RGB optical flow'.


class CodebookError(errors.WaggleError):
  """A gesture that cannot be flown, or two that cannot be told apart."""


def resample(path: np.ndarray, num_samples: int = NUM_SAMPLES) -> np.ndarray:
  """Points at equal arc lengths along a polyline.

  Args:
    path: (T, 2) corners or positions, in any unit, T >= 2.
    num_samples: How many points to return.

  Returns:
    (num_samples, 2) in the unit of `path`; its first point repeated when the
    path has no length.
  """
  steps = np.hypot(*np.diff(path, axis=0).T)
  length = np.concatenate([[0.0], np.cumsum(steps)])
  wanted = np.linspace(0.0, length[-1], num_samples)
  return np.stack(
    [np.interp(wanted, length, coordinate) for coordinate in path.T], axis=1
  )


def normalise(path: np.ndarray, num_samples: int = NUM_SAMPLES) -> np.ndarray:
  """The paper's normal form of a path: what a template is compared with.

  Resampled along its arc length, translated to its starting point and divided
  by its largest axis-aligned span (section 'RGB optical flow').

  Args:
    path: (T, 2) in any unit, of positive span.
    num_samples: How many points to return.

  Returns:
    (num_samples, 2) without unit.
  """
  points = resample(path, num_samples)
  points = points - points[0]
  return points / np.ptp(points, axis=0).max()


@dataclasses.dataclass(frozen=True)
class Gesture:
  """One motion symbol as a closed path in the performer's frontal plane.

  Attributes:
    symbol: The symbol it stands for.
    corners_m: (x right, z up) offsets from the hover point in metres; the
      first and the last are the hover point (0, 0). The performer rests at
      each corner for an instant and flies minimum jerk between them.
    duration_s: Seconds for the whole path, shared equally by its legs.
  """

  symbol: Symbol
  corners_m: tuple[tuple[float, float], ...]
  duration_s: float

  def __post_init__(self) -> None:
    name = f'gesture {self.symbol}'
    checks.choice('symbol', self.symbol, MOTIONS, CodebookError)
    object.__setattr__(self, 'symbol', Symbol(self.symbol))
    duration_s = checks.number(
      f'{name} duration_s', self.duration_s, 0.1, 60, CodebookError
    )
    checks.settle(self, 'duration_s', duration_s)
    if len(self.corners_m) < 3:
      raise CodebookError(
        f'`{name} corners_m` must have at least 3 corners:'
        f' got {len(self.corners_m)}'
      )
    corners_m = tuple(
      tuple(
        checks.number(f'{name} corners_m', value, -1.2, 2.0, CodebookError)
        for value in corner
      )
      for corner in self.corners_m
    )
    if any(len(corner) != 2 for corner in corners_m):
      raise CodebookError(
        f'`{name} corners_m` must be pairs of right and up: got {corners_m}'
      )
    checks.settle(self, 'corners_m', corners_m)
    if any(corner != (0, 0) for corner in self.corners_m[:: len(self) - 1]):
      raise CodebookError(
        f'`{name} corners_m` must begin and end at (0, 0):'
        f' got {self.corners_m[0]} and {self.corners_m[-1]}'
      )
    if any(a == b for a, b in itertools.pairwise(self.corners_m)):
      raise CodebookError(
        f'`{name} corners_m` must not rest on one corner: got {self.corners_m}'
      )

  def __len__(self) -> int:
    return len(self.corners_m)

  @property
  def leg_s(self) -> float:
    """Seconds from one corner to the next."""
    return self.duration_s / (len(self) - 1)

  @property
  def end_m(self) -> np.ndarray:
    """(2,) where it comes to rest: the hover point."""
    return np.zeros(2)

  def motion(
    self, elapsed_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Minimum jerk from corner to corner.

    Args:
      elapsed_s: Seconds since the gesture began, up to its duration.

    Returns:
      Offset from the hover point in m, velocity in m/s and acceleration in
      m/s^2, each (2,).
    """
    leg = int(elapsed_s / self.leg_s)
    leg = min(leg, len(self) - 2)  # Rounding at the very end.
    begin_m, end_m = np.array(self.corners_m[leg : leg + 2])
    return minimum_jerk.between(
      begin_m, end_m, elapsed_s - leg * self.leg_s, self.leg_s
    )

  def image_path(self) -> np.ndarray:
    """(corners, 2) path as a frontal camera sees it: x right, y down."""
    return np.array(self.corners_m) * (1.0, -1.0)


def separation(a: np.ndarray, b: np.ndarray) -> float:
  """RMSE of two normalised paths, (N, 2) each: the paper's template score."""
  return float(np.sqrt(np.mean(np.sum((a - b) ** 2, axis=1))))


@dataclasses.dataclass(frozen=True)
class Codebook:
  """One gesture for each motion symbol.

  Attributes:
    gestures: START, 0, 1 and END, in any order.
  """

  gestures: tuple[Gesture, ...]

  def __post_init__(self) -> None:
    checks.settle(self, 'gestures', tuple(self.gestures))
    symbols = sorted(gesture.symbol for gesture in self.gestures)
    if symbols != sorted(MOTIONS):
      raise CodebookError(
        f'`gestures` must hold each of {[*MOTIONS]} once: got {symbols}'
      )
    for a, b in itertools.combinations(self.gestures, 2):
      distance = separation(
        normalise(a.image_path()), normalise(b.image_path())
      )
      if distance < MINIMUM_SEPARATION:
        raise CodebookError(
          f'`gestures` must differ: {a.symbol} and {b.symbol} have normalised'
          f' paths {distance:.3f} apart, under {MINIMUM_SEPARATION}'
        )

  @property
  def lowest_m(self) -> float:
    """How high its lowest point is, from the hover point: negative below."""
    return min(z_m for each in self.gestures for _, z_m in each.corners_m)

  @property
  def highest_m(self) -> float:
    """How high its highest point is, from the hover point."""
    return max(z_m for each in self.gestures for _, z_m in each.corners_m)

  def __getitem__(self, symbol: Symbol) -> Gesture:
    for gesture in self.gestures:
      if gesture.symbol is symbol:
        return gesture
    raise CodebookError(f'`symbol` must be one of {[*MOTIONS]}: got {symbol}')


def v_codebook(
  half_width_m: float = 0.285,
  start_height_m: float = 0.62,
  duration_s: float = 7.5,
) -> Codebook:
  """The alphabet of the paper's Table 1, which gives shapes but no sizes.

  A bit goes out and back along each arm of its V, so that a view from the
  side narrows both arms alike. START is one-sided: seen edge-on, the vehicle
  shows its belly above and its deck below the camera, and that change of look
  would fall in the middle of a stroke through the hover point. 7.5 s a
  gesture, with `timing.Timing`, puts END and the final null at the paper's
  92.64 s and 95.64 s (section 'Local faults and independent release').

  Args:
    half_width_m: Half the width, and the height, of a V, and half the width of
      END, in m.
    start_height_m: How far START climbs, in m.
    duration_s: Time that each gesture takes, in s.

  Returns:
    The codebook.

  Raises:
    CodebookError: if a size is not one that can be flown.
  """
  w = checks.number('half_width_m', half_width_m, 0.01, 1.2, CodebookError)
  h = checks.number('start_height_m', start_height_m, 0.01, 2.0, CodebookError)
  hover = (0.0, 0.0)
  return Codebook(
    (
      Gesture(Symbol.START, (hover, (0.0, h), hover), duration_s),
      Gesture(Symbol.ZERO, (hover, (-w, w), hover, (w, w), hover), duration_s),
      Gesture(Symbol.ONE, (hover, (-w, -w), hover, (w, -w), hover), duration_s),
      Gesture(Symbol.END, (hover, (-w, 0.0), (w, 0.0), hover), duration_s),
    )
  )
