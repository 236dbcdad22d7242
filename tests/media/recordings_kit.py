"""One captured dance, written as every kind of recording that people have.

The pictures are the simulator's own; only codec, rate, size and light differ.
"""

from collections.abc import Callable, Iterator
import dataclasses
import fractions
import itertools
import math
import pathlib
import struct

import av
import cv2
import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.record import capture
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera, reference

FOCAL_PX = camera.Camera.focal_px  # Of the simulator's pictures.
_MS = fractions.Fraction(1, 1000)
_RATE_HZ = 25  # Of the simulator.


@dataclasses.dataclass(frozen=True)
class Dance:
  """What one observer in front of the performer saw of a whole broadcast.

  Attributes:
    path: The capture of its images, 640 x 480 at 25 Hz.
    payload: The message that was danced.
    agreement: What it was danced by.
  """

  path: pathlib.Path
  payload: str
  agreement: agreement_lib.Agreement

  def images(self) -> Iterator[tuple[np.ndarray, float]]:
    """Its images and their times; the next image overwrites the last."""
    return capture.read(self.path)


def fly(path: pathlib.Path, scene: scenario.Scenario) -> Dance:
  """Captures a broadcast to its very end; the observer stays where it is."""
  environment = registry.environment(scene)
  # The final null, and what is behind it.
  end_s = scene.performance.end_s + 6.0
  try:
    timestep = environment.reset()
    with capture.Writer(path) as writer:
      while not timestep.last():
        (seen,) = timestep.observation
        if seen['time_s'] > end_s:
          break
        writer.write(seen['camera'], float(seen['time_s']))
        hover = reference.Reference.hover(seen['position_m']).to_array()
        timestep = environment.step([hover])
  finally:
    environment.close()
  return Dance(path, scene.payload, scene.agreement)


# What makes an encoder quick, and the pixels of one that has its own.
_FAST = {
  'libx264': {'preset': 'veryfast'},
  'libx265': {'preset': 'ultrafast', 'x265-params': 'log-level=none'},
  'libvpx': {'deadline': 'realtime', 'cpu-used': '8'},
  'libvpx-vp9': {'deadline': 'realtime', 'cpu-used': '8'},
}
_PIXELS = {'gif': 'bgr8', 'mjpeg': 'yuvj420p'}

Change = Callable[[np.ndarray], np.ndarray]
Timed = Iterator[tuple[np.ndarray, float]]


def _same(image: np.ndarray) -> np.ndarray:
  return image


def _at_rate(images: Timed, rate_hz: float) -> Timed:
  """The latest image at each tick: repeated above 25 Hz, dropped below."""
  count, last = 0, None
  for image, time_s in images:
    while last is not None and count / rate_hz < time_s - 1e-6:
      yield last, count / rate_hz
      count += 1
    last = image.copy()
  yield last, count / rate_hz


def _late_and_lost(images: Timed) -> Timed:
  """As phones record: one picture in five lost, the others early or late."""
  random = np.random.RandomState(0)
  for image, time_s in images:
    if random.rand() < 0.8:
      yield image, time_s + random.uniform(0.0, 0.015)


def _news_only(images: Timed) -> Timed:
  """As screens are recorded: nothing new, no picture, but one in 0.16 s."""
  last, last_s = None, -math.inf
  for image, time_s in images:
    new = last is None or not np.array_equal(last, image)
    if new or time_s - last_s > 0.15:
      last, last_s = image.copy(), time_s
      yield image, time_s


@dataclasses.dataclass(frozen=True)
class Kind:
  """One kind of recording.

  Attributes:
    name: What the file is called.
    codec: Name of FFmpeg's encoder.
    options: Its options.
    rate_hz: Pictures a second; 25 are the simulator's own.
    change: What happens to each picture.
    retime: What happens to the times, in place of a constant rate.
    turned: Whether the picture lies on its side and the container says so.
    aspect: Width of a pixel over its height; None when nothing says.
    focal_px: Focal length of the changed picture, as it is shown.
    klt: Why `klt`, with the paper's thresholds, need not read it.
  """

  name: str
  codec: str = 'libx264'
  options: tuple[tuple[str, str], ...] = (('crf', '23'),)
  rate_hz: fractions.Fraction = fractions.Fraction(25)
  change: Change = _same
  retime: Callable[[Timed], Timed] | None = None
  turned: bool = False
  aspect: fractions.Fraction | None = None
  focal_px: float = FOCAL_PX
  klt: str = ''

  def write(self, dance: Dance, folder: pathlib.Path) -> pathlib.Path:
    """Makes the recording of a dance in a folder, and returns its path."""
    path = folder / self.name
    images = dance.images()
    if self.retime:
      images = self.retime(images)
    elif self.rate_hz != _RATE_HZ:
      images = _at_rate(images, float(self.rate_hz))
    clock = _MS if self.retime else 1 / self.rate_hz
    first = next(images)
    shape = self.change(first[0]).shape
    with av.open(str(path), 'w') as container:
      stream = container.add_stream(self.codec, rate=self.rate_hz)
      stream.height, stream.width = shape[:2]
      stream.pix_fmt = _PIXELS.get(self.codec, 'yuv420p')
      stream.options = _FAST.get(self.codec, {}) | dict(self.options)
      if self.aspect:
        stream.codec_context.sample_aspect_ratio = self.aspect
      stream.time_base = stream.codec_context.time_base = clock
      for image, time_s in itertools.chain([first], images):
        changed = np.ascontiguousarray(self.change(image))
        picture = av.VideoFrame.from_ndarray(changed, format='rgb24')
        picture.pts, picture.time_base = round(time_s / clock), clock
        container.mux(stream.encode(picture))
      container.mux(stream.encode())
    if self.turned:
      _turn_back(path, height=shape[0])
    return path


