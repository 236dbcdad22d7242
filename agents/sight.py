"""How long a target was out of sight."""

import math

from waggle_tasks.agents import klt
from waggle_tasks.protocol import clock


class Sight:
  """Keeps the longest loss of sight since the last event."""

  def __init__(self) -> None:
    self._seen_s = math.nan
    self._begin_anew()

  def _begin_anew(self) -> None:
    self._longest_s, self._from_s = 0.0, math.nan

  def step(self, track: klt.Track) -> None:
    """Takes the target of an image."""
    if math.isnan(self._seen_s):
      self._seen_s = track.time_s
    unseen_s = track.time_s - self._seen_s
    if unseen_s > self._longest_s:
      self._longest_s, self._from_s = unseen_s, self._seen_s
    if track.valid:
      self._seen_s = track.time_s

  def give_up(self) -> None:
    """Notes that what is seen from now on may be another target."""
    self._longest_s, self._from_s = math.inf, self._seen_s

  def event(self, begin_s: float, end_s: float) -> clock.Moment:
    """The moment of an event, and what was not seen before it."""
    moment = clock.Moment(begin_s, end_s, self._longest_s, self._from_s)
    self._begin_anew()
    return moment
