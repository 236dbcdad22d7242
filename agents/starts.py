"""Finds every START that is over, whatever comes after it."""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.agents import history as history_lib
from waggle_tasks.agents import joint_config, klt, lock, shapes

_STEP_S = 0.04  # Apart are begins that are tried.
_REFINED_S = (0.02, 0.01, 0.005)  # Steps in which the begin is told.
_BEST_S = 0.12  # For how long no better one may come.


class Starts:
  """Looks for START in what is kept of a target's way."""

  def __init__(
    self,
    shape: shapes.Shapes,
    limits: joint_config.Reading,
    history: history_lib.History,
    focal_px: float,
  ) -> None:
    """Begins.

    Args:
      shape: What START looks like.
      limits: What is one.
      history: Where the target was, which grows meanwhile.
      focal_px: Focal length of the camera.
    """
    self._shape, self._limits = shape, limits
    self._history, self._focal_px = history, focal_px
    self._length_s = shape.alphabet.start.duration_s
    self._best: lock.Lock | None = None  # Of late.
    self._tried_s = -math.inf  # The last begin that was tried.
    self._after_s = -math.inf  # When the next one may begin.

  def step(self, tracks: Sequence[klt.Track]) -> list[lock.Lock]:
    """Every START that is over, and was seen best a moment ago.

    Args:
      tracks: What was added to the history since the last step.
    """
    found = []
    for begin_s in self._begins(tracks):
      fitted = self._fit(begin_s)
      if fitted is not None and begin_s > self._after_s:
        best = self._best
        if best is None or fitted.error < best.error:
          self._best = fitted
      if self._best and begin_s - self._best.begin_s > _BEST_S:
        found.append(self._refined(self._best))
        self._after_s = self._best.begin_s + self._length_s / 4
        self._best = None
    return found

  def _begins(self, tracks: Sequence[klt.Track]) -> np.ndarray:
    """When one may have begun that was not tried before.

    Images may be rare, or not come: what begins between two is found too.
    """
    first_s, last_s = (
      tracks[k].time_s - self._length_s for k in (0, len(tracks) - 1)
    )
    since_s = max(self._tried_s, first_s - self._length_s)
    self._tried_s = last_s
    count = math.ceil((last_s - since_s) / _STEP_S - 1e-6)
    return last_s - _STEP_S * np.arange(count)[::-1]

  def _fit(self, begin_s: float) -> lock.Lock | None:
    """A START that began then, if it may have been one."""
    rest_s = self._limits.start_rest_s
    samples = self._history.samples(begin_s - rest_s)
    fitted = lock.fit(samples, self._shape, begin_s, rest_s)
    if fitted is None or fitted.seen < self._limits.min_seen:
      return None
    if fitted.scale_px * self._limits.max_distance_m < self._focal_px:
      return None  # Whoever hovers does not dance in the distance.
    return fitted if fitted.error <= self._limits.max_start else None

  def _refined(self, start: lock.Lock) -> lock.Lock:
    """The same, as exactly as it can be told when it began."""
    for step_s in _REFINED_S:
      moved = [self._fit(start.begin_s + step_s * k) for k in (-2, -1, 1, 2)]
      start = min([start, *filter(None, moved)], key=lambda each: each.error)
    return start
