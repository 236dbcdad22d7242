"""Small PNG files: at most 256 colours, which drawings seldom need more of."""

import pathlib
import struct
import zlib

import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments.machine import files

_COLOURS = 256


class PngError(errors.WaggleError):
  """A picture that cannot be written."""


def write(path: pathlib.Path, picture: np.ndarray) -> pathlib.Path:
  """Writes a picture with its most fitting 256 colours.

  Args:
    path: The file; its folder is made.
    picture: (H, W, 3) uint8 RGB.

  Returns:
    The path.

  Raises:
    PngError: if it cannot be written.
  """
  palette, indices = quantise(picture)
  height, width = indices.shape
  # Each row begins with its filter: none, which palettes compress best with.
  rows = np.pad(indices, ((0, 0), (1, 0))).tobytes()
  # Eight bits of palette (PNG specification, section 11.2.1).
  header = struct.pack('>IIBBBBB', width, height, 8, 3, 0, 0, 0)
  data = b'\x89PNG\r\n\x1a\n' + b''.join(
    _chunk(*each)
    for each in (
      (b'IHDR', header),
      (b'PLTE', palette.tobytes()),
      (b'IDAT', zlib.compress(rows, 9)),
      (b'IEND', b''),
    )
  )
  try:
    path.parent.mkdir(parents=True, exist_ok=True)
    return files.replace(path, data)
  except OSError as error:
    raise PngError(f'{path} cannot be written: {error.strerror}') from None


def _chunk(kind: bytes, data: bytes) -> bytes:
  body = kind + data
  return (
    struct.pack('>I', len(data)) + body + struct.pack('>I', zlib.crc32(body))
  )


def quantise(picture: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
  """Reduces a picture to 256 colours, by median cut.

  Heckbert, 'Color image quantization for frame buffer display' (1982).

  Args:
    picture: (H, W, 3) uint8 RGB.

  Returns:
    (C, 3) uint8 colours, C at most 256, and (H, W) uint8 which one each pixel
    has.
  """
  pixels = picture.reshape(-1, 3)
  colours, which, counts = np.unique(
    pixels, axis=0, return_inverse=True, return_counts=True
  )
  boxes = [np.arange(len(colours))]
  while len(boxes) < _COLOURS:
    # The box whose colours are spread most, weighed by how often they occur.
    spread = [
      np.ptp(colours[b].astype(int), axis=0).max() * counts[b].sum() ** 0.5
      for b in boxes
    ]
    widest = int(np.argmax(spread))
    if not spread[widest]:
      break
    box = boxes.pop(widest)
    axis = np.ptp(colours[box].astype(int), axis=0).argmax()
    box = box[np.argsort(colours[box, axis], kind='stable')]
    half = np.cumsum(counts[box])
    cut = int(np.searchsorted(half, half[-1] / 2)) + 1
    cut = min(cut, len(box) - 1)
    boxes += [box[:cut], box[cut:]]
  palette = np.empty((len(boxes), 3), np.uint8)
  chosen = np.empty(len(colours), np.uint8)
  for number, box in enumerate(boxes):
    mean = np.average(colours[box], axis=0, weights=counts[box])
    palette[number], chosen[box] = np.rint(mean), number
  return palette, chosen[which.ravel()].reshape(picture.shape[:2])
