"""Films a conversation: what all members see, side by side."""

import math
import pathlib
from typing import Self

import cv2
import numpy as np

from waggle_tasks import conversation
from waggle_tasks.experiments.video import encoders

NAME = 'converse.webm'
_WIDTH_PX = 320  # Of one member's picture.
_FPS = 12.5
_COLUMNS = 3


class TalkFilm:
  """An onlooker that leaves a film; a context manager."""

  def __init__(
    self, folder: pathlib.Path, scene: conversation.Conversation
  ) -> None:
    """Opens the file.

    Args:
      folder: Where it goes.
      scene: What is going to be held.
    """
    self._names = [*scene.poses()]
    lens = scene.accord.agreement.camera
    self._size = _WIDTH_PX, 2 * round(_WIDTH_PX * lens.rows / lens.columns / 2)
    self._across = min(_COLUMNS, len(self._names))
    rows = math.ceil(len(self._names) / self._across)
    whole = self._across * self._size[0], rows * self._size[1]
    self._blank = np.zeros((whole[1], whole[0], 3), np.uint8)
    self._next_s = 0.0
    encoder = encoders.make(folder / NAME, whole, _FPS)
    self._worker = encoders.Worker(encoder)

  def __enter__(self) -> Self:
    return self

  def __exit__(self, *error: object) -> None:
    """Completes the file."""
    self._worker.close()

  def watch(self, images: list[np.ndarray], time_s: float) -> None:
    """Takes the images of all members, (H, W, 3) uint8 RGB each."""
    if time_s + 1e-6 < self._next_s:
      return
    self._next_s += 1 / _FPS
    small = [
      cv2.resize(image, self._size, interpolation=cv2.INTER_AREA)
      for image in images
    ]
    self._worker.put(lambda: self._draw(small, time_s))

  def _draw(self, small: list[np.ndarray], time_s: float) -> np.ndarray:
    picture = self._blank.copy()
    width, height = self._size
    for number, (name, image) in enumerate(
      zip(self._names, small, strict=True)
    ):
      row, column = divmod(number, self._across)
      left, top = column * width, row * height
      picture[top : top + height, left : left + width] = image
      words = f'{name} {time_s:.1f} s'
      cv2.putText(
        picture, words, (left + 6, top + 16), cv2.FONT_HERSHEY_SIMPLEX, 0.45,
        (20, 20, 20), 1, cv2.LINE_AA,
      )  # fmt: skip
    return picture
