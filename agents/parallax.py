"""Keeps a background up to date behind a camera that moves aside.

A turn of a camera is undone, but while whoever carries it wanders, what is near
moves before what is far. Such a picture fits its background less and less. So
the background follows, a little at a time: what is seen a few pixels from where
it was is taken into it. The target, and whatever else comes, is not.
"""

import math

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference, elapsed

_Gate = tuple[slice, slice]


class Parallax:
  """Averages pictures, and takes what has moved a little."""

  def __init__(self, config: config_lib.Differencing) -> None:
    self._config = config
    self._gates: list[_Gate] = []
    self._last_s = -math.inf

  def step(
    self,
    grey: np.ndarray,
    gate: _Gate,
    time_s: float,
    background: difference.Background,
  ) -> bool:
    """Takes a picture in which the target was seen.

    Args:
      grey: (H, W) uint8, aligned with the background.
      gate: Where the target is.
      time_s: Its time.
      background: What is behind the target, which is changed.

    Returns:
      Whether it has been changed.
    """
    config = self._config
    if time_s - self._last_s > config.max_gap_s:
      self._gates = []  # What was seen before is of another way.
    self._last_s = time_s
    if not self._gates:
      self._since_s, self._sum = time_s, np.zeros(grey.shape, np.float32)
    cv2.accumulate(grey, self._sum)
    self._gates.append(gate)
    if not elapsed.lasted(self._since_s, time_s, config.follow_s):
      return False
    mean = cv2.convertScaleAbs(self._sum, alpha=1 / len(self._gates))
    known = self._known(mean, background.grey)
    for each in self._gates:
      known[each] = 0
    cv2.copyTo(mean, known, background.grey)
    background.loosen(config.slack_px)
    self._gates = []
    return True

  def _known(self, grey: np.ndarray, behind: np.ndarray) -> np.ndarray:
    """Where a picture is as it was, but for a small shift: (H, W) uint8."""
    near = np.ones((2 * self._config.follow_px + 1,) * 2, np.uint8)
    low = cv2.subtract(cv2.erode(behind, near), self._config.min_levels)
    high = cv2.add(cv2.dilate(behind, near), self._config.min_levels)
    return cv2.inRange(grey, low, high)
