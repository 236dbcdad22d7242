"""Reads any recording by its own times, within bounds.

A broken, endless or hostile file costs a bounded time and memory and gives
one clear error.
"""

from collections.abc import Iterator
import math
import pathlib

import cv2
import numpy as np

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.video import (
  event_film,
  live_camera,
  opencv_film,
  picture_folder,
  recording_part,
  sources,
)
from waggle_tasks.protocol import checks

MAX_LENGTH_S = 3600.0
_SLACK_S = 1.0  # A container may announce so much more than it holds.
# Pictures nearer than this are one: nothing that is danced moves between them.
NEAR_S = 0.0095
_MOST_STUCK = 5000  # Pictures in a row without a time of their own.

RecordingPart = recording_part.RecordingPart
RecordingError = sources.RecordingError


class Recording:
  """An open recording; a context manager.

  Attributes:
    width: Of its picture in pixels, as it is shown.
    height: The same.
    length_s: What its container announces, as a hint; NaN when it does not.
    note: What should be said of what was read; empty when it is plain.
    name: What people call it.
    live: Whether it is being made while it is read.
  """

  def __init__(
    self,
    path: pathlib.Path,
    fps: float | None = None,
    source: sources.Source | None = None,
  ) -> None:
    """Opens a film, a file of events, or a folder of pictures.

    Args:
      path: The file or folder.
      fps: Pictures a second, where pictures have no times of their own.
      source: What is open already, as a camera; `path` is then what people
        call it.

    Raises:
      RecordingError: if there is no video in it, one of pictures that are
        too small or too large, or `fps` is missing or too much.
    """
    if fps is not None:
      checks.number('fps', fps, 0.01, 1000.0, RecordingError)
    files.check_text(str(path.absolute()), RecordingError)
    self._path = path
    self._source = source or _open(path, fps)
    self.width, self.height = self._source.width, self._source.height
    self.length_s = self._source.length_s
    self.note = ''
    self.name, self.live = str(path), isinstance(source, live_camera.LiveCamera)
    self._reached_s = -math.inf  # Time of the last picture, read or not.

  def __enter__(self) -> 'Recording':
    return self

  def __exit__(self, *_: object) -> None:
    self._source.close()

  def frames(self, part: RecordingPart) -> Iterator[tuple[np.ndarray, float]]:
    """Reads a part; call it once.

    Yields:
      Each picture, (H, W, 3) uint8 RGB with the anchor in its middle, and its
      time in seconds of the dance; times grow.

    Raises:
      RecordingError: if the part lies outside, is too long, or the recording
        is cut short or damaged or has no times.
    """
    rows, columns = part.crop(self.width, self.height)
    border = part.border(rows, columns)
    self._check_length(part)
    count = 0
    for time_s, picture in self._times(part):
      image = picture()
      if image.shape[:2] != (self.height, self.width):
        raise RecordingError(
          f'{self._path} changes the size of its picture at {time_s:.2f} s:'
          ' choose a part with --start and --end'
        )
      count += 1
      image = image[rows, columns]
      if any(border):
        image = cv2.copyMakeBorder(image, *border, cv2.BORDER_REPLICATE)
      yield np.ascontiguousarray(image), time_s * part.speed
    self._check_end(part, count)

  def offset_px(self, part: RecordingPart) -> np.ndarray:  # (2,)
    """What takes a place in a picture of `frames` to the whole picture."""
    rows, columns = part.crop(self.width, self.height)
    top, _, left, _ = part.border(rows, columns)
    return np.array([columns.start - left, rows.start - top], float)

  def _times(self, part: RecordingPart) -> Iterator[sources.Timed]:
    """The pictures of a part, those left out that are too near to another."""
    near_s = NEAR_S / part.speed
    last_s, stuck = -math.inf, 0
    for time_s, picture in self._source.pictures():
      stuck = 0 if time_s > self._reached_s else stuck + 1
      self._reached_s = max(self._reached_s, time_s)
      if part.end_s is not None and time_s > part.end_s + 1e-6:
        return
      if stuck > _MOST_STUCK:
        raise RecordingError(
          f'{self._path} is damaged at {time_s:.2f} s: {stuck} pictures there'
          ' have no time of their own'
        )
      check_length(self._path, time_s - part.start_s)
      if time_s >= max(last_s + near_s, part.start_s - 1e-6):
        last_s = time_s
        yield time_s, picture

  def _check_length(self, part: RecordingPart) -> None:
    """Refuses too long a part before an hour of it is read."""
    end_s = self.length_s if part.end_s is None else part.end_s
    check_length(self._path, end_s - part.start_s)

  def _check_end(self, part: RecordingPart, count: int) -> None:
    """Refuses a recording that ended too early; notes one that seems to."""
    self._source.check()
    reached_s, announced_s = self._reached_s, self.length_s
    if not count and reached_s < part.start_s:
      longest_s = np.fmax(reached_s, announced_s)
      raise RecordingError(
        f'`start` must lie in the recording, {longest_s:.2f} s long:'
        f' got {part.start_s:g}'
      )
    if count < 2:
      raise RecordingError(
        f'{self._path} gave {count} pictures with a time of their own from'
        f' {part.start_s:g} s on: it may be damaged, or no video; pictures'
        ' without times need --fps'
      )
    wanted_s = announced_s if part.end_s is None else part.end_s
    # Nothing is less than what is not announced.
    if not (
      reached_s < announced_s - _SLACK_S and reached_s < wanted_s - _SLACK_S
    ):
      return
    said = (
      f'{self._path} announces {announced_s:.2f} s, and its pictures end at'
      f' {reached_s:.2f} s'
    )
    if missing := self._source.missing():
      raise RecordingError(
        f'{said}: {missing}; decode what is left with'
        f' --end={math.floor(100 * reached_s) / 100:.2f}'
      )
    self.note = f'{said}.'


def check_length(path: pathlib.Path, length_s: float) -> None:
  """Refuses a part that is too long.

  Raises:
    RecordingError: naming the limit.
  """
  if length_s > MAX_LENGTH_S:  # Nothing is more than what is not announced.
    raise RecordingError(
      f'{path} must be at most {MAX_LENGTH_S:g} s long: got'
      f' {length_s:.0f} s; choose a part with --start and --end'
    )


def _open(path: pathlib.Path, fps: float | None) -> sources.Source:
  """Opens what can be decoded by the best that is installed."""
  if path.is_dir():
    return picture_folder.PictureFolder(path, fps)
  _check_file(path)
  if path.suffix.lower() == event_film.SUFFIX:
    return event_film.EventFilm(path, fps)
  try:
    from waggle_tasks.experiments.video import pyav_film
  except ImportError:
    return opencv_film.OpencvFilm(path, fps)
  return pyav_film.PyavFilm(path, fps)


def _check_file(path: pathlib.Path) -> None:
  """Refuses what is no readable file with something in it."""
  try:
    if not path.is_file():
      kind = 'no file' if path.exists() else 'not there'
      raise RecordingError(f'{path} must be a video file: it is {kind}')
    with path.open('rb') as file:
      if not file.read(1):
        raise RecordingError(f'{path} is empty')
  except OSError as error:
    raise RecordingError(f'{path} cannot be read: {error.strerror}') from None
