"""Learns what is behind a target before it has ever moved."""

import dataclasses

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference, ghost

_CONTRAST_PX = 96  # Side of the square in which there must be something.
_MIN_PIXELS = 4  # Fewest pixels of a motion.


@dataclasses.dataclass(frozen=True, eq=False)
class Departure:
  """A target that has left the place where it hovered.

  Attributes:
    detector: Weighs differences.
    background: (H, W) uint8 without the target.
    ghost: Where the target was.
    greys: Times and images, (H, W) uint8, since its motion began.
  """

  detector: difference.Detector
  background: np.ndarray
  ghost: ghost.Ghost
  greys: list[tuple[float, np.ndarray]]


class Hover:
  """Watches a target that rests in the middle until it has left.

  Attributes:
    visible: Whether there is something, at rest, in the last image.
  """

  def __init__(self, config: config_lib.Differencing) -> None:
    self._config = config
    self._forget()

  def _forget(self) -> None:
    self._first: np.ndarray | None = None
    self._background: np.ndarray | None = None
    self._separation: ghost.Separation | None = None
    self.visible = False

  def step(self, image: np.ndarray, time_s: float) -> Departure | None:
    """Takes an image, (H, W, 3) uint8, later than the last one."""
    self.visible = False
    if self._separation is not None:
      return self._separate(difference.grey(image), time_s)
    if self._background is not None:
      return self._watch(image, time_s)
    self._learn(difference.grey(image), time_s)
    return None

  def _learn(self, grey: np.ndarray, time_s: float) -> None:
    """Adds an image to the background, or begins a new one with it."""
    if self._first is None:
      self._begin(grey, time_s)
      return
    middle = _middle(grey, self._config.watch_px)
    if self._count == 1:
      noise = difference.noise_between(grey[middle], self._first[middle])
      self._detector = difference.Detector(self._config, noise)
    if self._moved(grey[middle], self._first[middle], 2.0):
      self._begin(grey, time_s)
      return
    cv2.accumulate(grey, self._sum)
    self._count += 1
    self.visible = self._contrast
    if config_lib.lasted(self._since_s, time_s, self._config.learn_s):
      self._background = np.rint(self._sum / self._count).astype(np.uint8)
      self._last = None

  def _begin(self, grey: np.ndarray, time_s: float) -> None:
    self._first, self._sum = grey, grey.astype(np.float32)
    self._count, self._since_s = 1, time_s
    smooth = cv2.blur(grey[_middle(grey, _CONTRAST_PX)], (5, 5))
    self._contrast = bool(np.ptp(smooth) >= self._config.min_contrast)

  def _watch(self, image: np.ndarray, time_s: float) -> Departure | None:
    middle = _middle(image, self._config.watch_px)
    if self._last is None or not np.array_equal(image[middle], self._last):
      self._last = image[middle].copy()
      grey = difference.grey(image, middle)
      if self._moved(grey, self._background[middle], 1.0):
        self._since_s = time_s
        self._separation = ghost.Separation(
          self._detector, self._background, self._config.watch_sigmas
        )
        return self._separate(difference.grey(image), time_s)
    self.visible = self._contrast
    return None

  def _moved(
    self, grey: np.ndarray, background: np.ndarray, spread: float
  ) -> bool:
    sigmas = self._config.watch_sigmas
    weights = self._detector.weights(grey, background, sigmas, spread)
    return cv2.countNonZero(weights) >= _MIN_PIXELS

  def _separate(self, grey: np.ndarray, time_s: float) -> Departure | None:
    found = self._separation.step(grey, time_s)
    if found is not None:
      return Departure(
        self._detector, self._background, found, self._separation.greys
      )
    if config_lib.lasted(self._since_s, time_s, self._config.separate_s):
      self._forget()
    elif not self._moved(grey, self._background, 1.0):
      self._separation = None
    return None


def _middle(image: np.ndarray, side: int) -> tuple[slice, slice]:
  """A square in the middle of an image."""
  height, width = image.shape[:2]
  return (
    slice(max((height - side) // 2, 0), (height + side) // 2),
    slice(max((width - side) // 2, 0), (width + side) // 2),
  )
