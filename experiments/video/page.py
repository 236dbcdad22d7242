"""A page of the video: draws a moment, whole or a single view of it."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from waggle_tasks.experiments.record import moves
from waggle_tasks.experiments.video import (
  layout,
  moment,
  panel,
  pen,
  strip,
  tiles,
)
from waggle_tasks.protocol import agreement as agreement_lib

GROUND = '#14171c'


class Page(Protocol):
  """Draws moments as pictures of one size."""

  @property
  def size(self) -> tuple[int, int]:
    """Width and height in pixels."""
    ...

  def draw(self, now: moment.Instant) -> np.ndarray:
    """The picture of a moment, (H, W, 3) uint8 RGB; a buffer to be reused."""
    ...


class Composite:
  """Observers, shared views and events on one page."""

  def __init__(
    self,
    names: Sequence[str],
    title: str,
    sent: Sequence[moves.Sent],
    agreement: agreement_lib.Agreement,
    end_s: float,
    scale: float = 1.0,
    changed: Sequence[str] = (),
  ) -> None:
    """Plans the page.

    Args:
      names: Its observers, 1 to 5.
      title: What is being flown.
      sent: What the performer flies.
      agreement: What both sides know.
      end_s: How long it lasts at most.
      scale: Size; at 1 it is 1024 pixels wide.
      changed: What of the scenario is unlike the default.
    """
    self._notes = panel.notes(changed)
    self._plan = layout.plan(len(names), scale, len(self._notes))
    self._title, self._agreement = title, agreement
    self._strip = strip.Strip(self._plan, names, sent, agreement, end_s)
    self._canvas = np.empty((self._plan.height, self._plan.width, 3), np.uint8)

  @property
  def size(self) -> tuple[int, int]:
    """Width and height in pixels."""
    return self._plan.width, self._plan.height

  def draw(self, now: moment.Instant) -> np.ndarray:
    """The picture of a moment, (H, W, 3) uint8 RGB; a buffer to be reused."""
    canvas, plan = self._canvas, self._plan
    pen.fill(canvas, layout.Rect(0, 0, *self.size), GROUND)
    panel.header(canvas, plan, self._title, now)
    panel.write_notes(canvas, plan, self._notes)
    for picture, sight in zip(plan.observers, now.sights, strict=True):
      tiles.observer(canvas, plan, picture, sight)
    for name, picture in plan.shared.items():
      tiles.shared(
        canvas, plan, picture, name, now.shared[name], now.places[name]
      )
    panel.card(canvas, plan, now.sights, self._agreement)
    self._strip.draw(canvas, now)
    return canvas


class Single:
  """One view, large, with or without what is drawn on it."""

  def __init__(
    self,
    view: str,
    scale: float = 1.0,
    marks: bool = True,
    size: tuple[int, int] = layout.VIEW_PX,
  ) -> None:
    """Plans the page.

    Args:
      view: An observer's name, or one of `layout.SHARED`.
      scale: Size; at 1 the image is as large as `size`.
      marks: Whether to draw titles, tracks and symbols; otherwise the image
        is all there is, as a camera would record it.
      size: Width and height of the image.
    """
    self._view, self._marks = view, marks
    self._design, self._picture = layout.single(scale, size)
    foot = self._design.foot(self._picture)
    rows = foot.bottom if marks else self._picture.height
    self._canvas = np.zeros((rows + rows % 2, self._picture.width, 3), np.uint8)

  @property
  def size(self) -> tuple[int, int]:
    """Width and height in pixels."""
    height, width, _ = self._canvas.shape
    return width, height

  def draw(self, now: moment.Instant) -> np.ndarray:
    """The picture of a moment, (H, W, 3) uint8 RGB; a buffer to be reused."""
    sight = next((s for s in now.sights if s.name == self._view), None)
    if not self._marks:
      image = sight.image if sight else now.shared[self._view]
      tiles.place(self._canvas, layout.Rect(0, 0, *self.size), image)
      return self._canvas
    if sight:
      tiles.observer(self._canvas, self._design, self._picture, sight)
    else:
      image = now.shared[self._view]
      tiles.shared(
        self._canvas, self._design, self._picture, self._view, image,
        now.places[self._view],
      )  # fmt: skip
    self._clock(now)
    return self._canvas

  def _clock(self, now: moment.Instant) -> None:
    """Writes the time into the right end of the line below the picture."""
    foot, size = self._design.foot(self._picture), self._design.px(15)
    clock = f'{now.time_s:.2f} s'
    left = foot.right - pen.width_px(clock, size, pen.BOLD) - size // 2
    middle = foot.top + foot.height // 2
    pen.text(self._canvas, clock, left, middle, size, weight=pen.BOLD)
