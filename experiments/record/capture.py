"""Raw captures: exactly what a receiver got, lossless and small.

A capture is one file for each observer. While a camera stands still almost
nothing of its image changes, so every image is kept as the window in which it
differs from the one before, compressed by zlib; the first is kept whole.

  'waggle capture 1', a line feed
  for each image: time in s, then left, top, width and height of the window in
    pixels, then the length of its data: '<dHHHHI', and the data
  the same with time NaN and the number of images for the length, and the
    CRC-32 of everything before it: '<I'
"""

from collections.abc import Iterator
import math
import pathlib
import struct
from typing import BinaryIO
import zlib

import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments.record import episode
from waggle_tasks.protocol import camera

FOLDER = 'raw'
SUFFIX = '.capture'
_FORMAT = 1
_NAME = b'waggle capture '
_MAGIC = b'%b%d\n' % (_NAME, _FORMAT)
_RECORD = struct.Struct('<dHHHHI')
_CRC = struct.Struct('<I')
_COLOURS = 3
_WORD = 8  # Bytes that are compared at a time, where rows are whole words.


class CaptureError(errors.WaggleError):
  """A capture that is damaged, cut short or something else."""


class Writer:
  """Writes one observer's images; a context manager.

  Attributes:
    last_s: Time of the last image.
  """

  def __init__(self, path: pathlib.Path) -> None:
    """Begins a file."""
    self._file = path.open('wb')
    self._crc = 0
    self._images = 0
    self._last: np.ndarray | None = None
    self.last_s = -math.inf
    self._put(_MAGIC)

  def __enter__(self) -> 'Writer':
    return self

  def __exit__(self, kind: object, error: object, trace: object) -> None:
    if error is None:
      self._put(_RECORD.pack(math.nan, 0, 0, 0, 0, self._images))
      self._put(_CRC.pack(self._crc))
    self._file.close()

  def write(self, image: np.ndarray, time_s: float) -> None:
    """Adds an image.

    Args:
      image: (H, W, 3) uint8 RGB, as large as those before.
      time_s: Its time.
    """
    if self._last is None:
      left, top, right, bottom = 0, 0, image.shape[1], image.shape[0]
      self._last = np.empty_like(image)
    else:
      left, top, right, bottom = _changed(self._last, image)
    window = image[top:bottom, left:right]
    self._last[top:bottom, left:right] = window
    data = zlib.compress(window.tobytes()) if window.size else b''
    self._put(
      _RECORD.pack(time_s, left, top, right - left, bottom - top, len(data))
    )
    self._put(data)
    self._images += 1
    self.last_s = time_s

  def _put(self, data: bytes) -> None:
    self._crc = zlib.crc32(data, self._crc)
    self._file.write(data)


