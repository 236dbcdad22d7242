"""A folder of pictures, read as a recording."""

from collections.abc import Iterator
import functools
import itertools
import pathlib
import re

import cv2
import numpy as np

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.video import picture_times, sources

_ENDINGS = ('.png', '.jpg', '.jpeg')
_RUN = 'config.json'  # What a run folder holds, whatever else is in it.
_NUMBER = re.compile(r'(\d+)\D*$')  # The last one in a name.


def found(folder: pathlib.Path) -> list[pathlib.Path]:
  """The pictures of a folder, in no order; those of a run are none."""
  if (folder / _RUN).exists():
    return []
  return [
    path
    for path in folder.iterdir()
    if path.suffix.lower() in _ENDINGS and not path.name.startswith('.')
  ]


class PictureFolder:
  """A `Source`: pictures by their times, or the numbers in their names."""

  def __init__(self, folder: pathlib.Path, fps: float | None) -> None:
    """Lists a folder and reads its first picture.

    Args:
      folder: Holds the pictures, and maybe their times, see `picture_times`;
        else a number that is left out is one not taken.
      fps: How many numbers are a second, where there are no times.

    Raises:
      RecordingError: if there are neither times nor `fps`, or both; if a
        picture has no time, or no number, of its own; or if pictures are too
        small or too large.
    """
    times_s = picture_times.read(folder)
    if (fps is None) == (times_s is None):
      if fps is None:
        raise sources.no_times(folder)
      raise sources.RecordingError(
        f'`fps` must not be given beside {picture_times.NAME} of {folder}'
      )
    if times_s is not None:
      self._timed = _timed(folder, times_s)
    elif fps is not None:
      paths = _numbered(folder)
      numbers = sorted(paths)
      self._timed = [((n - numbers[0]) / fps, paths[n]) for n in numbers]
    last_s = self._timed[-1][0]
    step_s = last_s / max(len(self._timed) - 1, 1) if fps is None else 1 / fps
    self.length_s = last_s + step_s
    self.height, self.width, _ = _read(self._timed[0][1]).shape
    sources.check_size(folder, self.width, self.height)

  def close(self) -> None:
    """See `Source`; nothing is open."""

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`."""
    for time_s, path in self._timed:
      yield time_s, functools.partial(_read, path)

  def check(self) -> None:
    """See `Source`; whatever is wrong was said at once."""

  def missing(self) -> str:
    """See `Source`: a folder ends where it ends."""
    return ''


def _timed(
  folder: pathlib.Path, times_s: dict[str, float]
) -> list[tuple[float, pathlib.Path]]:
  """The pictures of a folder by their times, the first of which is 0."""
  names = {path.name for path in found(folder)}
  for some, others, lack in (
    (names, times_s.keys(), f'a time in {picture_times.NAME}'),
    (times_s.keys(), names, 'a picture'),
  ):
    if missing := sorted(some - others):
      raise sources.RecordingError(
        f'every picture of {folder} must have its time, and every time its'
        f' picture: {missing[0]} has not {lack}'
      )
  rows = sorted((time_s, folder / name) for name, time_s in times_s.items())
  for (before_s, before), (time_s, path) in itertools.pairwise(rows):
    if time_s <= before_s:
      raise sources.RecordingError(
        f'pictures must have times of their own: got {before.name} and'
        f' {path.name} at {time_s:g} s in {folder}'
      )
  return [(time_s - rows[0][0], path) for time_s, path in rows]


def _numbered(folder: pathlib.Path) -> dict[int, pathlib.Path]:
  """The pictures of a folder by the number in their names."""
  paths: dict[int, pathlib.Path] = {}
  for path in sorted(found(folder)):
    match = _NUMBER.search(path.stem)
    if match is None:
      raise sources.RecordingError(
        f'pictures must have a number in their names: {path} has none'
      )
    other = paths.setdefault(int(match[1]), path)
    if other is not path:
      raise sources.RecordingError(
        'pictures must have numbers of their own: got'
        f' {other.name} and {path.name} in {folder}'
      )
  return paths


def _read(path: pathlib.Path) -> np.ndarray:
  files.check_text(str(path.absolute()), sources.RecordingError)
  image = cv2.imread(str(path.absolute()), cv2.IMREAD_COLOR_RGB)
  if image is None:
    raise sources.RecordingError(
      f'{path} holds no picture that can be read: it may be cut short or'
      ' damaged'
    )
  return image
