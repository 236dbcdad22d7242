"""Where in a picture something has begun to move, roughly and at once."""

from collections import deque
import math

import cv2
import numpy as np

_SMALLER = 4  # The paper's pictures are compared at this part of their size...
_APART_S = 0.16  # ...with the last one that is older than this.
_LEVELS, _NOISES = 6.0, 6.0  # A change is more, and more than usual ones.
_FEWEST = 3  # Pixels of a motion.
# A camera that moves, or light, changes more of a picture than this.
_MOST_SHARE = 0.1


class Motions:
  """Compares every image with one of a moment before."""

  def __init__(self, zoom: float) -> None:
    """Begins.

    Args:
      zoom: Pixels of the camera's pictures over those of the paper's.
    """
    self._smaller = max(round(_SMALLER * zoom), 1)
    self._images: deque[tuple[float, np.ndarray]] = deque()

  def step(self, grey: np.ndarray, time_s: float) -> list[np.ndarray]:
    """Takes an image, (H, W) uint8, and returns where something moves.

    Returns:
      The middle, (2,) x and y, of each thing that moves.
    """
    height, width = grey.shape
    size = math.ceil(width / self._smaller), math.ceil(height / self._smaller)
    small = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
    self._images.append((time_s, small))
    while len(self._images) > 1 and time_s - self._images[1][0] >= _APART_S:
      self._images.popleft()
    before_s, before = self._images[0]
    if time_s - before_s < _APART_S:
      return []
    change = cv2.absdiff(small, before)
    least = max(_LEVELS, _NOISES * float(np.median(change)))
    moved = (change > least).astype(np.uint8)
    if moved.mean() > _MOST_SHARE:
      return []
    near = cv2.dilate(moved, np.ones((3, 3), np.uint8))
    _, labels, _, middles = cv2.connectedComponentsWithStats(near)
    pixels = np.bincount(labels[moved > 0], minlength=len(middles))
    return [
      self._smaller * (middle + 0.5)
      for middle, count in zip(middles, pixels, strict=True)
      if count >= _FEWEST
    ]
