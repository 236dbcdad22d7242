"""Cuts the track into gestures by image speed.

Paper, section 'RGB optical flow and trajectory recognition'.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import elapsed, klt


@dataclasses.dataclass(frozen=True, eq=False)
class Segment:
  """One motion, from stillness to stillness.

  Attributes:
    begin_s: When it began.
    end_s: When it came to rest.
    path_px: (T, 2) the track in between, x right and y down.
    loss: Why the track was lost on the way, or None.
    width_px: How wide the target is, where the tracker knows.
  """

  begin_s: float
  end_s: float
  path_px: np.ndarray
  loss: str | None = None
  width_px: float | None = None


class Segmenter:
  """Begins a gesture on fast motion and ends it on slow."""

  def __init__(
    self, motion: config_lib.Motion, tracking: config_lib.Tracking
  ) -> None:
    self._motion = motion
    self._tracking = tracking
    self._tracks: list[klt.Track] = []
    self._fast_since_s = math.nan
    self._slow_since_s = math.nan
    self._lost_since_s = math.nan
    self.active = False

  def step(self, track: klt.Track) -> Segment | None:
    """Takes one frame's track.

    Returns:
      The segment that ended with this frame, if one did.
    """
    self._tracks.append(track)
    if not track.valid:
      return self._lose(track)
    self._lost_since_s = math.nan
    if not self.active:
      if track.speed_px_s <= self._motion.on_px_s:
        self._fast_since_s = math.nan
        del self._tracks[:-1]
      elif math.isnan(self._fast_since_s):
        self._fast_since_s = track.time_s
      if elapsed.lasted(self._fast_since_s, track.time_s, self._motion.on_s):
        self.active, self._slow_since_s = True, math.nan
      return None
    if track.speed_px_s >= self._motion.off_px_s:
      self._slow_since_s = math.nan
    elif math.isnan(self._slow_since_s):
      self._slow_since_s = track.time_s
    if elapsed.lasted(self._slow_since_s, track.time_s, self._motion.off_s):
      return self._finish(self._slow_since_s, None)
    return None

  def _lose(self, track: klt.Track) -> Segment | None:
    if math.isnan(self._lost_since_s):
      self._lost_since_s = track.time_s
    if not elapsed.lasted(
      self._lost_since_s, track.time_s, self._tracking.coast_s
    ):
      return None
    if self.active:
      return self._finish(track.time_s, track.loss(self._tracking))
    self._fast_since_s = math.nan
    del self._tracks[:-1]
    return None

  def _finish(self, end_s: float, loss: str | None) -> Segment:
    path_px = np.array([t.centre_px for t in self._tracks if t.time_s <= end_s])
    segment = Segment(self._fast_since_s, end_s, path_px, loss)
    self.active = False
    self._fast_since_s = self._slow_since_s = math.nan
    del self._tracks[:-1]
    return segment
