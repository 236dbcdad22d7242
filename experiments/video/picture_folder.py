"""A folder of numbered pictures, read as a recording."""

from collections.abc import Iterator
import functools
import pathlib
import re

import cv2
import numpy as np

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.video import sources

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
  """A `Source`: pictures by the numbers in their names."""

  def __init__(self, folder: pathlib.Path, fps: float | None) -> None:
    """Lists a folder and reads its first picture.

    Args:
      folder: Holds the pictures; a number that is left out is one not taken.
      fps: How many numbers are a second.

    Raises:
      RecordingError: if `fps` is missing, a name has no number or the number
        of another, or pictures are too small or too large.
    """
    if fps is None:
      raise sources.no_times(folder)
    self._fps = fps
    self._paths = _numbered(folder)
    self._numbers = sorted(self._paths)
    first = _read(self._paths[self._numbers[0]])
    self.height, self.width, _ = first.shape
    sources.check_size(folder, self.width, self.height)
    self.length_s = (self._numbers[-1] - self._numbers[0] + 1) / fps

  def close(self) -> None:
    """See `Source`; nothing is open."""

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`."""
    for number in self._numbers:
      time_s = (number - self._numbers[0]) / self._fps
      yield time_s, functools.partial(_read, self._paths[number])

  def check(self) -> None:
    """See `Source`; whatever is wrong was said at once."""

  def missing(self) -> str:
    """See `Source`: a folder ends where it ends."""
    return ''


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
