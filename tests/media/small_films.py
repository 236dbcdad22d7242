"""Films of a moving disc, three seconds long, as healthy cameras make them."""

from collections.abc import Iterator
import fractions
import pathlib

import av
import av.subtitles.stream  # Which PyAV imports late, when a test may hide it.
import cv2
import numpy as np

COUNT, RATE_HZ = 75, 25
SIZE = (96, 64)


def pictures(size: tuple[int, int] = SIZE) -> Iterator[np.ndarray]:
  """What every film shows: (H, W, 3) uint8 RGB."""
  width, height = size
  for number in range(COUNT):
    image = np.full((height, width, 3), 90, np.uint8)
    x = 10 + number * (width - 20) // COUNT
    cv2.circle(image, (x, height // 2), 6, (230, 120, 20), -1)
    yield image


def write(
  path: pathlib.Path,
  codec: str = 'libx264',
  pixels: str = 'yuv420p',
  options: dict[str, str] | None = None,
  size: tuple[int, int] = SIZE,
  begin_s: int = 0,
  aspect: fractions.Fraction | None = None,
  times_s: list[float] | None = None,
  sound_s: float = 0.0,
  container: str | None = None,
) -> pathlib.Path:
  """Writes the film.

  Args:
    path: Its ending chooses the container.
    codec: Name of FFmpeg's encoder.
    pixels: Its pixel format.
    options: Its options.
    size: Width and height.
    begin_s: Time of the first picture.
    aspect: Width of a pixel over its height.
    times_s: Of the pictures; None for a constant rate.
    sound_s: How much silence there is, before the first picture in the file.
    container: Name of FFmpeg's format; None for that of the ending.
  """
  clock = fractions.Fraction(1, 90_000 if times_s else RATE_HZ)
  with av.open(str(path), 'w', format=container) as film:
    sound = film.add_stream('aac', rate=8000) if sound_s else None
    stream = film.add_stream(codec, rate=RATE_HZ, options=options or {})
    stream.width, stream.height = size
    stream.pix_fmt = pixels
    stream.codec_context.time_base = clock
    if aspect:
      stream.codec_context.sample_aspect_ratio = aspect
    for block in range(int(sound_s * 8000 / 1024) + 1 if sound else 0):
      silence = np.zeros((1, 1024), np.float32)
      frame = av.AudioFrame.from_ndarray(silence, 'fltp', 'mono')
      frame.sample_rate, frame.pts = 8000, 1024 * block
      film.mux(sound.encode(frame))
    if sound:
      film.mux(sound.encode())
    for number, image in enumerate(pictures(size)):
      time_s = times_s[number] if times_s else number / RATE_HZ
      frame = av.VideoFrame.from_ndarray(image, 'rgb24')
      frame.pts, frame.time_base = round((begin_s + time_s) / clock), clock
      film.mux(stream.encode(frame))
    film.mux(stream.encode())
  return path
