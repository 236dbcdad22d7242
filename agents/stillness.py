"""Confirms nulls: the target rests at its anchor for long enough.

Paper, section 'Visual null confirmation'.
"""

import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import klt


class StillnessDetector:
  """Counts how long a target has been at rest; one null per rest."""

  def __init__(self, config: config_lib.Stillness, max_gap_s: float) -> None:
    """Makes the detector.

    Args:
      config: The limits.
      max_gap_s: A longer time between two images begins the rest anew.
    """
    self._config = config
    self._max_gap_s = max_gap_s
    self._since_s = math.nan
    self._last_s = -math.inf
    self._confirmed = False

  def begin(self) -> None:
    """Begins a rest anew, whatever there was."""
    self._since_s, self._confirmed = math.nan, False

  def step(
    self, track: klt.Track, anchor_px: np.ndarray | None, moving: bool
  ) -> bool:
    """Takes one frame's track.

    Args:
      track: The target; a valid one has the tracking quality asked for.
      anchor_px: (2,) where the target was first, or None.
      moving: Whether a gesture is under way.

    Returns:
      Whether this frame confirms a null.
    """
    gap_s, self._last_s = track.time_s - self._last_s, track.time_s
    if moving:
      self._confirmed = False
    still = (
      not moving
      and track.valid
      and track.quality >= self._config.null_quality
      and gap_s <= self._max_gap_s
      and track.speed_px_s < self._config.slow_px_s(track.width_px)
      and np.hypot(*(track.centre_px - anchor_px)) <= self._config.anchor_px
    )
    if not still:
      self._since_s = math.nan
      return False
    if math.isnan(self._since_s):
      self._since_s = track.time_s
    if self._confirmed or not config_lib.lasted(
      self._since_s, track.time_s, self._config.hold_s
    ):
      return False
    self._confirmed = True
    return True
