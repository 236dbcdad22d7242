"""Tells a living camera from one that shows the past, where it can be told.

Whether a picture that stays as it is is dead depends on what should be seen: a
motion that the agreed clock expects and that does not come breaks the frame,
so a camera that freezes before END needs no test of life; and while all is at
rest the pictures of a good camera, or of a recording, may repeat themselves.
The one rest that no later motion vouches for is the final one. There it can be
told for cameras whose pictures shimmer: noise makes pixels brighter and darker
all over. When they shimmered in every rest since START and have ceased to, the
camera is dead. Of one without any noise, and of old pictures with fresh noise,
nothing can be known there.
"""

import math

import numpy as np

_STEP_PX = 16  # Of the grid of pixels that are looked at.
_SHIMMER = 0.01  # So many of them are brighter, and as many darker.


class Liveness:
  """Watches for how long pictures do not shimmer."""

  def __init__(self, max_stale_s: float) -> None:
    """Begins without an image.

    Args:
      max_stale_s: How long the images of a camera that shimmers may be stale
        in the final rest; with 0 every camera is taken to live.
    """
    self._max_stale_s = max_stale_s
    self._last: np.ndarray | None = None
    self._seen: set[int] = set()
    self._fresh_s = math.nan
    self._longest_s = 0.0
    self._rests_s: list[float] = []

  def step(self, image: np.ndarray, time_s: float) -> None:
    """Takes an image, (H, W, 3) uint8 RGB."""
    if not self._max_stale_s:
      return
    grid = image[_STEP_PX // 2 :: _STEP_PX, _STEP_PX // 2 :: _STEP_PX].copy()
    name = hash(grid.tobytes())
    if self._last is None or (name not in self._seen and self._shimmers(grid)):
      self._fresh_s = time_s
    self._seen.add(name)
    self._last = grid
    self._longest_s = max(self._longest_s, time_s - self._fresh_s)

  def _shimmers(self, grid: np.ndarray) -> bool:
    least = _SHIMMER * grid.size
    return bool(
      np.count_nonzero(grid > self._last) >= least
      and np.count_nonzero(grid < self._last) >= least
    )

  def event(self, null: bool, before_frame: bool) -> None:
    """Takes an event, between two of which there is one rest or one motion.

    Args:
      null: Whether it ends a rest.
      before_frame: Whether no frame is under way.
    """
    if before_frame:
      self._rests_s = []
    elif null:
      self._rests_s.append(self._longest_s)
    self._longest_s = 0.0

  def lives(self, time_s: float) -> bool:
    """Whether the camera may live, asked in the final rest."""
    if not self._max_stale_s or not self._rests_s:
      return True
    usual_s = max(self._rests_s)
    if usual_s >= self._max_stale_s:
      return True  # It does not shimmer by itself.
    return time_s - self._fresh_s < self._max_stale_s
