"""Reads any video by the timestamps of its container, within bounds.

A broken, endless or hostile file costs a bounded time and memory and gives
one clear error.
"""

from collections.abc import Iterator
import dataclasses
import math
import os
import pathlib

import cv2
import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments import quiet
from waggle_tasks.protocol import checks

MAX_SIDE_PX = 4096
MAX_LENGTH_S = 3600.0
_OPEN_MS, _READ_MS = 10_000, 10_000
_SLACK_S = 1.0  # A container may announce so much more than it holds.
# Files only: a playlist must not reach into the network.
_OPTIONS = f'protocol_whitelist;file|max_pixels;{MAX_SIDE_PX**2}'


class RecordingError(errors.WaggleError):
  """A file that is no readable video, or a part of it that does not exist."""


@dataclasses.dataclass(frozen=True)
class Part:
  """Which part of a recording is read.

  Attributes:
    start_s: First moment, by the recording's own time.
    end_s: Last moment, or None for all there is.
    roi: Left, top, width and height of the part of the picture, in pixels;
      None for all of it.
    anchor_px: Where the target hovers first, x right and y down in the whole
      picture; None for the middle of the part.
    speed: Seconds of the dance in a second of the recording.
  """

  start_s: float = 0.0
  end_s: float | None = None
  roi: tuple[int, int, int, int] | None = None
  anchor_px: tuple[float, float] | None = None
  speed: float = 1.0

  def __post_init__(self) -> None:
    checks.number('start', self.start_s, 0.0, 1e6, RecordingError)
    checks.number('speed', self.speed, 0.01, 100.0, RecordingError)
    if self.end_s is not None:
      checks.number('end', self.end_s, 0.0, 1e6, RecordingError)
      if self.end_s <= self.start_s:
        raise RecordingError(
          f'`end` must be later than `start`, {self.start_s:g} s:'
          f' got {self.end_s:g} s'
        )
    if self.roi is not None and not (
      min(self.roi[:2]) >= 0 and min(self.roi[2:]) >= 16
    ):
      raise RecordingError(
        '`roi` must be left, top, width, height in pixels, at least 16 wide'
        f' and high: got {",".join(map(str, self.roi))}'
      )


