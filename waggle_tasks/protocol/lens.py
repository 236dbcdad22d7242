"""How a lens bends what it sees: from directions to the picture and back.

Places are in focal lengths from the middle of the picture, x right and y down.
A direction is told by where a pinhole camera would show it; a lens shows it
elsewhere. There are two published models, with the signs and the order of
OpenCV (module calib3d), so that a calibration from there can be written here:

- `brown`: radial k1, k2, k3 and tangential p1, p2 (D. C. Brown, Decentering
  distortion of lenses, 1966; A. E. Conrady, Decentred lens-systems, 1919).
- `fisheye`: the distance from the middle is the angle from the axis, with k1 to
  k4 for what is not quite so (J. Kannala and S. S. Brandt, A generic camera
  model, 2006).
"""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks

MODELS = ('pinhole', 'brown', 'fisheye')
_NUMBERS = ('k1', 'k2', 'p1', 'p2', 'k3', 'k4')
_UNUSED = {'pinhole': _NUMBERS, 'brown': ('k4',), 'fisheye': ('p1', 'p2')}
_LARGEST = 10.0
# Newton's method gains digits as squares: these are more than enough.
_STEPS, _EXACT = 30, 1e-12
_SLOPE = 1e-6  # Of a step whose derivative is taken.


class LensError(errors.WaggleError):
  """A lens that makes no picture."""


@dataclasses.dataclass(frozen=True)
class Lens:
  """A lens; by default a pinhole, which bends nothing.

  Attributes:
    model: One of `MODELS`.
    k1: First radial number of the model.
    k2: The second.
    p1: First tangential number of 'brown'.
    p2: The second.
    k3: Third radial number.
    k4: Fourth radial number of 'fisheye'.
  """

  model: str = 'pinhole'
  k1: float = 0.0
  k2: float = 0.0
  p1: float = 0.0
  p2: float = 0.0
  k3: float = 0.0
  k4: float = 0.0

  def __post_init__(self) -> None:
    checks.choice('lens', self.model, MODELS, LensError)
    limits = dict.fromkeys(_NUMBERS, (-_LARGEST, _LARGEST))
    checks.settle_numbers(self, limits, LensError)
    for name in _UNUSED[self.model]:
      if getattr(self, name):
        raise LensError(
          f'`{name}` must be 0 for the lens {self.model!r}, which has no such'
          f' number: got {getattr(self, name)!r}'
        )

  @property
  def bends(self) -> bool:
    """Whether it shows anything elsewhere than a pinhole does."""
    return self.model == 'fisheye' or any(
      getattr(self, name) for name in _NUMBERS
    )

  def shown(self, places: np.ndarray) -> np.ndarray:
    """Where it shows what a pinhole shows at places, (..., 2) each."""
    places = np.asarray(places, float)
    if not self.bends:
      return places
    square = (places**2).sum(axis=-1, keepdims=True)
    if self.model == 'fisheye':
      radius = np.sqrt(square)
      usual = np.maximum(radius, 1e-12)
      return (
        places * np.where(radius, self._radius(np.arctan(usual)), 1) / usual
      )
    x, y = places[..., :1], places[..., 1:]
    radial = 1 + square * (self.k1 + square * (self.k2 + square * self.k3))
    aside = np.concatenate(
      [
        2 * self.p1 * x * y + self.p2 * (square + 2 * x * x),
        self.p1 * (square + 2 * y * y) + 2 * self.p2 * x * y,
      ],
      axis=-1,
    )
    return places * radial + aside

  def seen(self, shown: np.ndarray) -> np.ndarray:
    """Where a pinhole shows what it shows at places, (..., 2) each.

    `shown` undone; NaN where it shows nothing.
    """
    shown = np.asarray(shown, float)
    if not self.bends:
      return shown
    if self.model == 'fisheye':
      return self._unrolled(shown)
    out = shown.copy()
    for _ in range(_STEPS):
      here = self.shown(out)
      if not np.abs(here - shown).max(initial=0.0) > _EXACT:
        break
      slopes = np.stack(
        [
          (self.shown(out + step) - here) / _SLOPE
          for step in _SLOPE * np.eye(2)
        ],
        axis=-1,
      )  # (..., 2, 2)
      safe = np.linalg.det(slopes)[..., None, None] > 1e-3
      slopes = np.where(safe, slopes, np.eye(2))
      out += np.linalg.solve(slopes, (shown - here)[..., None])[..., 0]
    return self._checked(out, shown)

  def _unrolled(self, shown: np.ndarray) -> np.ndarray:
    radius = np.linalg.norm(shown, axis=-1, keepdims=True)
    angle = radius.copy()
    for _ in range(_STEPS):
      here = self._radius(angle)
      if not np.abs(here - radius).max(initial=0.0) > _EXACT:
        break
      slope = (self._radius(angle + _SLOPE) - here) / _SLOPE
      angle += (radius - here) / np.maximum(slope, 0.1)
    angle = np.where(angle < math.pi / 2, angle, np.nan)
    out = (
      shown * np.where(radius, np.tan(angle), 1) / np.where(radius, radius, 1)
    )
    return self._checked(out, shown)

  def _checked(self, out: np.ndarray, shown: np.ndarray) -> np.ndarray:
    """Places whose picture is as it should be; NaN for others."""
    off = np.abs(self.shown(out) - shown).max(axis=-1, keepdims=True)
    return np.where(off < 1e-7, out, np.nan)

  def _radius(self, angle: np.ndarray) -> np.ndarray:
    """A fisheye's distance from the middle, of angles from the axis."""
    square = angle * angle
    more = self.k3 + square * self.k4
    return angle * (1 + square * (self.k1 + square * (self.k2 + square * more)))
