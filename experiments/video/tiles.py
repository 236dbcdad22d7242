"""Pictures with their titles: an observer's sight, and a shared view."""

from collections.abc import Mapping

import cv2
import numpy as np

from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout, moment, pen

BAR = '#262b33'
_GOOD, _LOST, _TRAIL = palette.GREEN, palette.VERMILLION, palette.YELLOW
_BOX_PX = 60.0  # Around a target, in the observer's own pixels.
_REST_PX = 2.0  # A shorter trail would only hide the target.
_SIZE = 14
_RING = 9  # Around a vehicle in a shared view.
_NAMES = {
  'performer': 'performer view',
  'top': 'top view',
  'overview': 'overview',
}


def observer(
  canvas: np.ndarray,  # (H, W, 3) uint8
  plan: layout.Design,
  picture: layout.Rect,
  sight: moment.View,
) -> None:
  """Draws an observer's image with its track, its state and its symbols."""
  within = layout.fitted(picture, sight.image)
  if within != picture:
    pen.fill(canvas, picture, BAR)
  place(canvas, within, sight.image)
  if not sight.reading.deed:
    _marks(canvas[within.slices], plan, sight)
  title = plan.title(picture)
  _bar(canvas, plan, title, sight.name)
  name_px = pen.width_px(sight.name, plan.px(_SIZE), pen.BOLD)
  size, pad = plan.px(_SIZE - 1), plan.px(6)
  status = pen.fitted(
    sight.reading.status, size, title.width - name_px - 3 * pad
  )
  left = title.right - pen.width_px(status, size) - pad
  pen.text(canvas, status, left, _middle(title), size, palette.YELLOW)
  _symbols(canvas, plan, plan.foot(picture), sight)


def shared(
  canvas: np.ndarray,  # (H, W, 3) uint8
  plan: layout.Design,
  picture: layout.Rect,
  name: str,
  image: np.ndarray,  # (H, W, 3) uint8
  places: Mapping[str, tuple[float, float]],
) -> None:
  """Draws a shared view, and where in it every vehicle is."""
  place(canvas, picture, image)
  zoom = picture.width / image.shape[1]
  for vehicle, (column, row) in places.items():
    inside = 0 <= column < image.shape[1] and 0 <= row < image.shape[0]
    if inside:
      _vehicle(canvas[picture.slices], plan, vehicle, column * zoom, row * zoom)
  _bar(canvas, plan, plan.title(picture), _NAMES[name])


def _vehicle(
  picture: np.ndarray, plan: layout.Design, name: str, x: float, y: float
) -> None:
  """Draws a ring around a vehicle, which is small, and its number."""
  turns = np.linspace(0.0, 2 * np.pi, 25)
  radius, size = plan.px(_RING), plan.px(_SIZE - 2)
  ring = np.column_stack(
    [x + radius * np.cos(turns), y + radius * np.sin(turns)]
  )
  number = name.rpartition('_')[2] if name.startswith('observer') else ''
  colour = palette.WHITE if number else palette.ORANGE
  pen.outline(picture, ring, colour, plan.px(1))
  if number:
    width, gap = pen.chip_width(number, size), plan.px(2)
    left = min(max(round(x) - width // 2, 0), picture.shape[1] - width)
    below = round(y) + radius + gap + size
    above = round(y) - radius - gap - size
    middle = below if below + size < picture.shape[0] else above
    pen.chip(picture, number, left, middle, size, palette.WHITE)


def _middle(rect: layout.Rect) -> int:
  return rect.top + rect.height // 2


def place(
  canvas: np.ndarray,  # (H, W, 3) uint8
  picture: layout.Rect,
  image: np.ndarray,  # (H, W, 3) uint8
) -> None:
  """Fills a rectangle with an image."""
  size = picture.width, picture.height
  while image.shape[1] >= 2 * picture.width:
    # Halves by means of 2 x 2, which OpenCV does fast.
    half = image.shape[1] // 2, image.shape[0] // 2
    image = cv2.resize(image, half, interpolation=cv2.INTER_AREA)
  canvas[picture.slices] = cv2.resize(image, size)


def _bar(
  canvas: np.ndarray, plan: layout.Design, rect: layout.Rect, name: str
) -> None:
  pen.fill(canvas, rect, BAR)
  pen.text(
    canvas, name, rect.left + plan.px(6), _middle(rect), plan.px(_SIZE),
    weight=pen.BOLD,
  )  # fmt: skip


def _marks(
  picture: np.ndarray, plan: layout.Design, sight: moment.View
) -> None:
  """Draws the track: a trail, where it rests, and where it is."""
  if sight.track is None:
    return
  zoom = picture.shape[1] / sight.image.shape[1]
  trail_px = sight.trail_px
  if len(trail_px) and np.ptp(trail_px, axis=0).max() > _REST_PX:
    pen.outline(picture, sight.trail_px * zoom, _TRAIL, plan.px(2))
  half = _BOX_PX / 2 * zoom
  colour = _GOOD if sight.track.valid else _LOST
  for x in (-half, half):
    for y in (-half, half):
      corner = np.array([(0.5 * x, y), (x, y), (x, 0.5 * y)])
      where = np.asarray(sight.track.centre_px) * zoom
      pen.outline(picture, corner + where, colour, plan.px(2))
  if not sight.track.valid:
    word = 'lost' if len(sight.trail_px) else 'searching'
    size = plan.px(_SIZE)
    place = np.asarray(sight.track.centre_px) * zoom
    left, top = np.rint(place - half).astype(int)
    where = max(int(left), 0), max(int(top) - size, size)
    pen.chip(picture, word, *where, size, colour)


def _symbols(
  canvas: np.ndarray,
  plan: layout.Design,
  foot: layout.Rect,
  sight: moment.View,
) -> None:
  """Writes the symbols of the frame under way."""
  pen.fill(canvas, foot, BAR)
  size, left = plan.px(_SIZE), foot.left + plan.px(6)
  if not sight.reading.symbols:
    pen.text(canvas, 'no frame yet', left, _middle(foot), size, palette.GREY)
  symbols, gap = sight.reading.symbols, plan.px(2)
  room = foot.right - left - gap
  while size > 1 and room < sum(
    pen.chip_width(mark.label, size) + gap for mark in symbols
  ):
    size -= 1
  for mark in symbols:
    left = gap + pen.chip(
      canvas, mark.label, left, _middle(foot), size,
      palette.SYMBOLS[mark.symbol],
    )  # fmt: skip
