"""What a receiver makes of its camera's calibration: places, not pictures.

Trackers look at pictures as they come. What they find is told by where a level
pinhole would show it: so a straight way is straight, and up is up.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks.agents import bent_turns, klt
from waggle_tasks.protocol import camera as camera_lib

_STEP_PX = 0.5  # Of two places whose distance is compared.


class Calibrated:
  """Undoes a camera's lens and mount, of places.

  Attributes:
    window: The largest part of a picture in whose middle is what is straight
      and level ahead: trackers begin there.
  """

  def __init__(self, camera: camera_lib.Camera) -> None:
    """Makes it for a camera; a plain one changes nothing."""
    self._camera = camera
    self._plain = camera.is_plain
    self._origin_px = np.zeros(2)
    self.window = slice(0, camera.rows), slice(0, camera.columns)
    if not self._plain:
      self._look_ahead()

  def _look_ahead(self) -> None:
    size = np.array(self._camera.size)
    ahead = self._camera.shown(size / 2)
    reach = np.minimum(ahead, size - ahead)
    if not (reach >= camera_lib.MIN_SIDE_PX / 2).all():
      return  # It looks so far up or down that nothing can be asked for.
    begin = np.rint(ahead - reach).astype(int)
    (left, top), (right, bottom) = begin, begin + (2 * reach).astype(int)
    self._origin_px = begin.astype(float)
    self.window = slice(int(top), int(bottom)), slice(int(left), int(right))

  @property
  def bends(self) -> bent_turns.BentTurns | None:
    """How trackers' pictures move when the camera turns; None if plain."""
    if self._plain:
      return None
    rows, columns = self.window
    size = columns.stop - columns.start, rows.stop - rows.start
    return bent_turns.BentTurns(self._camera, self._origin_px, size)

  def part(self, image: np.ndarray) -> np.ndarray:
    """What trackers are given of an image, (H, W, 3)."""
    return image if self._plain else image[self.window]

  def seen(self, track: klt.Track) -> klt.Track:
    """A tracker's track as places in the picture."""
    if self._plain:
      return track
    return dataclasses.replace(
      track, centre_px=track.centre_px + self._origin_px
    )

  def levelled(self, track: klt.Track) -> klt.Track:
    """A tracker's track as a level pinhole would have it."""
    if self._plain:
      return track
    scale, width_px = self.scale(track.centre_px), track.width_px
    return dataclasses.replace(
      track,
      centre_px=self.place(track.centre_px),
      speed_px_s=track.speed_px_s * scale,
      width_px=None if width_px is None else width_px * scale,
    )

  def place(self, place_px: np.ndarray) -> np.ndarray:
    """(2,) where a level pinhole shows a place of a tracker, (2,)."""
    if self._plain:
      return place_px
    place_px = place_px + self._origin_px
    level_px = self._camera.levelled(place_px)
    return level_px if np.isfinite(level_px).all() else place_px

  def scale(self, place_px: np.ndarray) -> float:
    """How much larger a level pinhole shows what is there."""
    if self._plain:
      return 1.0
    steps = _STEP_PX * np.eye(2)
    ways = [self.place(place_px + s) - self.place(place_px - s) for s in steps]
    return math.sqrt(abs(float(np.linalg.det(ways)))) / (2 * _STEP_PX)
