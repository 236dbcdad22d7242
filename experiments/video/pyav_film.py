"""A video read by PyAV, which decodes more kinds than OpenCV does."""

from collections.abc import Iterator
import fractions
import functools
import itertools
import math
import pathlib
from typing import Any

import av
import numpy as np
from packaging import version

from waggle_tasks.experiments.video import sources

if version.parse(av.__version__) < version.parse('17.1'):
  raise ImportError('PyAV before 17.1 crashes on Flash videos')

_SLACK_S = 1.0  # A container may announce so much more than it holds.
_MARGIN_S = 0.5  # What is given up before a damage.
_NO_TIMES = 0x80  # FFmpeg's flag of formats that hold pictures alone.
# Files only: a playlist must not reach into the network.
_OPTIONS = {'protocol_whitelist': 'file'}
_BOUND = {'max_pixels': str(sources.MAX_SIDE_PX**2)}
_ERRORS = (av.FFmpegError, OSError, ValueError)


class PyavFilm:
  """A `Source`: an open video."""

  def __init__(self, path: pathlib.Path, fps: float | None) -> None:
    """Opens a file and decodes its first picture.

    Args:
      path: The file.
      fps: Pictures a second of a stream without times; else None.

    Raises:
      RecordingError: if there is no video in it, its pictures are too small
        or too large, or `fps` is missing or too much.
    """
    self._path, self._fps = path, fps
    try:
      self._container = av.open(
        # From the root, so that no colon in it is taken for a protocol.
        str(path.absolute()),
        options=_OPTIONS,
        timeout=(sources.OPEN_S, sources.READ_S),
      )
    except _ERRORS as error:
      raise self._no_video() from error
    try:
      self._begin()
    except BaseException:
      self.close()
      raise

  def _begin(self) -> None:
    stream = self._container.streams.best('video')
    if not isinstance(stream, av.VideoStream):
      raise self._no_video()
    self._stream = stream
    # Seconds of one unit of its times.
    self._unit_s = stream.time_base or fractions.Fraction(1, av.time_base)
    codec = self._stream.codec_context
    # Before there is memory for one; some streams tell their size later.
    if codec.width and codec.height:
      sources.check_size(self._path, codec.width, codec.height)
    codec.options = _BOUND
    self._stream.thread_type = 'AUTO'
    self._check_fps()
    self._reformatter = av.video.reformatter.VideoReformatter()
    self._last_s, self._reach_s = -math.inf, -math.inf
    self.length_s = self._announced_s()
    self._timed = self._decode()
    first = next(self._timed, None)
    if first is None:
      raise self._no_video()
    self._first = first
    self.height, self.width, _ = self._first[1]().shape
    sources.check_size(self._path, self.width, self.height)

  def close(self) -> None:
    """Lets go of the file."""
    self._container.close()

  def pictures(self) -> Iterator[sources.Timed]:
    """See `Source`."""
    return itertools.chain([self._first], self._timed)

  def check(self) -> None:
    """See `Source`; whatever is wrong was said at once."""

  def missing(self) -> str:
    """See `Source`: other streams may be longer than the pictures."""
    announced = self._container.duration
    if announced is None:
      return ''
    # Matroska tells its end, others how long they are.
    starts = 'matroska' not in self._container.format.name
    origin = (self._container.start_time or 0) if starts else 0
    if self._reach_s >= (origin + announced) / av.time_base - _SLACK_S:
      return ''
    return 'it is cut short or damaged there'

  def _no_video(self) -> sources.RecordingError:
    return sources.RecordingError(
      f'{self._path} holds no video that can be read: it may be cut short or'
      ' damaged, hold only sound, or be something else'
    )

  def _check_fps(self) -> None:
    if self._container.format.flags & _NO_TIMES:
      if self._fps is None:
        raise sources.no_times(self._path)
    elif self._fps is not None:
      raise sources.RecordingError(
        f'`fps` is for pictures without times: those of {self._path} have'
        ' their own; --speed makes them faster or slower'
      )

  def _announced_s(self) -> float:
    """How long the pictures are said to last, else all of the file."""
    if self._stream.duration is not None:
      return float(self._stream.duration * self._unit_s)
    if self._container.duration is None:
      return math.nan
    start = max(self._container.start_time or 0, 0)
    in_all = self._container.duration
    if 'matroska' in self._container.format.name:
      in_all -= start
    return in_all / av.time_base

  def _decode(self) -> Iterator[sources.Timed]:
    """Pictures with their times since the first one."""
    first, rate_hz = None, self._fps or self._stream.average_rate
    for frame in self._frames():
      ticks = self._ticks(frame)
      if ticks is not None:
        first = ticks if first is None else first
        self._last_s = float((ticks - first) * self._unit_s)
      elif rate_hz:
        # The last ones of an AVI, or all of a stream without times.
        self._last_s = max(self._last_s + 1 / float(rate_hz), 0.0)
      else:
        continue
      yield self._last_s, functools.partial(self._image, frame)

  def _ticks(self, frame: av.VideoFrame) -> int | None:
    """When a picture is shown, in units of its stream; None when not known."""
    if self._fps is not None:
      return None
    # AVI counts pictures in the order in which they are decoded.
    if frame.pts is None or self._container.format.name == 'avi':
      return frame.dts
    return frame.pts

  def _frames(self) -> Iterator[av.VideoFrame]:
    """Whole pictures; what comes before the first one is no damage."""
    begun = False
    packets = self._packets()
    for packet in itertools.chain(packets, [None]):
      try:
        frames = self._stream.codec_context.decode(packet)
      except av.error.EOFError:
        return
      except _ERRORS as error:
        if begun:
          raise self._damaged() from error
        continue
      for frame in frames:
        if frame.is_corrupt and begun:
          raise self._damaged()
        if not frame.is_corrupt:
          begun = True
          yield frame

  def _packets(self) -> Iterator[av.Packet]:
    """Packets of the video; notes how far any stream reaches."""
    try:
      for packet in self._container.demux():
        if packet.size == 0:  # Nothing new, or the end of a stream.
          continue
        if packet.pts is not None:
          end = packet.pts + (packet.duration or 0)
          self._reach_s = max(self._reach_s, float(end * packet.time_base))
        if packet.stream is self._stream:
          yield packet
    except _ERRORS as error:
      raise self._damaged() from error

  def _damaged(self) -> sources.RecordingError:
    if self._last_s <= 0:
      return self._no_video()
    # Reading ends with the first picture after the end, so one must be left.
    end_s = max(self._last_s - _MARGIN_S, self._last_s / 2)
    return sources.RecordingError(
      f'{self._path} is cut short or damaged at {self._last_s:.2f} s; decode'
      f' what is before with --end={end_s:.2f}'
    )

  def _image(self, frame: av.VideoFrame) -> np.ndarray:
    """The picture as it is shown."""
    shown = self._reformatter.reformat(frame, format='rgb24', threads=1)
    image = shown.to_ndarray()
    aspect = self._stream.sample_aspect_ratio
    image = sources.widened(image, sources.shown_width(frame.width, aspect))
    matrix: Any = frame.side_data.get('DISPLAYMATRIX')
    return image if matrix is None else _upright(image, bytes(matrix))


def _upright(image: np.ndarray, matrix: bytes) -> np.ndarray:
  """Turns and mirrors a picture by quarters, as a container asks.

  Args:
    image: (H, W, 3).
    matrix: Nine integers of 32 bits; x becomes a x + c y, y becomes b x + d y.
  """
  a, b, _, c, d = np.frombuffer(matrix, np.int32)[:5]
  across, down = a, d
  if abs(b) > abs(a):
    image, across, down = image.transpose(1, 0, 2), c, b
  image = image[:: -1 if down < 0 else 1, :: -1 if across < 0 else 1]
  return np.ascontiguousarray(image)
