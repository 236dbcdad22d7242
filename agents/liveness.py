"""Tells a living camera from one that repeats its images.

No two images of a camera with noise, or of one that sways, are equal. One that
delivers only images that it delivered before shows the past, and stillness in
it proves nothing. A picture without any noise repeats itself when nothing
moves; there nothing can be told, and an old picture with fresh noise passes.
"""

from collections import deque

import numpy as np
import xxhash

_IMAGES = 50  # Over so many a camera is judged, which is less than any null.
_FEW = 0.2  # A camera that repeats no more at rest never repeats by itself.


class Liveness:
  """Watches for images that have been seen before."""

  def __init__(self, max_repeated: float) -> None:
    """Begins without an image.

    Args:
      max_repeated: Largest share of old images of a living camera; with 1
        every camera is taken to live.
    """
    self._max_repeated = max_repeated
    self._seen: set[int] = set()
    self._repeated: deque[bool] = deque(maxlen=_IMAGES)
    self._always_new = False

  def step(self, image: np.ndarray) -> None:
    """Takes an image of any shape."""
    if self._max_repeated < 1:
      name = xxhash.xxh3_64_intdigest(np.ascontiguousarray(image))
      self._repeated.append(name in self._seen)
      self._seen.add(name)

  def lives(self) -> bool:
    """Whether the camera may live, asked while what it shows is at rest."""
    share = sum(self._repeated) / _IMAGES
    self._always_new |= share <= _FEW
    return not self._always_new or share <= self._max_repeated
