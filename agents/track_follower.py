"""Takes the places of somebody else's tracker for those of one of its own."""

from collections import deque
import dataclasses
import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import elapsed, klt, pace

# A rest: places are off their middle by so much, root mean square, before the
# paper's camera...
_REST_PX = 3.0
_REST_WIDTHS = 0.1  # ...or by so many apparent widths.
# Where nobody says how wide a target is: 10 cm, as a Crazyflie, at 1.3 m.
_WIDTH_PX = 32.0


@dataclasses.dataclass(frozen=True, eq=False)
class Home:
  """Where a target rested; see `watchers.Home`.

  Attributes:
    anchor_px: (2,) the median of its places.
    width_px: How wide it is there.
  """

  anchor_px: np.ndarray
  width_px: float


class TrackFollower:
  """A `watchers.Tracker` whose images are places.

  Like a tracker of pictures it learns first where its target rests: what
  moves from the beginning has no place to be away from.

  Attributes:
    ghost: Where the target rested; None as long as that is not known.
    anchor_px: (2,) the same, or where a rest seems to begin; or None.
  """

  def __init__(self, config: config_lib.Differencing, zoom: float) -> None:
    """Begins without a place.

    Args:
      config: Of what it is about rests, speed and loss.
      zoom: Focal length over that of the paper's camera.
    """
    self._config, self._zoom = config, zoom
    self.ghost: Home | None = None
    self.anchor_px: np.ndarray | None = None
    self._begin()

  def _begin(self) -> None:
    """Looks for a rest."""
    self.ghost = self.anchor_px = None
    self._rows: deque[tuple[float, ...]] = deque()
    self._pace = pace.Pace(self._config.speed_s)
    self._centre_px = np.zeros(2)
    self._seen_s = math.inf

  def step(self, image: np.ndarray, time_s: float) -> list[klt.Track]:
    """Takes where the target is.

    Args:
      image: (3,) x right and y down in pixels, and how wide the target is
        there; not numbers where it is not seen, or nobody says.
      time_s: When that was.

    Returns:
      The target, alone.
    """
    place_px, width_px = image[:2].astype(float), float(image[2])
    if not np.isfinite(place_px).all():
      return [self._lose(time_s)]
    speed_px_s = self._pace.step((time_s, *place_px))
    self._centre_px, self._seen_s = place_px, time_s
    if self.ghost is None:
      self._rest(time_s, place_px, width_px)
    wide_px = None if self.ghost is None else self.ghost.width_px
    return [
      klt.Track(time_s, place_px, speed_px_s, 1, 1.0, True, width_px=wide_px)
    ]

  def _rest(self, time_s: float, place_px: np.ndarray, width_px: float) -> None:
    """Waits until all places of a while are about the same."""
    self._rows.append((time_s, *place_px, width_px))
    table = np.array(self._rows)
    middle_px = np.median(table[:, 1:3], axis=0)
    widths_px = table[np.isfinite(table[:, 3]), 3]
    wide_px = self._zoom * _WIDTH_PX
    if len(widths_px):
      wide_px = float(np.median(widths_px))
    off_px = math.sqrt(((table[:, 1:3] - middle_px) ** 2).sum(axis=1).mean())
    if off_px > max(self._zoom * _REST_PX, _REST_WIDTHS * wide_px):
      self._rows.clear()
      self.anchor_px = None
      return
    self.anchor_px = middle_px
    if elapsed.lasted(self._rows[0][0], time_s, self._config.learn_s):
      self.ghost = Home(middle_px, wide_px)

  def _lose(self, time_s: float) -> klt.Track:
    self._pace.forget()
    if time_s - self._seen_s > self._config.relearn_s:
      self._begin()
    elif self.ghost is None:
      self._rows.clear()
    return klt.Track(time_s, self._centre_px, 0.0, 0, 0.0, False)
