"""Keeps a background up to date behind a camera that moves aside.

A turn of a camera is undone, but while whoever carries it wanders, what is near
moves before what is far. Such a picture fits its background less and less. So
the background follows, a little at a time: what is seen a few pixels from where
it was is taken into it. The target, and whatever else comes, is not.
"""

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import difference, elapsed

_EVERY_S = 0.4  # Pictures are averaged for so long...
_NEAR_PX = 3  # ...and what is behind moves by no more meanwhile.
_LEVELS = 6  # What it changes besides, in grey levels.
_Gate = tuple[slice, slice]


class Parallax:
  """Averages pictures, and takes what has moved a little."""

  def __init__(self, config: config_lib.Differencing) -> None:
    self._config = config
    self._gates: list[_Gate] = []

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
    if not self._gates:
      self._since_s, self._sum = time_s, np.zeros(grey.shape, np.float32)
    cv2.accumulate(grey, self._sum)
    self._gates.append(gate)
    if not elapsed.lasted(self._since_s, time_s, _EVERY_S):
      return False
    mean = cv2.convertScaleAbs(self._sum, alpha=1 / len(self._gates))
    known = _known(mean, background.grey)
    for each in self._gates:
      known[each] = 0
    cv2.copyTo(mean, known, background.grey)
    background.loosen(self._config.slack_px)
    self._gates = []
    return True


def _known(grey: np.ndarray, behind: np.ndarray) -> np.ndarray:
  """Where a picture is as it was, but for a small shift: (H, W) uint8."""
  near = np.ones((2 * _NEAR_PX + 1,) * 2, np.uint8)
  low = cv2.subtract(cv2.erode(behind, near), _LEVELS)
  high = cv2.add(cv2.dilate(behind, near), _LEVELS)
  return cv2.inRange(grey, low, high)
