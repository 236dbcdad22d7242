"""Where a target is in each image, by its difference from what is behind it.

An absolute position in every image: nothing adds up, so nothing drifts.
"""

import math

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import noise as noise_lib

_SOFT_PX = 5  # Side over which a soft picture is averaged.
_MERGE_PX = 7  # Differences as near as this belong together.
Box = tuple[slice, slice]
WHOLE: Box = slice(None), slice(None)


def grey(image: np.ndarray, box: Box = WHOLE) -> np.ndarray:
  """A part of an image, (H, W, 3) RGB or (H, W) grey, in grey."""
  part = image[box]
  return part if part.ndim == 2 else cv2.cvtColor(part, cv2.COLOR_RGB2GRAY)


def soften(grey: np.ndarray) -> np.ndarray:
  """A picture (H, W) with less noise and wider edges."""
  return cv2.blur(grey, (_SOFT_PX, _SOFT_PX))


def slopes(grey: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
  """Grey levels per pixel along x and y, (H, W) float32 each."""
  return tuple(
    cv2.Sobel(grey, cv2.CV_32F, *axis, ksize=3, scale=1 / 8)
    for axis in ((1, 0), (0, 1))
  )


class Background:
  """What is behind a target.

  Attributes:
    grey: (H, W) uint8.
    variance: (H, W) float32, that of noise; None without noise.
    slack: (H, W) uint8, the difference that a picture may show which is not
      quite in its place; None where pictures are.
  """

  def __init__(
    self,
    grey: np.ndarray,
    variance: np.ndarray | None = None,
    slack: np.ndarray | None = None,
  ) -> None:
    self.grey = grey
    self.variance = variance
    self.slack = slack

  def __getitem__(self, box: Box) -> 'Background':
    """A part of it, which shares its memory."""
    parts = [
      None if each is None else each[box]
      for each in (self.variance, self.slack)
    ]
    return Background(self.grey[box], *parts)

  def loosen(self, slack_px: float) -> None:
    """Allows pictures to be out of place by so many pixels."""
    if slack_px > 0:
      near = np.ones((2 * math.ceil(slack_px) + 1,) * 2, np.uint8)
      self.slack = cv2.morphologyEx(self.grey, cv2.MORPH_GRADIENT, near)


class Detector:
  """Weighs pixels by how surely they differ from a background."""

  def __init__(
    self, config: config_lib.Differencing, noise: noise_lib.Noise
  ) -> None:
    """Makes a detector.

    Args:
      config: Its numbers.
      noise: That of the images.
    """
    self._config = config
    self._noise = noise
    self.noise = noise.overall
    self.noisy = noise.overall > config.noise_levels
    # How much wider than a target its weights are.
    self.blur_px = config.box_px - 1 if self.noisy else 0

  def background(self, grey: np.ndarray) -> Background:
    """What is behind a target, of a picture (H, W) uint8 without noise."""
    return Background(grey, self._noise.variance(grey) if self.noisy else None)

  def weights(
    self,
    grey: np.ndarray,  # (h, w) uint8
    background: Background,  # (h, w)
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
      change = cv2.absdiff(grey, background.grey)
      if background.slack is not None:
        change = cv2.subtract(change, background.slack)
      return cv2.subtract(change, config.min_levels)
    change = cv2.subtract(grey, background.grey, dtype=cv2.CV_32F)
    if background.slack is not None:
      slack = background.slack.astype(np.float32)
      change = cv2.max(cv2.subtract(cv2.absdiff(change, 0.0), slack), 0.0)
    side = config.box_px
    energy = cv2.boxFilter(
      cv2.multiply(change, change), -1, (side, side),
      borderType=cv2.BORDER_REFLECT,
    )  # fmt: skip
    # Noise energy in a box has a standard deviation of sqrt(2) / side.
    factor = spread * (1 + sigmas * 2**0.5 / side)
    floor = cv2.multiply(background.variance, factor)
    return cv2.max(cv2.subtract(energy, floor), 0.0)


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

  def inside(self, box: Box) -> np.ndarray:
    """(N,) whether each has a part in a box of the picture."""
    here = np.zeros(self._count, bool)
    here[np.unique(self._labels[box])] = True
    return here

  def only(self, picked: np.ndarray) -> np.ndarray:
    """Weights (H, W) of some of them, given their numbers."""
    return np.where(np.isin(self._labels, picked), self._weights, 0).astype(
      self._weights.dtype
    )
