"""A copy of a recording that shows what a receiver made of it."""

import pathlib

import cv2
import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import reader
from waggle_tasks.experiments.video import encoders, layout, moment, page

_FPS = 12.5
_LEAST_PX, _MOST_PX = 480, 960  # Width of the picture.
# What a full disk and the like make of writing.
_ERRORS = (OSError, errors.WaggleError, cv2.error)


class AnnotatedFilm:
  """Writes the video while a reader works; a context manager.

  Attributes:
    problem: Why it could not be written, which must not end the reading; empty
      while it can.
  """

  def __init__(self, path: pathlib.Path, work: reader.Reader) -> None:
    """Checks the file's name; it is written with the first picture.

    Args:
      path: Its ending chooses the codec; it must not exist.
      work: Whose track, state and symbols are drawn.

    Raises:
      VideoError: if the name chooses no codec, or is taken.
    """
    encoders.check_name(path.name)
    files.check_text(str(path.absolute()), layout.VideoError)
    if path.exists() or not path.parent.is_dir():
      raise layout.VideoError(
        f'`annotate` must be a new file in a folder that exists: got {path}'
      )
    self._path, self._name = path, work.name
    self._watch = moment.Watch(work.name, work, work.agreement)
    # How a picture is drawn, and who takes it; once the first one is here.
    self._made: tuple[page.Single, encoders.Encoder] | None = None
    self._begin_s = 0.0
    self._pictures = 0
    self.problem = ''

  def __enter__(self) -> 'AnnotatedFilm':
    return self

  def __exit__(self, kind: object, error: object, trace: object) -> None:
    if error is None and self._made is not None:
      try:
        self._made[1].close()
      except _ERRORS as problem:
        self._give_up(problem)
    elif error is not None:
      self._drop()

  def take(self, image: np.ndarray, time_s: float) -> None:
    """Shows what the reader made of an image, (H, W, 3) uint8 RGB."""
    if self.problem:
      return
    self._watch.note(())
    try:
      self._write(image, time_s)
    except _ERRORS as problem:
      self._give_up(problem)

  def _write(self, image: np.ndarray, time_s: float) -> None:
    if self._made is None:
      self._made = self._begin(image, time_s)
    drawing, encoder = self._made
    shown = None
    # A constant rate from pictures at any times: the latest one is repeated.
    while self._begin_s + self._pictures / _FPS <= time_s + 1e-6:
      if shown is None:
        sight = self._watch.sight(image)
        now = moment.Instant(time_s, None, (sight,), {}, {})
        shown = drawing.draw(now)
      encoder.write(shown)
      self._pictures += 1

  def _begin(
    self, image: np.ndarray, time_s: float
  ) -> tuple[page.Single, encoders.Encoder]:
    height, width, _ = image.shape
    zoom = min(_MOST_PX / width, max(_LEAST_PX / width, 1.0))
    size = round(zoom * width), round(zoom * height)
    drawing = page.Single(self._name, size=size)
    self._begin_s = time_s
    return drawing, encoders.make(self._path, drawing.size, _FPS)

  def _give_up(self, problem: Exception) -> None:
    self.problem = f'{self._path} could not be written: {problem}'
    self._drop()

  def _drop(self) -> None:
    self._made = None  # Lets go of the file.
    self._path.unlink(missing_ok=True)