def _changed(
  before: np.ndarray, after: np.ndarray
) -> tuple[int, int, int, int]:
  """The window in which two images differ: left, top, right, bottom."""
  height, width, _ = before.shape
  size = 1 if width * _COLOURS % _WORD else _WORD
  rows_of_words, word = (height, -1), np.dtype(f'u{size}')
  differs = before.reshape(rows_of_words).view(word) != (
    np.ascontiguousarray(after).reshape(rows_of_words).view(word)
  )
  rows = np.flatnonzero(differs.any(axis=1))
  if not rows.size:
    return 0, 0, 0, 0
  words = np.flatnonzero(differs.any(axis=0))
  left = int(words[0]) * size // _COLOURS
  right = -(-(int(words[-1]) + 1) * size // _COLOURS)
  return left, int(rows[0]), right, int(rows[-1]) + 1


def read(path: pathlib.Path) -> Iterator[tuple[np.ndarray, float]]:
  """Reads a capture, one image at a time.

  Yields:
    Each image, (H, W, 3) uint8 RGB, in a buffer that the next one overwrites,
    and its time in s.

  Raises:
    CaptureError: as soon as the file turns out to be damaged.
  """
  try:
    with path.open('rb') as file:
      yield from _images(file, path)
  except OSError as error:
    raise CaptureError(f'{path} cannot be read: {error.strerror}') from None


def _images(
  file: BinaryIO, path: pathlib.Path
) -> Iterator[tuple[np.ndarray, float]]:
  _check(file.readline(len(_MAGIC) + _CRC.size), path)
  image: np.ndarray | None = None
  count, crc = 0, zlib.crc32(_MAGIC)
  while True:
    record = file.read(_RECORD.size)
    if len(record) < _RECORD.size:
      raise CaptureError(f'{path} is cut short after {count} images')
    time_s, left, top, width, height, length = _RECORD.unpack(record)
    crc = zlib.crc32(record, crc)
    if math.isnan(time_s):
      if length != count or file.read() != _CRC.pack(crc):
        raise CaptureError(
          f'{path} is damaged or cut short: its check sum is wrong'
        )
      return
    if image is None:  # Its window is the whole of it.
      image = _blank(width, height)
    fits = left + width <= image.shape[1] and top + height <= image.shape[0]
    # No image's data is longer.
    data = file.read(length) if fits and length < 2 * image.size else b''
    crc = zlib.crc32(data, crc)
    window = _window(data, (height, width, _COLOURS))
    if len(data) != length or window is None or not image.size:
      raise CaptureError(f'{path} is damaged or cut short at image {count + 1}')
    image[top : top + height, left : left + width] = window
    count += 1
    yield image, time_s


def _blank(width: int, height: int) -> np.ndarray:
  """What windows are put into; nothing fits where no camera has the size."""
  sides = width, height
  if min(sides) < camera.MIN_SIDE_PX or max(sides) > camera.MAX_SIDE_PX:
    return np.zeros((0, 0, _COLOURS), np.uint8)
  return np.zeros((height, width, _COLOURS), np.uint8)


def _check(magic: bytes, path: pathlib.Path) -> None:
  """Refuses what is no capture, or one of another format."""
  if magic == _MAGIC:
    return
  number = magic.removeprefix(_NAME).removesuffix(b'\n')
  if magic.startswith(_NAME) and number.isdigit():
    raise CaptureError(
      f'`format` of {path} must be {_FORMAT} for this program: got'
      f' {int(number)}, which a newer one wrote; update waggle-tasks to read it'
    )
  raise CaptureError(f'{path} is not a capture: it begins otherwise')


def _window(data: bytes, shape: tuple[int, int, int]) -> np.ndarray | None:
  """The pixels of a window; None when the data is not that of one."""
  size = math.prod(shape)
  if not size:
    return np.empty(shape, np.uint8) if not data else None
  try:
    unpacked = zlib.decompressobj().decompress(data, size)
  except zlib.error:
    return None
  if len(unpacked) != size:
    return None
  return np.frombuffer(unpacked, np.uint8).reshape(shape)


class Recorder:
  """An onlooker that captures every image that a receiver takes."""

  def __init__(self, folder: pathlib.Path) -> None:
    """Makes the recorder, a context manager.

    Args:
      folder: The run folder; captures go into its folder 'raw'.
    """
    self._folder = folder / FOLDER
    self._writers: list[Writer] = []

  def __enter__(self) -> 'Recorder':
    return self

  def __exit__(self, kind: object, error: object, trace: object) -> None:
    for writer in self._writers:
      writer.__exit__(kind, error, trace)

  def __call__(self, step: episode.Step) -> None:
    """Captures the images of this frame."""
    if step.timestep.first():
      self._folder.mkdir()
      for each in step.environment.task.observers:
        name = each.mjcf_model.model + SUFFIX
        self._writers.append(Writer(self._folder / name))
    for writer, observation, agent in zip(
      self._writers, step.timestep.observation, step.team.agents, strict=True
    ):
      time_s = float(observation['time_s'])
      # Navigating, it reads none; an image that comes again, it passes over.
      if agent.read_s == time_s and writer.last_s < time_s:
        writer.write(observation['camera'], time_s)


def paths(folder: pathlib.Path) -> list[pathlib.Path]:
  """The captures of a run folder, in the order of its observers.

  Raises:
    CaptureError: if there are none.
  """
  found = sorted(
    (folder / FOLDER).glob(f'*{SUFFIX}'),
    key=lambda path: int(path.stem.rpartition('_')[2]),
  )
  if not found:
    raise CaptureError(
      f'{folder} holds no captures: run `waggle broadcast --raw` to make some'
    )
  return found
