"""What happened against time, along the lower edge of a picture."""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import episode, frames, moves
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout, moment, pen, tiles
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol.symbols import Symbol

_SIZE = 13
_LABELS = 92  # Width of the names on the left of the strip.
_LINE = '#4a525e'
_TICKS = 12  # At most, along the strip.
_STEPS_S = (1, 2, 5, 10, 20, 50, 100)


class Strip:
  """All events against time; keeps what is drawn and adds to it."""

  def __init__(
    self,
    plan: layout.PageLayout,
    names: Sequence[str],
    sent: Sequence[moves.Sent],
    agreement: agreement_lib.Agreement,
    end_s: float,
  ) -> None:
    """Draws the axis and what the performer will fly.

    Args:
      plan: The page.
      names: Its observers.
      sent: What the performer flies.
      agreement: What both sides know.
      end_s: Where the axis ends.
    """
    self._plan, self._agreement, self._end_s = plan, agreement, end_s
    self._left = plan.px(_LABELS)
    self._width = plan.strip.width - self._left - plan.px(12)
    self._drawn = dict.fromkeys(names, 0)
    self._ends = dict.fromkeys(names, self._left)  # Of the last mark of each.
    size = plan.strip.height, plan.strip.width, 3
    self._canvas = np.empty(size, np.uint8)
    self._canvas[:] = palette.rgb(tiles.BAR)
    self._axis()
    for row, name in enumerate(['sent', *names]):
      pen.text(
        self._canvas, name, plan.px(8), self._middle(row), plan.px(_SIZE)
      )
    self._slots(sent, self._middle(0))

  def _slots(self, slots: Sequence[moves.Sent], middle: int) -> None:
    """Draws symbols, each in its time, with its name as far as it fits."""
    size = self._plan.px(_SIZE)
    for each in slots:
      left, right = self._column(each.begin_s), self._column(each.end_s)
      ground = layout.Rect(
        left, middle - self._plan.px(8), right - left, self._plan.px(16)
      )
      colour = palette.SYMBOLS[each.symbol]
      pen.fill(self._canvas, ground, colour)
      label = pen.fitted(each.mark.label, size, ground.width, pen.BOLD)
      inset = (ground.width - pen.width_px(label, size, pen.BOLD)) // 2
      pen.text(
        self._canvas, label, left + inset, middle, size, palette.ink(colour),
        pen.BOLD,
      )  # fmt: skip

  def _middle(self, row: int) -> int:
    return self._plan.px(6) + row * self._plan.row + self._plan.row // 2

  def _column(self, time_s: float) -> int:
    return self._left + round(self._width * min(time_s / self._end_s, 1.0))

  def _axis(self) -> None:
    plan, size = self._plan, self._plan.px(12)
    rows = len(self._drawn) + 1
    top, bottom = plan.px(6), plan.px(6) + rows * plan.row
    step_s = next(s for s in _STEPS_S if self._end_s <= _TICKS * s)
    for time_s in range(0, math.floor(self._end_s) + 1, step_s):
      left = self._column(time_s)
      self._canvas[top:bottom, left] = palette.rgb(_LINE)
      label = f'{time_s} s'
      left = left - pen.width_px(label, size) // 2
      pen.text(
        self._canvas, label, left, bottom + plan.px(10), size, palette.GREY
      )

  def draw(
    self,
    canvas: np.ndarray,  # (H, W, 3) uint8
    now: moment.Instant,
  ) -> None:
    """Adds new events, and draws the strip with a line for now."""
    for row, sight in enumerate(now.sights, start=1):
      for event in sight.events[self._drawn[sight.name] :]:
        self._ends[sight.name] = self._mark(
          event, self._middle(row), self._ends[sight.name]
        )
      self._drawn[sight.name] = len(sight.events)
    rect, plan = self._plan.strip, self._plan
    part = canvas[rect.slices]
    part[:] = self._canvas
    column = self._column(now.time_s)
    bottom = plan.px(6) + (len(self._drawn) + 1) * plan.row
    part[plan.px(2) : bottom, column : column + plan.px(2)] = 255

  def _mark(self, event: episode.Event, middle: int, free: int) -> int:
    """Draws an event: nulls are small and hollow, the rest are named.

    A mark ends at its time. One that would cover the mark before it moves to
    the right, as far as its time allows, and has no name beyond that.

    Of a frame that was read as a whole, its symbols are drawn in their times.

    Args:
      event: The event.
      middle: The row.
      free: The column where the mark before it ends.

    Returns:
      The column where this one ends.
    """
    plan, column = self._plan, self._column(event.time_s)
    size = plan.px(12)
    if getattr(event, 'symbol', None) is Symbol.NULL:
      side = plan.px(9)
      left = min(max(column - side, free), column)
      box = layout.Rect(left, middle - side // 2, side, side)
      pen.fill(self._canvas, box, palette.GREY)
      inside = layout.Rect(
        box.left + plan.px(2),
        box.top + plan.px(2),
        side - 2 * plan.px(2),
        side - 2 * plan.px(2),
      )
      pen.fill(self._canvas, inside, tiles.BAR)
      return box.right
    if isinstance(event, receiver.Event):
      (whole,) = frames.read([event], self._agreement) or (None,)
      if whole is not None and whole.slots:
        self._slots(whole.slots, middle)
        return self._column(whole.slots[-1].end_s)
      label = '?' if event.symbol is Symbol.UNKNOWN else str(event.symbol)
      colour = palette.SYMBOLS[event.symbol]
    else:
      label, colour = '!', _DEED
      if isinstance(event, observer_agent.Navigation):
        label = _DEEDS.get(event.deed, '!')
    width = pen.chip_width(label, size)
    left = max(column - width, free)
    # Until its frame is read, what looked like START may be none.
    named = not frames.opens(event)
    if named and left <= column and left + width <= self._plan.strip.width:
      return pen.chip(self._canvas, label, left, middle, size, colour)
    bar = layout.Rect(
      max(column, free), middle - plan.px(8), plan.px(3), plan.px(16)
    )
    pen.fill(self._canvas, bar, colour)
    return bar.right


_DEED = palette.YELLOW
_DEEDS = {
  observer_agent.Deed.START: 'go',
  observer_agent.Deed.ARRIVAL: 'there',
}
