"""Draws letters, chips and lines; all colours are '#rrggbb', pixels are RGB."""

import functools

import cv2
import numpy as np

from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout

REGULAR, BOLD = 400, 700


@functools.cache
def _font() -> cv2.FontFace:
  return cv2.FontFace('sans')


@functools.lru_cache(4096)
def width_px(text: str, size: int, weight: int = REGULAR) -> int:
  """How far a line of text reaches."""
  origin = (0, size)
  box = cv2.getTextSize((1, 1), text, origin, _font(), size, weight)
  return box[0] + box[2]


@functools.lru_cache(4096)
def fitted(text: str, size: int, room: int, weight: int = REGULAR) -> str:
  """The text, or as much of its beginning as fits, with an ellipsis."""
  if width_px(text, size, weight) <= room:
    return text
  while text and width_px(text + '...', size, weight) > room:
    text = text[:-1]
  return text + '...' if text else ''


def text(
  canvas: np.ndarray,  # (H, W, 3) uint8
  line: str,
  left: int,
  middle: int,
  size: int,
  colour: str = palette.WHITE,
  weight: int = REGULAR,
) -> int:
  """Writes a line whose capitals are centred on row `middle`.

  Returns:
    The column where it ends.
  """
  baseline = middle + round(0.36 * size)
  cv2.putText(
    canvas, line, (left, baseline), palette.rgb(colour), _font(), size, weight
  )
  return left + width_px(line, size, weight)


def fill(canvas: np.ndarray, rect: layout.Rect, colour: str) -> None:
  """Fills a rectangle."""
  last = rect.right - 1, rect.bottom - 1
  cv2.rectangle(
    canvas, (rect.left, rect.top), last, palette.rgb(colour), cv2.FILLED
  )


def chip(
  canvas: np.ndarray,
  label: str,
  left: int,
  middle: int,
  size: int,
  colour: str,
) -> int:
  """Writes a label on a coloured ground.

  Returns:
    The column where the ground ends.
  """
  pad = round(0.38 * size)
  width = max(width_px(label, size, BOLD), round(0.62 * size)) + 2 * pad
  half = round(0.72 * size)
  ground = layout.Rect(left, middle - half, width, 2 * half)
  fill(canvas, ground, colour)
  inset = (width - width_px(label, size, BOLD)) // 2
  text(canvas, label, left + inset, middle, size, palette.ink(colour), BOLD)
  return left + width


def chip_width(label: str, size: int) -> int:
  """How wide `chip` draws a label."""
  return max(width_px(label, size, BOLD), round(0.62 * size)) + 2 * round(
    0.38 * size
  )


def outline(
  canvas: np.ndarray, points: np.ndarray, colour: str, thickness: int
) -> None:
  """Draws a path, (K, 2) pixels, with a dark edge that shows on any ground."""
  # OpenCV takes fixed-point coordinates: four bits behind the point.
  path = np.rint(points * 16).astype(np.int32).reshape(-1, 1, 2)
  for shade, width in ((palette.BLACK, thickness + 2), (colour, thickness)):
    cv2.polylines(
      canvas, [path], False, palette.rgb(shade), width, cv2.LINE_AA, 4
    )
