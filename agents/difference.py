"""Where a target is in each image, by its difference from what is behind it.

An absolute position in every image: nothing adds up, so nothing drifts.
"""

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib

_MERGE_PX = 7  # Differences as near as this belong together.
Box = tuple[slice, slice]
WHOLE: Box = slice(None), slice(None)


def grey(image: np.ndarray, box: Box = WHOLE) -> np.ndarray:
  """A part of an image, (H, W, 3) RGB or (H, W) grey, in grey."""
  part = image[box]
  return part if part.ndim == 2 else cv2.cvtColor(part, cv2.COLOR_RGB2GRAY)


class Detector:
  """Weighs pixels by how surely they differ from a background."""

  def __init__(self, config: config_lib.Differencing, noise: float) -> None:
    """Makes a detector.

    Args:
      config: Its numbers.
      noise: Standard deviation of the images' noise in grey levels.
    """
    self._config = config
    self.noise = noise
    self.noisy = noise > config.noise_levels
    # How much wider than a target its weights are.
    self.blur_px = config.box_px - 1 if self.noisy else 0

  def weights(
    self,
    grey: np.ndarray,  # (h, w) uint8
    background: np.ndarray,  # (h, w) uint8
    sigmas: float,
    spread: float = 1.0,
  ) -> np.ndarray:
    """Weights (h, w), uint8 or float32, 0 where there is no difference.

    Args:
      grey: A part of an image.
      background: What is behind it.
      sigmas: How far above noise a difference must be.
      spread: Variance of the difference, in that of the noise.
    """
    config = self._config
    if not self.noisy:
      change = cv2.absdiff(grey, background)
      return cv2.subtract(change, config.min_levels)
    change = cv2.subtract(grey, background, dtype=cv2.CV_32F)
    side = config.box_px
    energy = cv2.boxFilter(
      cv2.multiply(change, change), -1, (side, side),
      borderType=cv2.BORDER_REFLECT,
    )  # fmt: skip
    # Noise energy in a box has a standard deviation of sqrt(2) / side.
    floor = spread * self.noise**2 * (1 + sigmas * 2**0.5 / side)
    return cv2.max(cv2.subtract(energy, floor), 0.0)


def noise_between(one: np.ndarray, other: np.ndarray) -> float:
  """Noise of two images of one scene, (h, w) uint8 each, in grey levels."""
  change = np.abs(one.astype(np.int16) - other)
  # The median tells noise from what moves, but only in whole grey levels.
  noise = change[change <= 6 * np.median(change) + 1].astype(float)
  return float(np.sqrt(np.mean(noise**2) / 2))


def centroid(
  weights: np.ndarray, origin_px: tuple[int, int]
) -> tuple[float, np.ndarray]:
  """Sum of weights and their centre, (2,), in image coordinates."""
  moments = cv2.moments(weights)
  total = moments['m00']
  if total <= 0.0:
    return 0.0, np.array(origin_px, float)
  centre_px = np.array([moments['m10'], moments['m01']]) / total
  return total, centre_px + origin_px


class Blobs:
  """Differences that belong together.

  Attributes:
    totals: (N,) the sum of each one's weights; the first, of what is none, is
      zero.
  """

  def __init__(self, weights: np.ndarray) -> None:
    """Finds them.

    Args:
      weights: (H, W) see `Detector.weights`.
    """
    self._weights = weights
    near = np.ones((_MERGE_PX, _MERGE_PX), np.uint8)
    spread = cv2.dilate((weights > 0).astype(np.uint8), near)
    self._count, self._labels = cv2.connectedComponents(spread)
    self.totals = self.sums(weights)

  def sums(self, weights: np.ndarray) -> np.ndarray:
    """(N,) the sum of other weights (H, W) in the place of each."""
    return np.bincount(self._labels.ravel(), weights.ravel(), self._count)

  def only(self, picked: np.ndarray) -> np.ndarray:
    """Weights (H, W) of some of them, given their numbers."""
    return np.where(np.isin(self._labels, picked), self._weights, 0).astype(
      self._weights.dtype
    )