def _turn_back(path: pathlib.Path, height: int) -> None:
  """Has an MP4 say that its picture is to be turned right by a quarter."""
  data = bytearray(path.read_bytes())
  place = data.index(b'tkhd') + 44  # Of the matrix, behind fixed fields.
  one, w = 1 << 16, 1 << 30
  struct.pack_into(
    '>9i', data, place, 0, one, 0, -one, 0, 0, height * one, 0, w
  )
  path.write_bytes(data)


def _turned(image: np.ndarray) -> np.ndarray:
  return cv2.rotate(image, cv2.ROTATE_90_COUNTERCLOCKWISE)


def _quarter(image: np.ndarray) -> np.ndarray:
  return cv2.resize(image, (320, 240), None, 0, 0, cv2.INTER_AREA)


def _barred(width: int, height: int) -> Change:
  """All of the image in the middle of a wide picture, black on both sides."""

  def change(image: np.ndarray) -> np.ndarray:
    inner = cv2.resize(image, (height * 4 // 3, height), None, 0, 0)
    side = (width - inner.shape[1]) // 2
    return cv2.copyMakeBorder(inner, 0, 0, side, side, cv2.BORDER_CONSTANT)

  return change


def _wide(image: np.ndarray) -> np.ndarray:
  """All of the image in 1920 x 1080, its pixels higher than wide."""
  return cv2.resize(image, (1920, 1080), None, 0, 0)


def _square(image: np.ndarray) -> np.ndarray:
  return image[:, 80:560]


def _lit(gain: float, offset: float) -> Change:
  table = np.clip(gain * np.arange(256) + offset, 0, 255).astype(np.uint8)
  return lambda image: cv2.LUT(image, table)


_FAR = 'between two pictures the target moves farther than flow follows'
_FEW = 'corners are fewer, or farther apart, than the paper asks for'
_JUMPY = 'still pictures jump by more than the 2.5 px/s of a null'


def _rates() -> tuple[Kind, ...]:
  rates = ('10', '12.5', '15', '24', '30000/1001', '50', '60000/1001', '60')
  out = []
  for text in rates:
    rate_hz = fractions.Fraction(text)
    name = f'{float(rate_hz):.4g}'.replace('.', 'p')
    klt = _FAR if rate_hz == 10 else ''
    out.append(Kind(f'h264-{name}hz.mp4', rate_hz=rate_hz, klt=klt))
  return tuple(out)


def _crf(value: int) -> tuple[tuple[str, str], ...]:
  return (('crf', str(value)),)


_BY_BITS = (('b', '1500k'),)
KINDS = (
  *(Kind(f'h264-crf{crf}.mp4', options=_crf(crf)) for crf in (18, 23, 28, 32)),
  # Better encoders repeat more of a still picture.
  Kind(
    'h264-crf23-medium.mp4', options=(('crf', '23'), ('preset', 'medium'))
  ),
  Kind('hevc.mp4', 'libx265', _crf(28), klt=_JUMPY),
  Kind('mjpeg.avi', 'mjpeg', (('q', '3'),)),
  Kind('vp8.webm', 'libvpx', _BY_BITS),
  Kind('vp9.webm', 'libvpx-vp9', _BY_BITS),
  Kind('gif-10hz.gif', 'gif', (), fractions.Fraction(10), klt=_FAR),
  *_rates(),
  Kind('h264-late-and-lost.mkv', retime=_late_and_lost),
  Kind('h264-news-only.mkv', retime=_news_only),
  Kind(
    'h264-320x240.mp4', change=_quarter, focal_px=FOCAL_PX / 2, klt=_FEW
  ),
  Kind(
    'h264-1280x720-bars.mp4', change=_barred(1280, 720),
    focal_px=FOCAL_PX * 1.5,
  ),
  Kind(
    'h264-1920x1080-bars.mp4', change=_barred(1920, 1080),
    focal_px=FOCAL_PX * 2.25, klt=_FEW,
  ),
  Kind(
    'h264-1920x1080-narrow-pixels.mp4', change=_wide,
    aspect=fractions.Fraction(3, 4), focal_px=FOCAL_PX * 2.25, klt=_FEW,
  ),
  Kind('h264-480x480.mp4', change=_square),
  Kind('h264-dark.mp4', change=_lit(0.3, 0)),
  Kind('h264-bright.mp4', change=_lit(1.4, 40)),
  Kind('h264-turned.mp4', change=_turned, turned=True),
)  # fmt: skip
