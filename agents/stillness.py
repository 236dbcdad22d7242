"""Confirms nulls: the target rests at its anchor for long enough.

Paper, section 'Visual null confirmation'.
"""

import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import elapsed, klt, wander


class StillnessDetector:
  """Counts how long a target has been at rest; one null per rest.

  Attributes:
    since_s: When the rest began; NaN when there is none.
  """

  def __init__(
    self, config: config_lib.Stillness, max_gap_s: float, blind_s: float = 0.0
  ) -> None:
    """Makes the detector.

    Args:
      config: The limits.
      max_gap_s: A longer time between two images begins the rest anew...
      blind_s: ...as does a longer loss of sight; with 0, as in the paper, any
        loss does.
    """
    self._config = config
    self._blind_s = blind_s
    self._max_gap_s = max(max_gap_s, blind_s)
    self.since_s = math.nan
    self._in_sight_s = math.nan
    self._rested_s = -math.inf
    self._place_px = np.full(2, np.nan)
    self._confirmed = False
    self._wander_px = self._wander_px_s = 0.0

  def begin(self) -> None:
    """Begins a rest anew, whatever there was."""
    self.since_s, self._confirmed = math.nan, False

  def step(
    self,
    track: klt.Track,
    anchor_px: np.ndarray | None,
    moving: bool,
    wanders: wander.Wander | None = None,
  ) -> bool:
    """Takes one frame's track.

    Args:
      track: The target; a valid one has the tracking quality asked for.
      anchor_px: (2,) where the target was first, or None.
      moving: Whether a gesture is under way.
      wanders: How the target wanders while it rests, where that is known.

    Returns:
      Whether this frame confirms a null.
    """
    now_s = track.time_s
    self._wander_px = self._wander_px_s = 0.0
    if wanders is not None and wanders.sways:
      self._wander_px, self._wander_px_s = wanders.away_px, wanders.slow_px_s
    if moving:
      self._confirmed = False
    seen = track.valid and track.quality >= self._config.null_quality
    if not seen and self._blind_s and not moving:
      self._in_sight_s = math.nan
      return False  # Judged when it is seen again.
    if not moving and seen and self._jumps(track):
      return False
    if moving or not seen or not self._still(track, anchor_px):
      self.since_s = self._in_sight_s = math.nan
      return False
    if now_s - self._rested_s > self._max_gap_s + 1e-6:
      self.since_s = self._in_sight_s = math.nan
    self._rested_s, self._place_px = now_s, track.centre_px
    if math.isnan(self.since_s):
      self.since_s = now_s
    if math.isnan(self._in_sight_s):
      self._in_sight_s = now_s
    if self._confirmed or not (
      elapsed.lasted(self.since_s, now_s, self._config.hold_s)
      and elapsed.lasted(self._in_sight_s, now_s, self._config.in_sight_s)
    ):
      return False
    self._confirmed = True
    return True

  def _jumps(self, track: klt.Track) -> bool:
    """Whether it is fast for a moment, and no farther than a jump from rest.

    The pictures of an encoder stay behind, and then catch up at once.
    """
    late = track.time_s - self._rested_s > self._config.jump_s
    if math.isnan(self.since_s) or late or not self._config.jump_widths:
      return False
    way_px = float(np.hypot(*(track.centre_px - self._place_px)))
    return way_px <= self._config.jump_px(
      track.width_px
    ) and track.speed_px_s >= self._slow_px_s(track)

  def _slow_px_s(self, track: klt.Track) -> float:
    return max(self._config.slow_px_s(track.width_px), self._wander_px_s)

  def _still(self, track: klt.Track, anchor_px: np.ndarray | None) -> bool:
    reach_px = self._config.anchor_px + self._wander_px
    return anchor_px is not None and bool(
      track.speed_px_s < self._slow_px_s(track)
      and np.hypot(*(track.centre_px - anchor_px)) <= reach_px
    )
