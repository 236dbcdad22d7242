"""Dances of heights as a tracker sees them from somewhere, many at once.

No simulator takes part: strokes by minimum jerk, the projection of a pinhole
camera at the dancer's height, and the tracker's error.
"""

import dataclasses

import numpy as np

from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import levels, minimum_jerk
from waggle_tasks.rl import needs

RATE_HZ = 25.0
REACH_M = 0.14  # As high as the levels of `swift`.
STROKE_S = levels.least_s(2 * REACH_M)  # From the lowest to the highest.
DISTANCES_M = 0.6, 3.0
MOST_WAIT_S = 1.0
_AFTER_S = 0.4
# The tracker's error is 2 mm root mean square at every distance.
_ERROR_M = 0.002
_LOST_SHARE = 0.02


@dataclasses.dataclass(frozen=True)
class Channel:
  """What is between who dances and who watches.

  Attributes:
    strokes: How many heights a dance has, 1 to 16.
    error_m: Root mean square of the tracker's error, in metres at the dancer, 0
      to 0.1.
    lost_share: Share of images in which the dancer is not seen, 0 to 1.
  """

  strokes: int = 3
  error_m: float = _ERROR_M
  lost_share: float = _LOST_SHARE

  def __post_init__(self) -> None:
    for name, least, most in (
      ('strokes', 1, 16), ('error_m', 0, 0.1), ('lost_share', 0, 1),
    ):  # fmt: skip
      value = getattr(self, name)
      if not least <= value <= most:
        raise needs.LearningError(
          f'`{name}` must be {least} to {most:g}: got {value!r}'
        )

  @property
  def frames(self) -> int:
    """How many images a track has."""
    moved_s = (self.strokes + 1) * STROKE_S  # The last one leads home.
    return round((MOST_WAIT_S + moved_s + _AFTER_S) * RATE_HZ)

  def tracks(
    self,
    heights: np.ndarray,  # (B, strokes) from -1 to 1
    rng: np.random.Generator,
  ) -> np.ndarray:
    """What watchers see of dances; from where and since when is drawn.

    Args:
      heights: Where each stroke ends, in `REACH_M`.
      rng: Draws views, waits, errors and losses.

    Returns:
      (B, frames, 2) float32: the height above the middle of the picture, in its
      half width, 0 where it is not seen; and whether it is seen, 1 or 0.
    """
    count = len(heights)
    up_m = self.paths(heights, rng.uniform(0, MOST_WAIT_S, count))
    up_m += rng.normal(0.0, self.error_m, up_m.shape)
    camera = camera_lib.Camera()
    half_width = camera.size[0] / 2 / camera.focal_px
    away_m = rng.uniform(*DISTANCES_M, count)[:, None]
    seen = rng.random(up_m.shape) >= self.lost_share
    places = np.where(seen, up_m / (away_m * half_width), 0.0)
    return np.stack([places, seen], -1).astype(np.float32)

  def paths(
    self,
    heights: np.ndarray,  # (B, strokes) from -1 to 1
    waits_s: np.ndarray,  # (B,) before the first stroke
  ) -> np.ndarray:
    """How high dancers are in each image, (B, frames) in m."""
    corners_m = np.zeros((len(heights), self.strokes + 2))
    corners_m[:, 1:-1] = np.clip(heights, -1, 1) * REACH_M
    times_s = np.arange(self.frames) / RATE_HZ
    at = np.clip((times_s - waits_s[:, None]) / STROKE_S, 0, self.strokes + 1)
    stroke = np.minimum(at.astype(int), self.strokes)
    begin_m = np.take_along_axis(corners_m, stroke, 1)
    end_m = np.take_along_axis(corners_m, stroke + 1, 1)
    return begin_m + minimum_jerk.fraction(at - stroke) * (end_m - begin_m)
