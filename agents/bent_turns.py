"""How a picture moves when a camera with a lens turns.

As `turns.Turns`, but by the camera's calibration: through its lens, and in any
part of its picture.
"""

import cv2
import numpy as np

from waggle_tasks.protocol import camera as camera_lib

_STEP_PX = 0.5  # Of a motion whose flow is taken.


class BentTurns:
  """Of a part of a picture: its camera turns about all three axes.

  See `turns.Geometry`.
  """

  count = 3

  def __init__(
    self,
    camera: camera_lib.Camera,
    origin_px: np.ndarray,
    size: tuple[int, int],
    times: int = 1,
  ) -> None:
    """Makes it for a part.

    Args:
      camera: The calibration of the whole picture.
      origin_px: (2,) where the part begins in it.
      size: Width and height of the part...
      times: ...which is so many times smaller than it was.
    """
    self._camera, self._origin_px = camera, origin_px
    self._size, self._times = size, times
    self._grid: np.ndarray | None = None

  def smaller(self, times: int) -> 'BentTurns':
    """See `turns.Geometry`."""
    width, height = self._size
    return BentTurns(
      self._camera,
      self._origin_px,
      (width // times, height // times),
      self._times * times,
    )

  def flow(self, places_px: np.ndarray) -> np.ndarray:
    """See `turns.Geometry`."""
    rays = self._rays(places_px)
    ways = [
      self._shown(rays, step) - self._shown(rays, -step)
      for step in _STEP_PX * np.eye(3)
    ]
    return np.stack(ways) / (2 * _STEP_PX)

  def moved(self, places_px: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """See `turns.Geometry`."""
    shown = self._shown(self._rays(places_px), motion)
    return shown.astype(np.float32)

  def undone(
    self, grey: np.ndarray, motion: np.ndarray, outside: np.ndarray
  ) -> np.ndarray:
    """See `turns.Geometry`."""
    if self._grid is None:
      rows, columns = np.indices(grey.shape).reshape(2, -1)
      self._grid = self._rays(np.stack([columns, rows])).astype(np.float32)
    places = self._shown(self._grid, motion).astype(np.float32)
    x, y = places.reshape(2, *grey.shape)
    return cv2.remap(
      grey, x, y, cv2.INTER_LINEAR, outside.copy(), cv2.BORDER_TRANSPARENT
    )

  def _rays(self, places_px: np.ndarray) -> np.ndarray:
    """(3, K) what is seen at places (2, K) of the part."""
    seen_with, times = self._camera, self._times
    whole = places_px.T * times + (times - 1) / 2 + self._origin_px + 0.5
    shown = (whole - np.array(seen_with.size) / 2) / seen_with.focal_px
    seen = seen_with.lens.seen(shown)
    return np.concatenate([seen, np.ones((len(seen), 1))], axis=1).T

  def _shown(self, rays: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """(2, K) where the part shows rays (3, K) after a motion (3,)."""
    seen_with, times = self._camera, self._times
    x, y, roll = np.asarray(motion, float) * times / seen_with.focal_px
    turn, _ = cv2.Rodrigues(np.array([-y, x, roll]))
    ahead = turn.astype(rays.dtype) @ rays
    shown = seen_with.lens.shown((ahead[:2] / ahead[2]).T)
    whole = shown * seen_with.focal_px + np.array(seen_with.size) / 2 - 0.5
    return ((whole - self._origin_px - (times - 1) / 2) / times).T
