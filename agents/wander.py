"""How a target that hovers wanders about its place, measured while it rests.

Whoever hovers is never quite still: by some millimetres, slowly, and more in
wind. What is a motion, and what is only that, is told by how far and how fast
it has wandered in the rests so far.
"""

from collections import deque
import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import klt

_SMOOTH_S = 0.4  # Noise of single pictures is no wandering.
_HOME_S = 1.0  # In this time a place of rest follows.
_TIMES, _TIMES_FAST = 8.0, 4.0  # Root mean squares that a rest stays within.
_LITTLE, _LITTLE_PX = 0.0075, 0.25  # In widths, or pixels: less is none.
# A wandering target goes no farther than this, in its widths, and no faster, in
# its widths a second: what does is a motion.
_LEAST, _MOST, _MOST_FAST = 0.3, 0.5, 1.0


class Wander:
  """Measures it.

  Attributes:
    home_px: (2,) where the target rests.
    sways: Whether it wanders so far that it counts.
    away_px: How far from home it has left it...
    back_px: ...and how near it may be back: meanwhile home may have wandered.
    slow_px_s: Below which speed it rests.
  """

  def __init__(
    self, config: config_lib.Excursion, home_px: np.ndarray, width_px: float
  ) -> None:
    """Begins with a target that was never seen to wander.

    Args:
      config: How far and how fast a target that is at rest may be at least.
      home_px: (2,) where it rests.
      width_px: How wide it is.
    """
    self._width_px = width_px
    self._least_px = config.away_px(width_px)
    self._least_px_s = config.slow_px_s(width_px)
    self._ways = self._speeds = self._time_s = 0.0
    self.away_px = self._least_px
    self.back_px = max(_MOST * width_px, self._least_px)
    self.slow_px_s = self._least_px_s
    self.sways = False
    self._recent: deque[tuple[klt.Track, np.ndarray, float]] = deque()
    self._place_px = self._mean_px = self.home_px = home_px
    self._last_s = math.nan

  def settle(self, home_px: np.ndarray) -> None:
    """Takes where a new rest is, (2,)."""
    way_px = home_px - self.home_px
    self.home_px = self._place_px = self._mean_px = home_px
    self._last_s = math.nan
    self._recent.clear()
    if np.hypot(*way_px) > self.away_px:
      self._learn(way_px, 0.0, _HOME_S)

  def rest(self, track: klt.Track, past_s: float) -> None:
    """Takes a target that is seen at rest, unless it leaves it soon.

    Args:
      track: The target.
      past_s: How long at least it must then have been at rest to count.
    """
    elapsed_s = track.time_s - self._last_s
    self._last_s = track.time_s
    if math.isnan(elapsed_s):
      return
    self._place_px = _nearer(
      self._place_px, track.centre_px, elapsed_s, _SMOOTH_S
    )
    self._recent.append((track, self._place_px - self.home_px, elapsed_s))
    while track.time_s - self._recent[0][0].time_s > past_s - 1e-6:
      self._count(*self._recent.popleft())

  def _count(
    self, track: klt.Track, way_px: np.ndarray, elapsed_s: float
  ) -> None:
    self._mean_px = _nearer(self._mean_px, track.centre_px, elapsed_s, _HOME_S)
    self._learn(way_px, track.speed_px_s, elapsed_s)

  def _learn(self, way_px: np.ndarray, speed_px_s: float, time_s: float) -> None:
    """Takes how far from home it was for a time, and how fast."""
    self._ways += time_s * float(way_px @ way_px) / 2
    self._speeds += time_s * speed_px_s**2
    self._time_s += time_s
    usual_px = math.sqrt(self._ways / self._time_s)
    self.sways = usual_px > max(_LITTLE * self._width_px, _LITTLE_PX)
    if self.sways:
      usual_px_s = math.sqrt(self._speeds / self._time_s)
      self.home_px = self._mean_px
      most_px, most_px_s = _MOST * self._width_px, _MOST_FAST * self._width_px
      away_px = max(_TIMES * usual_px, _LEAST * self._width_px)
      self.away_px = max(min(away_px, most_px), self._least_px)
      fast_px_s = min(_TIMES_FAST * usual_px_s, most_px_s)
      self.slow_px_s = max(fast_px_s, self._least_px_s)

  def prime(self, tracks: list[klt.Track], lead_s: float) -> None:
    """Takes the tracks of a target that has just left, up to a lead before."""
    far_px = _MOST * self._width_px
    left_s = math.inf
    for track in tracks[::-1]:
      if track.valid and np.hypot(*(track.centre_px - self.home_px)) < far_px:
        break
      left_s = track.time_s
    home_px = self.home_px
    for track in tracks:
      if track.valid and track.time_s < left_s - lead_s:
        self.rest(track, lead_s)
    self.settle(home_px)


def _nearer(
  place_px: np.ndarray, goal_px: np.ndarray, past_s: float, time_s: float
) -> np.ndarray:
  """A place that follows another one in a time."""
  return place_px + (1 - math.exp(-past_s / time_s)) * (goal_px - place_px)
