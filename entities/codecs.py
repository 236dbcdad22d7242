"""How pictures are coded on the way from a camera, and decoded again."""

from typing import Any, Protocol

import cv2
import numpy as np

from waggle_tasks import eyes
from waggle_tasks.protocol import camera as camera_lib

_H264 = {'preset': 'ultrafast', 'tune': 'zerolatency', 'threads': '1'}


class Codec(Protocol):
  """A way that a camera's pictures come."""

  def picture(self, picture: np.ndarray) -> np.ndarray:
    """What comes of a picture, (H, W, 3) uint8 RGB each."""
    ...


class Jpeg:
  """Each picture by itself, by OpenCV."""

  def __init__(self, quality: int) -> None:
    """Makes it for a quality, 1 to 100."""
    self._how = [cv2.IMWRITE_JPEG_QUALITY, quality]

  def picture(self, picture: np.ndarray) -> np.ndarray:
    """See `Codec`."""
    swapped = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
    _, data = cv2.imencode('.jpg', swapped, self._how)
    return cv2.cvtColor(cv2.imdecode(data, cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)


class H264:
  """One stream by x264, without delay, by PyAV.

  A new one begins with each episode; it is on one thread, and so the same
  whenever its pictures are.
  """

  def __init__(self, crf: int, camera: camera_lib.Camera) -> None:
    """Opens both ends.

    Args:
      crf: The rate factor, 0 to 51.
      camera: Whose pictures come; both sides must be even.

    Raises:
      EyeError: if PyAV is not installed, or a side is odd.
    """
    av = _av()
    odd = [side for side in camera.size if side % 2]
    if odd:
      raise eyes.EyeError(
        f"`codec` 'h264' takes an even width and height: got {camera.columns} x"
        f' {camera.rows}'
      )
    self._frame = av.VideoFrame
    self._encoder = av.CodecContext.create('libx264', 'w')
    self._encoder.width, self._encoder.height = camera.size
    self._encoder.pix_fmt, self._encoder.framerate = 'yuv420p', 25
    self._encoder.options = {**_H264, 'crf': str(crf)}
    self._decoder = av.CodecContext.create('h264', 'r')
    self._decoder.thread_count = 1
    self._decoder.options = {'flags': 'low_delay'}
    self._count = 0
    self._last: np.ndarray | None = None

  def picture(self, picture: np.ndarray) -> np.ndarray:
    """See `Codec`."""
    planes = cv2.cvtColor(picture, cv2.COLOR_RGB2YUV_I420)
    frame = self._frame.from_ndarray(planes, format='yuv420p')
    frame.pts, self._count = self._count, self._count + 1
    for packet in self._encoder.encode(frame):
      for each in self._decoder.decode(packet):
        self._last = cv2.cvtColor(each.to_ndarray(), cv2.COLOR_YUV2RGB_I420)
    return picture if self._last is None else self._last


def make(eye: eyes.Eye, camera: camera_lib.Camera) -> Codec | None:
  """The codec of an eye, at the beginning of an episode; None without one.

  Raises:
    EyeError: see `H264`.
  """
  if eye.codec == 'jpeg':
    return Jpeg(eye.jpeg_quality)
  return H264(eye.h264_crf, camera) if eye.codec == 'h264' else None


def _av() -> Any:  # noqa: ANN401
  """PyAV.

  Raises:
    EyeError: if it is not installed.
  """
  try:
    import av
  except ImportError:
    raise eyes.EyeError(
      "`codec` 'h264' takes PyAV: pip install 'waggle_tasks[video]', or choose"
      " another codec, such as 'jpeg'"
    ) from None
  return av
