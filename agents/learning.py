"""Learns how a scene at rest looks, and how its pictures change by themselves.

Noise of a camera is measured between two images. Where pixels are not
independent, as with noise along rows or in blocks, in pictures coarser than
their grid, or after an encoder, it gathers in places as a target does; how far
is measured as well, around the place where the target rests.
"""

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference, elapsed
from waggle_tasks.agents import noise as noise_lib

_KEPT = 10  # Images by which changes are measured...
_EVERY_S = 0.16  # ...so long one after another.
# Noise of independent pixels gathers up to so many times its variance; what
# gathers more in so few images will gather so many times as much in a dance.
_INDEPENDENT, _MORE = 2.9, 1.6
_MOST_EXCESS = 16.0
_MARGIN_LEVELS, _MOST_LEVELS = 3, 24


class Scene:
  """What is known of a scene while it is at rest.

  Attributes:
    detector: Weighs differences from it.
    first: The first picture.
    speckled: Whether its pixels are bad for a moment here and there.
  """

  def __init__(
    self,
    config: config_lib.Differencing,
    grey: np.ndarray,  # (H, W) uint8
    time_s: float,
    spared: difference.Box,
    watched: difference.Box,
  ) -> None:
    """Begins with a picture.

    Args:
      config: The tracker's numbers.
      grey: The picture.
      time_s: Its time.
      spared: Where the target rests...
      watched: ...and what is around it, where changes are measured.
    """
    self._config = config
    self._spared, self._watched = spared, watched
    self._sum = grey.astype(np.float32)
    self._count = 1
    self._last, self._kept, self._kept_s = grey, [grey], time_s
    self._noise: noise_lib.CameraNoise | None = None
    self.speckled = False
    self.first = difference.Background(grey)
    self.detector = difference.Detector(
      config, noise_lib.CameraNoise(grey, grey)
    )

  def look(self, grey: np.ndarray) -> None:
    """Tells noise by two pictures of which neither is a copy."""
    if self._noise is None and not np.array_equal(grey, self._last):
      self._noise = noise_lib.CameraNoise(self._last, grey)
      level = self._noise.overall
      self.speckled = noise_lib.speckled(self._last, grey, level)
      self.detector = difference.Detector(self._config, self._noise)
      soft = difference.soften(self.first.grey)
      self.first.variance = self.detector.background(soft).variance
      self.detector = self._tuned([grey], self.first, 2.0)
    self._last = grey

  def add(self, grey: np.ndarray, time_s: float) -> None:
    """Takes a picture in which nothing has moved."""
    self._sum += grey
    due = elapsed.lasted(self._kept_s, time_s, _EVERY_S)
    if due and len(self._kept) < _KEPT:
      self._kept.append(grey)
      self._kept_s = time_s
    self._count += 1

  @property
  def background(self) -> difference.Background:
    """The mean of all pictures; the detector is tuned to how they vary."""
    mean = np.rint(self._sum / self._count).astype(np.uint8)
    known = self.detector.background(mean)
    self.detector = self._tuned(self._kept, known, 1.0)
    return known

  def _tuned(
    self, greys: list[np.ndarray], known: difference.Background, spread: float
  ) -> difference.Detector:
    """A detector that takes what scenes do by themselves for no motion."""
    if self._noise is None:
      return self.detector
    plain = difference.Detector(self._config, self._noise)
    strongest = max(self._strongest(plain, each, known) for each in greys)
    if plain.noisy:
      gathers = strongest / spread
      usual = plain.factor(self._config.watch_sigmas, 1.0)
      excess = _MORE * gathers / usual if gathers > _INDEPENDENT else 1.0
      excess = min(excess, _MOST_EXCESS)
      return difference.Detector(self._config, self._noise, excess)
    levels = min(int(strongest) + _MARGIN_LEVELS, _MOST_LEVELS)
    return difference.Detector(self._config, self._noise, levels=levels)

  def _strongest(
    self,
    detector: difference.Detector,
    grey: np.ndarray,
    known: difference.Background,
  ) -> float:
    """The strongest difference around the place of the target."""
    strength = detector.strength(grey[self._watched], known[self._watched])
    rows, columns = (
      slice(inner.start - outer.start, inner.stop - outer.start)
      for inner, outer in zip(self._spared, self._watched, strict=True)
    )
    strength[rows, columns] = 0
    return float(strength.max())