class Recording:
  """An open video file; a context manager.

  Attributes:
    width: Of its picture in pixels.
    height: The same.
    length_s: What its container announces; NaN when it does not.
  """

  def __init__(self, path: pathlib.Path) -> None:
    """Opens a file.

    Raises:
      RecordingError: if there is no video in it, or too large a one.
    """
    self._path = path
    _check_file(path)
    # Read by OpenCV's FFmpeg each time that it opens a file.
    os.environ['OPENCV_FFMPEG_CAPTURE_OPTIONS'] = _OPTIONS
    limits = [
      cv2.CAP_PROP_OPEN_TIMEOUT_MSEC,
      _OPEN_MS,
      cv2.CAP_PROP_READ_TIMEOUT_MSEC,
      _READ_MS,
    ]
    with quiet.quiet():  # OpenCV says of a refused file what helps nobody.
      self._capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG, limits)
    if not self._capture.isOpened():
      raise RecordingError(
        f'{path} holds no video that can be read: it may be cut short or'
        ' damaged, hold only sound, or be something else'
      )
    get = self._capture.get
    self.width = int(get(cv2.CAP_PROP_FRAME_WIDTH))
    self.height = int(get(cv2.CAP_PROP_FRAME_HEIGHT))
    count, rate_hz = get(cv2.CAP_PROP_FRAME_COUNT), get(cv2.CAP_PROP_FPS)
    known = count > 0 and rate_hz > 0
    self.length_s = count / rate_hz if known else math.nan
    if not 0 < max(self.width, self.height) <= MAX_SIDE_PX:
      raise RecordingError(
        f'{path} must be at most {MAX_SIDE_PX} pixels wide and high:'
        f' got {self.width} x {self.height}'
      )

  def __enter__(self) -> 'Recording':
    return self

  def __exit__(self, *_: object) -> None:
    self._capture.release()

  def frames(self, part: Part) -> Iterator[tuple[np.ndarray, float]]:
    """Reads a part.

    Yields:
      Each picture, (H, W, 3) uint8 RGB with the anchor in its middle, and its
      time in seconds of the dance; times grow.

    Raises:
      RecordingError: if the part lies outside, is too long, or the file ends
        before its time or has no times.
    """
    rows, columns = self._crop(part)
    end_s = self._end_s(part)
    border = self._border(part)
    count, last_s = 0, -math.inf
    while self._capture.grab():
      time_s = self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1e3
      if time_s > end_s + 1e-6:
        last_s = time_s
        break
      if time_s <= last_s or time_s < part.start_s - 1e-6:
        continue  # Repeated, out of order, or not asked for.
      found, image = self._capture.retrieve()
      if not found:
        break
      count, last_s = count + 1, time_s
      image = cv2.cvtColor(image[rows, columns], cv2.COLOR_BGR2RGB)
      if any(border):
        image = cv2.copyMakeBorder(image, *border, cv2.BORDER_REPLICATE)
      yield image, time_s * part.speed
    self._check_end(part, count, last_s)

  def offset_px(self, part: Part) -> np.ndarray:  # (2,)
    """What takes a place in a picture of `frames` to the whole picture."""
    rows, columns = self._crop(part)
    top, _, left, _ = self._border(part)
    return np.array([columns.start - left, rows.start - top], float)

  def _crop(self, part: Part) -> tuple[slice, slice]:
    if part.roi is None:
      return slice(0, self.height), slice(0, self.width)
    left, top, width, height = part.roi
    if left + width > self.width or top + height > self.height:
      raise RecordingError(
        f'`roi` must lie in the picture, {self.width} x {self.height}:'
        f' got {",".join(map(str, part.roi))}'
      )
    return slice(top, top + height), slice(left, left + width)

  def _border(self, part: Part) -> tuple[int, int, int, int]:
    """What to add at the top, bottom, left and right to centre the anchor."""
    if part.anchor_px is None:
      return 0, 0, 0, 0
    rows, columns = self._crop(part)
    x, y = part.anchor_px
    if not (columns.start <= x < columns.stop and rows.start <= y < rows.stop):
      raise RecordingError(
        f'`anchor` must lie in the part that is read: got {x:g},{y:g}'
      )
    right = round(2 * (x - columns.start) - (columns.stop - columns.start))
    bottom = round(2 * (y - rows.start) - (rows.stop - rows.start))
    return max(-bottom, 0), max(bottom, 0), max(-right, 0), max(right, 0)

  def _end_s(self, part: Part) -> float:
    """When to stop, at most `MAX_LENGTH_S` after the start."""
    end_s = self.length_s if part.end_s is None else part.end_s
    if math.isnan(end_s):
      return part.start_s + MAX_LENGTH_S
    if part.start_s > self.length_s:
      raise RecordingError(
        f'`start` must lie in the recording, {self.length_s:.2f} s long:'
        f' got {part.start_s:g}'
      )
    if end_s - part.start_s > MAX_LENGTH_S:
      raise RecordingError(
        f'{self._path} must be at most {MAX_LENGTH_S:g} s long: got'
        f' {end_s - part.start_s:.0f} s; choose a part with --start and --end'
      )
    return math.inf if part.end_s is None else end_s

  def _check_end(self, part: Part, count: int, last_s: float) -> None:
    """Refuses a recording that ended too early."""
    if count < 2:
      raise RecordingError(
        f'{self._path} gave {count} pictures with a time of their own from'
        f' {part.start_s:g} s on: it may be damaged, or no video'
      )
    wanted_s = self.length_s if part.end_s is None else part.end_s
    wanted_s = min(wanted_s, self.length_s)
    if last_s < wanted_s - _SLACK_S:
      raise RecordingError(
        f'{self._path} ends at {last_s:.2f} s of {self.length_s:.2f} s: it is'
        ' cut short or damaged there; decode what is left with'
        f' --end={math.floor(100 * last_s) / 100:.2f}'
      )


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
