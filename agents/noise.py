"""How noisy images are, at which brightness."""

import math

import cv2
import numpy as np

_BAND = 16  # Grey levels of like noise...
_FEWEST = 500  # ...that so many pixels tell.
# A pixel is bad for a moment when it differs by so many grey levels and
# standard deviations of the rest, and only so many about it do.
_SPECKLE, _SPECKLE_SIGMAS, _ALONE = 20.0, 8.0, 4
_SPECKLED = 1e-4  # Share of bad pixels of a camera that has some.


class CameraNoise:
  """Noise of images of one scene.

  Its variance is a straight line over brightness: flat for a camera's own
  noise, rising for that of few photons; what is dark counts as the rest.

  Attributes:
    overall: Its standard deviation where it is usual, in grey levels.
  """

  def __init__(self, one: np.ndarray, other: np.ndarray) -> None:
    """Measures it between two images, (h, w) uint8 each."""
    change = np.abs(one.astype(np.int16) - other)
    # The median tells noise from what moves, but only in whole grey levels.
    usual = change <= 6 * np.median(change) + 1
    self.overall = math.sqrt(_variance(change[usual]))
    # The mean of two says nothing of their difference, which one of them does.
    band = cv2.addWeighted(one, 0.5, other, 0.5, 0.0) // _BAND
    found = [change[usual & (band == each)] for each in range(256 // _BAND)]
    kept = [(n, each) for n, each in enumerate(found) if each.size >= _FEWEST]
    self._line = np.array([0.0, self.overall**2])
    if len(kept) > 1:
      self._line = np.polyfit(
        [(number + 0.5) * _BAND for number, _ in kept],
        [_variance(each) for _, each in kept],
        deg=1,
        w=[math.sqrt(each.size) for _, each in kept],
      )

  def variance(self, grey: np.ndarray) -> np.ndarray:
    """Variance (H, W) float32 in a picture (H, W) uint8 without noise."""
    table = np.polyval(self._line, np.arange(256))
    table = np.maximum(table, self.overall**2)
    return cv2.LUT(grey, table.astype(np.float32))


def speckled(one: np.ndarray, other: np.ndarray, noise: float) -> bool:
  """Whether pixels of two images of one scene are bad for a moment.

  Args:
    one: (h, w) uint8.
    other: The same.
    noise: Standard deviation of the rest, in grey levels.
  """
  limit = max(_SPECKLE, _SPECKLE_SIGMAS * noise)
  _, bad = cv2.threshold(cv2.absdiff(one, other), limit, 1, cv2.THRESH_BINARY)
  count = cv2.boxFilter(bad, -1, (3, 3), normalize=False)
  alone = cv2.bitwise_and(bad, cv2.compare(count, _ALONE, cv2.CMP_LE))
  return cv2.countNonZero(alone) > _SPECKLED * one.size


def _variance(change: np.ndarray) -> float:
  """That of one image, from the differences of two."""
  return float(np.mean(change.astype(float) ** 2) / 2)
