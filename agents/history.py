"""Where a target was, for as long as a frame takes."""

import bisect
from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.agents import klt, lock

# A picture that comes again for no longer than this was no rest.
_AGAIN_S = 0.15
_JUMP_PX = 2.0  # Nor was one that stood still and then jumped so far.
_Row = tuple[float, float, float]


class History:
  """Keeps what was seen; a picture that is shown again is seen once."""

  def __init__(self) -> None:
    self._rows: list[_Row] = []
    self._again: list[_Row] = []  # The last place, with later times.

  def __bool__(self) -> bool:
    return bool(self._rows)

  def rest(self, times_s: Sequence[float], place_px: np.ndarray) -> None:
    """Adds times before all others at which the target rested in its place."""
    x_px, y_px = map(float, place_px)
    self._rows = [(time_s, x_px, y_px) for time_s in times_s] + self._rows

  def add(self, track: klt.Track) -> None:
    """Takes one image's track."""
    if not track.valid:
      return
    x_px, y_px = map(float, track.centre_px)
    row = track.time_s, x_px, y_px
    if self._rows and row[1:] == self._rows[-1][1:]:
      self._again.append(row)
      return
    if self._again:
      last = self._rows[-1]
      stood_s = self._again[-1][0] - last[0]
      jump_px = math.dist(row[1:], last[1:])
      if stood_s > _AGAIN_S and jump_px <= _JUMP_PX:
        self._rows += self._again
      self._again = []
    self._rows.append(row)

  def forget(self, now_s: float, keep_s: float) -> None:
    """Drops what is older than is kept, once that is as much again."""
    rows = self._rows
    if rows and now_s - rows[0][0] > 2 * keep_s:
      self._rows = [row for row in rows if row[0] >= now_s - keep_s]

  def samples(self, since_s: float) -> lock.Samples:
    """All since a time."""
    rows = self._rows
    first = bisect.bisect_left(rows, since_s, key=lambda row: row[0])
    again = [row for row in self._again if row[0] >= since_s]
    return lock.Samples.of([*rows[first:], *again])
