"""Refuses images and times of another kind, before anything has changed."""

import math
import numbers

import numpy as np

from waggle_tasks.agents import group
from waggle_tasks.protocol import camera


class Images:
  """Checks that images and times are those of one stream."""

  def __init__(self) -> None:
    self._shape: tuple[int, ...] | None = None
    self._time_s = -math.inf

  def check(self, image: np.ndarray, time_s: float) -> None:
    """Takes an image and its time.

    Raises:
      ReceiverError: if the image is not (H, W, 3) uint8 with the height and
        the width of those before, or its time not a later finite number.
    """
    if not isinstance(image, np.ndarray):
      raise group.ReceiverError(
        f'`image` must be a numpy array: got {type(image).__name__}'
      )
    if image.dtype != np.uint8:
      raise group.ReceiverError(f'`image` must be uint8: got {image.dtype}')
    if image.ndim != 3 or image.shape[2] != 3:
      raise group.ReceiverError(
        f'`image` must be (height, width, 3), RGB: got {image.shape}'
      )
    least, most = camera.MIN_SIDE_PX, camera.MAX_SIDE_PX
    if not least <= min(image.shape[:2]) <= max(image.shape[:2]) <= most:
      raise group.ReceiverError(
        f'`image` must be {least} to {most} pixels high and wide:'
        f' got {image.shape[0]} x {image.shape[1]}'
      )
    if self._shape is not None and image.shape != self._shape:
      raise group.ReceiverError(
        f'`image` must be {self._shape} like those before: got {image.shape}'
      )
    if not isinstance(time_s, numbers.Real) or not math.isfinite(time_s):
      raise group.ReceiverError(
        f'`time_s` must be a finite number: got {time_s!r}'
      )
    if time_s <= self._time_s:
      raise group.ReceiverError(
        f'`time_s` must be later than {self._time_s!r}, that of the image'
        f' before: got {time_s!r}'
      )
    self._shape, self._time_s = image.shape, time_s
