"""Cuts a track of absolute positions into gestures: away from rest and back."""

from collections import deque
import math

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import elapsed, klt, segmenter, wander, wandering

_MEAN_S = 0.08  # To either side.
_STEP = 0.02  # Of the span.


class ExcursionSegmenter:
  """Begins a gesture away from rest and ends it back at rest.

  Attributes:
    active: Whether a gesture is under way.
    returned: Whether a gesture may be over: it is back, and slow.
    wander: How the target wanders while it rests.
  """

  def __init__(
    self,
    config: config_lib.Excursion,
    home_px: np.ndarray,
    width_px: float,
    wanders: wandering.Wandering = wandering.Wandering(),
    least_s: float = 0.0,
  ) -> None:
    """Begins with a target at rest.

    Args:
      config: When a gesture begins and ends.
      home_px: (2,) where it rests.
      width_px: How wide it is.
      wanders: What a rest of a target that wanders may be.
      least_s: How long a gesture of a target that wanders lasts at least, by
        the agreed clock: one may pass its home slowly in its middle.
    """
    self._config = config
    self._width_px = width_px
    self._least_s = least_s
    self.wander = wander.Wander(
      wanders,
      home_px,
      width_px,
      config.away_px(width_px),
      config.slow_px_s(width_px),
    )
    self._begin()

  def _begin(self) -> None:
    """Waits for the next gesture."""
    self._lead: deque[klt.Track] = deque()
    self._path: list[klt.Track] = []
    self._away_since_s = self._slow_since_s = self._back_since_s = math.nan
    self._lost_since_s = math.nan
    self.active = self.returned = False

  def step(self, track: klt.Track) -> segmenter.Segment | None:
    """Takes one frame's track.

    Returns:
      The segment that ended with this frame, if one did.
    """
    if not track.valid:
      return self._lose(track)
    self._lost_since_s = math.nan
    config, now_s = self._config, track.time_s
    way_px = np.hypot(*(track.centre_px - self.wander.home_px))
    if not self.active:
      self._rest(track, bool(way_px > self.wander.away_px))
      return None
    self._path.append(track)
    slow = track.speed_px_s < self.wander.slow_px_s
    self.returned = slow and bool(way_px <= self.wander.back_px)
    near = self.wander.sways or bool(way_px <= self.wander.away_px)
    back = self.returned and near
    self._slow_since_s = _since(self._slow_since_s, slow, now_s)
    self._back_since_s = _since(self._back_since_s, back, now_s)
    if elapsed.lasted(self._back_since_s, now_s, config.off_s) and (
      not self.wander.sways
      or elapsed.lasted(self._away_since_s, now_s, self._least_s)
    ):
      # Where home has wandered away, it rests before it is back.
      rested = self._slow_since_s if self.wander.sways else self._back_since_s
      return self._finish(rested)
    if elapsed.lasted(self._slow_since_s, now_s, config.stay_s):
      return self._finish(self._slow_since_s)
    return None

  def _rest(self, track: klt.Track, away: bool) -> None:
    self._lead.append(track)
    lead_s = self._config.lead_s
    while track.time_s - self._lead[0].time_s > lead_s - 1e-6:
      self._lead.popleft()
    self.wander.rest(track, lead_s)
    self._away_since_s = _since(self._away_since_s, away, track.time_s)
    if elapsed.lasted(self._away_since_s, track.time_s, self._config.on_s):
      self._path, self.active = [*self._lead], True

  def _lose(self, track: klt.Track) -> segmenter.Segment | None:
    config, now_s = self._config, track.time_s
    self._lost_since_s = _since(self._lost_since_s, True, now_s)
    self._slow_since_s = self._back_since_s = math.nan
    self.returned = False
    where, limit_s = 'not to be seen', config.coast_s
    if track.outside:
      where, limit_s = 'out of the picture', config.outside_s
    if not elapsed.lasted(self._lost_since_s, now_s, limit_s):
      return None
    if self.active:
      lost_s = now_s - self._lost_since_s
      return self._finish(now_s, f'{where} for {lost_s:.2f} s')
    self._begin()
    return None

  def _finish(self, end_s: float, loss: str | None = None) -> segmenter.Segment:
    path = [each for each in self._path if each.time_s <= end_s]
    path_px = _tidy(
      np.array([each.centre_px for each in path]),
      np.array([each.time_s for each in path]),
    )
    path_px = np.concatenate([[self.wander.home_px], path_px])
    begin_s = self._away_since_s
    if loss is None:
      rest = [t.centre_px for t in self._path if t.time_s >= end_s]
      home_px = np.mean(rest, axis=0)
      if self.wander.sways:
        path_px = np.concatenate([path_px, [home_px]])
      self.wander.settle(home_px)
    self._begin()
    return segmenter.Segment(begin_s, end_s, path_px, loss, self._width_px)


def _tidy(
  path_px: np.ndarray,  # (T, 2)
  times_s: np.ndarray,  # (T,)
) -> np.ndarray:
  """Takes the noise out of a path, which would add to its length.

  A mean over a short time, and then only points that are apart.
  """
  begin = np.searchsorted(times_s, times_s - _MEAN_S - 1e-6)
  end = np.searchsorted(times_s, times_s + _MEAN_S + 1e-6)
  sums = np.concatenate([np.zeros((1, 2)), np.cumsum(path_px, axis=0)])
  path_px = (sums[end] - sums[begin]) / (end - begin)[:, None]
  step_px = _STEP * np.ptp(path_px, axis=0).max(initial=0.0)
  kept = [path_px[0]]
  for each in path_px[1:]:
    if math.hypot(*(each - kept[-1])) > step_px:
      kept.append(each)
  kept.append(path_px[-1])
  return np.array(kept)


def _since(since_s: float, holds: bool, now_s: float) -> float:
  """Since when something holds without a break."""
  if not holds:
    return math.nan
  return now_s if math.isnan(since_s) else since_s
