"""A video read by OpenCV, for those who have not got PyAV."""

from collections.abc import Iterator
import fractions
import math
import os
import pathlib

import cv2
import numpy as np

from waggle_tasks.experiments.machine import quiet
from waggle_tasks.experiments.video import sources

# Files only: a playlist must not reach into the network.
_OPTIONS = f'protocol_whitelist;file|max_pixels;{sources.MAX_SIDE_PX**2}'


class OpencvFilm:
  """A `Source`: an open video."""

  def __init__(self, path: pathlib.Path, fps: float | None) -> None:
    """Opens a file.

    Args:
      path: The file.
      fps: Pictures a second, for a stream without times; else None.

    Raises:
      RecordingError: if there is no video in it, or its pictures are too
        small or too large.
    """
    self._path, self._fps = path, fps
    # Read by OpenCV's FFmpeg each time that it opens a file.
    os.environ['OPENCV_FFMPEG_CAPTURE_OPTIONS'] = _OPTIONS
    limits = [
      cv2.CAP_PROP_OPEN_TIMEOUT_MSEC,
      1000 * sources.OPEN_S,
      cv2.CAP_PROP_READ_TIMEOUT_MSEC,
      1000 * sources.READ_S,
    ]
    with quiet.quiet():  # OpenCV says of a refused file what helps nobody.
      self._capture = cv2.VideoCapture(
        # From the root, so that no colon in it is taken for a protocol.
        str(path.absolute()), cv2.CAP_FFMPEG, limits
      )  # fmt: skip
    if not self._capture.isOpened():
      raise sources.RecordingError(
        f'{path} holds no video that can be read: it may be cut short or'
        ' damaged, hold only sound, or be something else'
      )
    get = self._capture.get
    stored = int(get(cv2.CAP_PROP_FRAME_WIDTH))
    self.height = int(get(cv2.CAP_PROP_FRAME_HEIGHT))
    sources.check_size(path, stored, self.height)
    self.width = sources.shown_width(stored, self._aspect())
    sources.check_size(path, self.width, self.height)
    count, rate_hz = get(cv2.CAP_PROP_FRAME_COUNT), get(cv2.CAP_PROP_FPS)
    known = count > 0 and rate_hz > 0
    self.length_s = count / rate_hz if known and fps is None else math.nan
    self._count, self._timed = 0, False
    self._first: np.ndarray | None = None  # The first picture that was asked.
    self._differs = False  # Whether another one is unlike it.

  def close(self) -> None:
    """Lets go of the file."""
    self._capture.release()

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`."""
    first_s = None
    while self._capture.grab():
      time_s = self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1e3
      if self._fps is not None:
        time_s = self._count / self._fps
      first_s = time_s if first_s is None else first_s
      time_s -= first_s
      self._timed = self._timed or time_s > 0
      self._count += 1
      yield time_s, self._image

  def check(self) -> None:
    """See `Source`."""
    if not self._count:
      raise sources.RecordingError(
        f'{self._path} gives no picture: it is damaged, or of a kind that'
        f' OpenCV cannot decode, which {sources.EXTRA} mends'
      )
    if self._count > 1 and not self._timed:
      raise sources.no_times(self._path)
    if self._first is not None and not self._differs:
      # OpenCV gives left-over memory, again and again, for such a picture.
      raise sources.RecordingError(
        f'{self._path} gives one picture and no other: nothing happens in it,'
        f' or it is interlaced, which {sources.EXTRA} mends'
      )

  def missing(self) -> str:
    """See `Source`: OpenCV tells neither damage nor longer sound."""
    return (
      'it is cut short or damaged there, or its sound is longer than its'
      f' pictures, which {sources.EXTRA} would tell'
    )

  def _aspect(self) -> fractions.Fraction | None:
    """Width of a shown pixel over its height."""
    get = self._capture.get
    across, down = get(cv2.CAP_PROP_SAR_NUM), get(cv2.CAP_PROP_SAR_DEN)
    if across < 1 or down < 1:
      return None
    aspect = fractions.Fraction(int(across), int(down))
    # OpenCV turns the picture and not the pixel.
    lies = get(cv2.CAP_PROP_ORIENTATION_META) % 180 != 0
    return 1 / aspect if lies else aspect

  def _image(self) -> np.ndarray:
    found, image = self._capture.retrieve()
    if not found:
      raise sources.RecordingError(
        f'{self._path} is damaged: it has a picture that cannot be decoded'
      )
    if self._first is None:
      self._first = image.copy()
    elif not self._differs:
      self._differs = not np.array_equal(image, self._first)
    image = cv2.cvtColor(image, cv2.COLOR_BGR2RGB)
    return sources.widened(image, self.width)
