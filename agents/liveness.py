"""Tells a living camera from one that repeats its images.

No two images of a camera with noise, or of one that sways, are equal. One that
delivers only images that it delivered before shows the past, and stillness in
it proves nothing. A picture without any noise repeats itself when nothing
moves; there nothing can be told, and an old picture with fresh noise passes.
"""

from collections import deque

import numpy as np
import xxhash

_IMAGES = 25  # So many in a row, at rest and all new, are no accident...
_WINDOW = 25  # ...and of so many, the share of old ones counts.


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
    self._repeated: deque[bool] = deque(maxlen=_WINDOW)
    self._new_in_a_row = 0
    self._changes_at_rest = False

  def step(self, image: np.ndarray, resting: bool) -> bool:
    """Takes an image and tells whether the camera may live.

    Args:
      image: Of any shape.
      resting: Whether nothing that is looked at moves in it.
    """
    if self._max_repeated >= 1:
      return True
    name = xxhash.xxh3_64_intdigest(np.ascontiguousarray(image))
    self._repeated.append(name in self._seen)
    self._seen.add(name)
    new = resting and not self._repeated[-1]
    self._new_in_a_row = self._new_in_a_row + 1 if new else 0
    self._changes_at_rest |= self._new_in_a_row >= _IMAGES
    share = sum(self._repeated) / _WINDOW
    return not self._changes_at_rest or share <= self._max_repeated
