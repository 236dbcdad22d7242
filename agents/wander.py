"""How a target that hovers wanders about its place, measured while it rests.

Whoever hovers is never quite still: by some millimetres, slowly, and more in
wind. What is a motion, and what is only that, is told by how far and how fast
it has wandered in the rests so far.
"""

from collections import deque
import math

import numpy as np

from waggle_tasks.agents import klt, wandering

_SMOOTH_S = 0.4  # Noise of single pictures is no wandering.
_HOME_S = 1.0  # In this time a place of rest follows.
_LITTLE, _LITTLE_PX = 0.0075, 0.25  # In widths, or pixels: less is none...
_HASTY = 2.0  # ...unless so many times its speed is none of a rest.


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
    self,
    config: wandering.Wandering,
    home_px: np.ndarray,
    width_px: float,
    away_px: float,
    slow_px_s: float,
  ) -> None:
    """Begins with a target that was never seen to wander.

    Args:
      config: What its rest may be.
      home_px: (2,) where it rests.
      width_px: How wide it is.
      away_px: How far from home a target that does not wander has left it.
      slow_px_s: Below which speed such a one rests.
    """
    self._config, self._width_px = config, width_px
    self._least_px, self._least_px_s = away_px, slow_px_s
    self._ways = self._speeds = self._time_s = 0.0
    self.away_px, self.slow_px_s = away_px, slow_px_s
    self._most_px = max(config.most_wander_widths * width_px, away_px)
    self.back_px = max(config.back_widths * width_px, away_px)
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

  def _learn(
    self, way_px: np.ndarray, speed_px_s: float, time_s: float
  ) -> None:
    """Takes how far from home it was for a time, and how fast."""
    self._ways += time_s * float(way_px @ way_px) / 2
    self._speeds += time_s * speed_px_s**2
    self._time_s += time_s
    usual_px = math.sqrt(self._ways / self._time_s)
    usual_px_s = math.sqrt(self._speeds / self._time_s)
    far = usual_px > max(_LITTLE * self._width_px, _LITTLE_PX)
    self.sways = far or _HASTY * usual_px_s > self._least_px_s
    if self.sways:
      config = self._config
      self.home_px = self._mean_px
      far_px = config.wander_widths * self._width_px
      far_px = max(config.wander_times * usual_px, far_px)
      self.away_px = max(min(far_px, self._most_px), self._least_px)
      most_px_s = config.most_wander_widths_s * self._width_px
      fast_px_s = min(config.wander_speeds * usual_px_s, most_px_s)
      self.slow_px_s = max(fast_px_s, self._least_px_s)

  def prime(self, tracks: list[klt.Track], lead_s: float) -> None:
    """Takes the tracks of a target that has just left, up to a lead before."""
    left_s = math.inf
    for track in tracks[::-1]:
      way_px = np.hypot(*(track.centre_px - self.home_px))
      if track.valid and way_px < self._most_px:
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
