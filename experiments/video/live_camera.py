"""A camera of this machine, read while it looks."""

from collections.abc import Iterator
import functools
import math
import time

import cv2
import numpy as np

from waggle_tasks.experiments.machine import quiet
from waggle_tasks.experiments.video import sources

_MOST = 63  # Highest number of a camera.


class CameraError(sources.RecordingError):
  """A camera that is not there, or gives no picture."""


class LiveCamera:
  """A `Source`: pictures as they come, by the clock of this machine."""

  length_s = math.nan  # Nobody knows.

  def __init__(self, number: int) -> None:
    """Opens a camera and takes its first picture.

    Args:
      number: Which, from 0.

    Raises:
      CameraError: if there is none, or it gives no picture.
    """
    if not 0 <= number <= _MOST:
      raise CameraError(
        f'`camera` must be a number from 0 to {_MOST}: got {number}'
      )
    self._name = f'camera {number}'
    with quiet.quiet():  # OpenCV lists on the screen where it looked.
      self._capture = cv2.VideoCapture(number)
    if not self._capture.isOpened():
      raise CameraError(
        f'there is no {self._name} that can be opened: give another number, or'
        ' look whether it is plugged in and not in use'
      )
    first = self._take()
    if first is None:
      self.close()
      raise CameraError(f'{self._name} gives no picture')
    self.height, self.width = first.shape[:2]
    sources.check_size(self._name, self.width, self.height)

  def close(self) -> None:
    """Lets go of the camera."""
    self._capture.release()

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`; ends when the camera does."""
    begin_s = None
    while (image := self._take()) is not None:
      now_s = time.monotonic()
      begin_s = now_s if begin_s is None else begin_s
      yield now_s - begin_s, functools.partial(_rgb, image)

  def _take(self) -> np.ndarray | None:
    """The next picture as the camera gives it, when there is one."""
    there, image = self._capture.read()
    return image if there else None

  def check(self) -> None:
    """See `Source`."""

  def missing(self) -> str:
    """See `Source`: nobody knows what might have come."""
    return ''


def _rgb(image: np.ndarray) -> np.ndarray:
  kind = cv2.COLOR_GRAY2RGB if image.ndim == 2 else cv2.COLOR_BGR2RGB
  return cv2.cvtColor(image, kind)
