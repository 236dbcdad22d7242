"""Video files: VP8 in .webm through OpenCV, H.264 in .mp4 through PyAV."""

from collections.abc import Callable
import fractions
import pathlib
import queue
import threading
from typing import Protocol

import cv2
import numpy as np

from waggle_tasks.experiments.machine import files, quiet
from waggle_tasks.experiments.video import layout

_QUEUE = 8  # Pictures that may wait: more would only fill the memory.
_CRF = 20  # H.264's quality, 0 best to 51; libx264's default is 23.


class Encoder(Protocol):
  """Writes pictures of one size at a constant rate."""

  def write(self, picture: np.ndarray) -> None:
    """Adds a picture, (H, W, 3) uint8 RGB."""
    ...

  def close(self) -> None:
    """Completes the file."""
    ...


def _plain(path: pathlib.Path) -> str:
  """A name from the root: no colon in it is taken for a protocol."""
  return str(path.absolute())


class _Webm:
  """VP8, the one codec of OpenCV's wheel that browsers play."""

  def __init__(
    self, path: pathlib.Path, size: tuple[int, int], fps: float
  ) -> None:
    self._path = path
    self._pictures = 0
    fourcc = cv2.VideoWriter.fourcc(*'VP80')
    with quiet.quiet():  # OpenCV grumbles at a tag that it then replaces.
      self._writer = cv2.VideoWriter(
        _plain(path), cv2.CAP_FFMPEG, fourcc, fps, size
      )
    if not self._writer.isOpened():
      raise layout.VideoError(
        f'{path.name} cannot be written: OpenCV refuses VP8 (VP80) for'
        f' {size[0]} x {size[1]} at {fps:g} Hz here'
      )

  def write(self, picture: np.ndarray) -> None:
    self._writer.write(cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
    self._pictures += 1

  def close(self) -> None:
    self._writer.release()
    # OpenCV tells nobody when the disk is full: the length is written last.
    with quiet.quiet():
      check = cv2.VideoCapture(_plain(self._path), cv2.CAP_FFMPEG)
    length = check.get(cv2.CAP_PROP_FRAME_COUNT)
    complete = check.grab() and length >= self._pictures - 1
    check.release()
    if not complete:
      raise layout.VideoError(f'{self._path.name} could not be written')


class _Mp4:
  """H.264, for those who have PyAV."""

  def __init__(
    self, path: pathlib.Path, size: tuple[int, int], fps: float
  ) -> None:
    try:
      import av  # The extra [video].
    except ImportError:
      raise layout.VideoError(
        f"{path.name} needs PyAV: pip install 'waggle-tasks[video]', or choose"
        ' a name that ends in .webm'
      ) from None
    self._av = av
    rate = fractions.Fraction(fps).limit_denominator(1000)
    try:
      self._container = av.open(_plain(path), 'w')
      self._stream = self._container.add_stream('libx264', rate=rate)
    except (av.FFmpegError, ValueError) as error:
      raise layout.VideoError(
        f'{path.name} cannot be written: PyAV refuses H.264: {error}'
      ) from None
    self._stream.width, self._stream.height = size
    self._stream.pix_fmt = 'yuv420p'
    self._stream.options = {'crf': str(_CRF), 'preset': 'veryfast'}

  def write(self, picture: np.ndarray) -> None:
    frame = self._av.VideoFrame.from_ndarray(picture, format='rgb24')
    self._container.mux(self._stream.encode(frame))

  def close(self) -> None:
    self._container.mux(self._stream.encode())
    self._container.close()


ENCODERS: dict[str, Callable[..., Encoder]] = {'.webm': _Webm, '.mp4': _Mp4}


def check_name(name: str) -> None:
  """Refuses a file name that chooses no codec.

  Raises:
    VideoError: naming the endings that do.
  """
  path = pathlib.PurePath(name)
  if path.suffix not in ENCODERS or path.name != name:
    raise layout.VideoError(
      f'`video_file` must be a file name that ends in one of {[*ENCODERS]}:'
      f' got {name!r}'
    )


def make(path: pathlib.Path, size: tuple[int, int], fps: float) -> Encoder:
  """Opens a video file for writing.

  Args:
    path: Its ending chooses the codec, one of `ENCODERS`.
    size: Width and height, even numbers.
    fps: Pictures a second.

  Raises:
    VideoError: if the codec is refused or not installed.
  """
  check_name(path.name)
  files.check_text(str(path.absolute()), layout.VideoError)
  return ENCODERS[path.suffix](path, size, fps)


class Worker:
  """Draws and encodes beside the simulation, in one thread of its own."""

  def __init__(self, encoder: Encoder) -> None:
    """Starts the thread; `close` it.

    Args:
      encoder: Where pictures go, and which is closed with this.
    """
    self._encoder = encoder
    self._jobs: queue.Queue = queue.Queue(_QUEUE)
    self._error: Exception | None = None
    self._thread = threading.Thread(target=self._work, daemon=True)
    self._thread.start()

  def put(self, draw: Callable[[], np.ndarray]) -> None:
    """Queues a picture; waits when too many are waiting already.

    Args:
      draw: Returns the picture, (H, W, 3) uint8 RGB; called in the thread.

    Raises:
      Exception: whatever drawing or encoding an earlier picture raised.
    """
    if self._error is not None:
      raise self._error
    self._jobs.put(draw)

  def close(self) -> None:
    """Waits until every picture is written, and completes the file.

    Raises:
      Exception: whatever drawing or encoding raised.
    """
    self._jobs.put(None)
    self._thread.join()
    if self._error is not None:
      raise self._error

  def _work(self) -> None:
    while (draw := self._jobs.get()) is not None:
      if self._error is None:
        try:
          self._encoder.write(draw())
        except Exception as error:
          self._error = error
    try:
      self._encoder.close()
    except Exception as error:
      self._error = self._error or error
