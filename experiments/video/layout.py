"""Where everything stands in a picture of the composite video."""

from collections.abc import Sequence
import dataclasses
import itertools

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import camera, checks

PER_PAGE = 5  # Observers beside the shared views; more get pages of their own.
COMPOSITE = 'composite'  # The view of everyone.
SHARED = {
  'performer': 'performer_view',
  'top': 'top',
  'overview': 'overview',
}  # Name of a view -> name of its camera.

FPS = 5.0  # Every fifth frame: cheap beside the run.
VIEW_PX = camera.Camera().size  # Of a shared view.

_WIDTH = 1024
_GAP = 6
_HEADER = 38
_NOTE = 18  # A line of notes below it.
_TITLE = 23  # Above a picture.
_FOOT = 25  # Below an observer's.
_ROW = 20  # Of the strip of events.
_AXIS = 24


class VideoError(errors.WaggleError):
  """A video that cannot be made as asked for."""


@dataclasses.dataclass(frozen=True)
class Rect:
  """A rectangle in pixels; slicing with it gives its part of an image."""

  left: int
  top: int
  width: int
  height: int

  @property
  def right(self) -> int:
    """The first column beyond it."""
    return self.left + self.width

  @property
  def bottom(self) -> int:
    """The first row beyond it."""
    return self.top + self.height

  @property
  def slices(self) -> tuple[slice, slice]:
    """Rows and columns."""
    return slice(self.top, self.bottom), slice(self.left, self.right)


def fitted(place: Rect, image: np.ndarray) -> Rect:
  """The largest part of a place, in its middle, with the shape of an image."""
  height, width = image.shape[:2]
  zoom = min(place.width / width, place.height / height)
  beside, above = (
    (there - round(zoom * here)) // 2
    for there, here in ((place.width, width), (place.height, height))
  )
  if max(beside, above) < 1:  # But for rounding it fills all of it.
    return place
  return Rect(
    place.left + beside,
    place.top + above,
    place.width - 2 * beside,
    place.height - 2 * above,
  )


@dataclasses.dataclass(frozen=True)
class Design:
  """How large things are drawn.

  Attributes:
    scale: Pixels per unit of the design, whose page is 1024 wide.
  """

  scale: float

  def __post_init__(self) -> None:
    checks.number('video_scale', self.scale, 0.25, 2.0, VideoError)

  def px(self, length: float) -> int:
    """Pixels of a length of the design."""
    return max(1, round(length * self.scale))

  def title(self, picture: Rect) -> Rect:
    """The line above a picture."""
    height = self.px(_TITLE)
    return Rect(picture.left, picture.top - height, picture.width, height)

  def foot(self, picture: Rect) -> Rect:
    """The line below an observer's picture."""
    return Rect(picture.left, picture.bottom, picture.width, self.px(_FOOT))

  @property
  def row(self) -> int:
    """Height of a row of the strip."""
    return self.px(_ROW)


@dataclasses.dataclass(frozen=True)
class PageLayout(Design):
  """A page of the composite video.

  Attributes:
    width: Of the whole picture, even, as encoders ask for.
    height: The same.
    header: Time and what is being sent.
    notes: What is unlike the default scenario.
    observers: The picture of each observer, without its title and foot.
    shared: The shared views, without their titles, by name.
    card: The latest events in words.
    strip: All events against time.
  """

  width: int
  height: int
  header: Rect
  notes: Rect
  observers: tuple[Rect, ...]
  shared: dict[str, Rect]
  card: Rect
  strip: Rect


def pages(names: Sequence[str]) -> list[tuple[str, ...]]:
  """Shares observers out on as few pages as possible, as evenly as possible."""
  count = -(-len(names) // PER_PAGE)
  ends = [round(len(names) * page / count) for page in range(count + 1)]
  return [tuple(names[a:b]) for a, b in itertools.pairwise(ends)]


def single(
  scale: float = 1.0, size: tuple[int, int] = VIEW_PX
) -> tuple[Design, Rect]:
  """A single view with room for its title and foot, and where it stands."""
  design = Design(scale)
  width, height = (2 * round(side * scale / 2) for side in size)
  return design, Rect(0, design.px(_TITLE), width, height)


def plan(observers: int, scale: float = 1.0, notes: int = 0) -> PageLayout:
  """Lays out a page of the composite video.

  Every page is 1024 wide at scale 1 and as high as it needs to be: observers
  side by side, below them the shared views and the card, then the strip. A
  single observer has the others on its right.

  Args:
    observers: How many are on it, 1 to 5.
    scale: Size, 0.25 to 2.
    notes: How many lines there are below the header.

  Raises:
    VideoError: if a number is out of its range.
  """
  checks.integer('observers', observers, 1, PER_PAGE, VideoError)
  top: float = _GAP + _HEADER + notes * _NOTE
  cell = (_WIDTH - 5 * _GAP) / 4
  high = cell * 3 / 4
  if observers == 1:
    tall = 2 * (_TITLE + high) + _GAP
    eyes: list[tuple[float, float, float]] = [
      (_GAP, top + _TITLE, (tall - _TITLE - _FOOT) * 4 / 3)
    ]
    left = _WIDTH - 2 * (cell + _GAP)
    cells = [
      (left + column * (cell + _GAP), top + row * (_TITLE + high + _GAP))
      for row in (0, 1)
      for column in (0, 1)
    ]
    top += tall
  else:
    wide = (_WIDTH - _GAP * (observers + 1)) / observers
    eyes = [
      (_GAP + k * (wide + _GAP), top + _TITLE, wide) for k in range(observers)
    ]
    top += _TITLE + wide * 3 / 4 + _FOOT + _GAP
    cells = [(_GAP + k * (cell + _GAP), top) for k in range(4)]
    top += _TITLE + high
  top += _GAP
  strip = _AXIS + (observers + 1) * _ROW + _GAP

  def rect(left: float, top: float, width: float, height: float) -> Rect:
    return Rect(*(round(scale * v) for v in (left, top, width, height)))

  return PageLayout(
    scale,
    2 * round(_WIDTH * scale / 2),
    2 * round((top + strip + _GAP) * scale / 2),
    rect(_GAP, _GAP / 2, _WIDTH - 2 * _GAP, _HEADER),
    rect(_GAP, _GAP / 2 + _HEADER, _WIDTH - 2 * _GAP, notes * _NOTE),
    tuple(rect(*eye, eye[-1] * 3 / 4) for eye in eyes),
    {
      name: rect(x, y + _TITLE, cell, high)
      for name, (x, y) in zip(SHARED, cells, strict=False)
    },
    rect(*cells[3], cell, _TITLE + high),
    rect(_GAP, top, _WIDTH - 2 * _GAP, strip),
  )
