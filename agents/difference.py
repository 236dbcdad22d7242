"""Where a target is in each image, by its difference from what is behind it.

An absolute position in every image: nothing adds up, so nothing drifts.
"""

import math

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import light
from waggle_tasks.agents import noise as noise_lib

_SOFT_PX = 5  # Side over which a soft picture is averaged.
_NEIGHBOURS = 3  # Pixels of a square of 3 x 3 that differ, of a thing.
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


def despeckled(image: np.ndarray) -> np.ndarray:
  """An image in grey, (H, W) uint8, without pixels that are bad alone."""
  return cv2.medianBlur(grey(image), 3)


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
    self,
    config: config_lib.Differencing,
    noise: noise_lib.CameraNoise,
    excess: float = 1.0,
    levels: int = 0,
  ) -> None:
    """Makes a detector.

    Args:
      config: Its numbers.
      noise: That of the images.
      excess: How much more noise gathers in places than it would if pixels
        were independent.
      levels: How much pixels change by themselves where there is no noise.
    """
    self._config = config
    self._noise = noise
    self._excess = max(excess, 1.0)
    self._levels = max(config.min_levels, levels)
    self.noise = noise.overall
    self.noisy = noise.overall > config.noise_levels
    # How much wider than a target its weights are.
    self.blur_px = config.box_px - 1 if self.noisy else 0

  def background(self, grey: np.ndarray) -> Background:
    """What is behind a target, of a picture (H, W) uint8 without noise."""
    return Background(grey, self._noise.variance(grey) if self.noisy else None)

  def factor(self, sigmas: float, spread: float) -> float:
    """How much energy a box must have to differ, in that of noise.

    Args:
      sigmas: How far above noise, for independent pixels.
      spread: Variance of the difference, in that of the noise.
    """
    # Noise energy in a box has a standard deviation of sqrt(2) / side.
    usual = 1 + sigmas * 2**0.5 / self._config.box_px
    return self._excess * spread * usual

  def strength(self, grey: np.ndarray, background: Background) -> np.ndarray:
    """How strongly pixels (h, w) differ: energy in that of noise, or levels."""
    if not self.noisy:
      return self._change(grey, background, 0, wide=True)
    return self._energy(grey, background, wide=True) / background.variance

  def weights(
    self,
    grey: np.ndarray,  # (h, w) uint8
    background: Background,  # (h, w)
    sigmas: float,
    spread: float = 1.0,
    wide: bool = False,
  ) -> np.ndarray:
    """Weights (h, w), uint8 or float32, 0 where there is no difference.

    Args:
      grey: A part of an image.
      background: What is behind it.
      sigmas: How far above noise a difference must be.
      spread: Variance of the difference, in that of the noise.
      wide: Whether a target covers little of the part.
    """
    if not self.noisy:
      return self._change(grey, background, self._levels, wide)
    floor = cv2.multiply(background.variance, self.factor(sigmas, spread))
    energy = self._energy(grey, background, wide)
    return cv2.max(cv2.subtract(energy, floor), 0.0)

  def _change(
    self, grey: np.ndarray, background: Background, levels: int, wide: bool
  ) -> np.ndarray:
    """By how many levels (h, w) uint8 pixels differ more than by some."""
    behind, unexplained = light.lit(background.grey, grey, self.noise, wide)
    change = cv2.absdiff(grey, behind)
    if background.slack is not None:
      change = cv2.subtract(change, background.slack)
    return gathered(cv2.subtract(change, levels + unexplained))

  def _energy(
    self, grey: np.ndarray, background: Background, wide: bool
  ) -> np.ndarray:
    """Mean square (h, w) float32 of differences about each pixel."""
    behind, unexplained = light.lit(background.grey, grey, self.noise, wide)
    change = cv2.subtract(grey, behind, dtype=cv2.CV_32F)
    slack = background.slack
    if slack is not None or unexplained:
      loose = unexplained + (0.0 if slack is None else slack.astype(np.float32))
      change = cv2.max(cv2.absdiff(change, 0.0) - loose, 0.0)
    side = self._config.box_px
    return cv2.boxFilter(
      cv2.multiply(change, change), -1, (side, side),
      borderType=cv2.BORDER_REFLECT,
    )  # fmt: skip


def gathered(weights: np.ndarray) -> np.ndarray:
  """Weights (h, w) uint8 without those of single pixels, which are bad."""
  if not cv2.countNonZero(weights):
    return weights
  _, present = cv2.threshold(weights, 0, 1, cv2.THRESH_BINARY)
  count = cv2.boxFilter(present, -1, (3, 3), normalize=False)
  mask = cv2.compare(count, _NEIGHBOURS, cv2.CMP_GE)
  return cv2.bitwise_and(weights, weights, mask=mask)


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


def extent_px(weights: np.ndarray) -> np.ndarray:
  """How wide and high weights (h, w) are spread, (2,) standard deviations."""
  moments = cv2.moments(weights)
  if moments['m00'] <= 0.0:
    return np.zeros(2)
  squares = np.array([moments['mu20'], moments['mu02']]) / moments['m00']
  return np.sqrt(np.maximum(squares, 0.0))


def alike(
  weights: np.ndarray, known_px: np.ndarray, config: config_lib.Differencing
) -> bool:
  """Whether weights (h, w) may be those of what was spread in a known way.

  Args:
    weights: The weights.
    known_px: (2,) see `extent_px`.
    config: How many times more, or less, each may be; 0 asks for nothing.
  """
  most = np.array([config.most_wider, config.most_higher])
  if not most.any():
    return True
  more = np.maximum(extent_px(weights), 1e-9) / np.maximum(known_px, 1e-9)
  return bool(((most == 0) | ((more <= most) & (more * most >= 1))).all())


def middle(image: np.ndarray, side: int) -> Box:
  """A square in the middle of an image."""
  height, width = image.shape[:2]
  return (
    slice(max((height - side) // 2, 0), (height + side) // 2),
    slice(max((width - side) // 2, 0), (width + side) // 2),
  )


def strict(known: Background, side: int) -> Background:
  """A background without slack, which would hide a ghost, in the middle."""
  if (slack := known.slack) is not None:
    slack = slack.copy()
    slack[middle(slack, side)] = 0
  return Background(known.grey, known.variance, slack)
