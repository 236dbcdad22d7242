"""What happened, in words and against time."""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import episode, story
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout, moment, pen, tiles
from waggle_tasks.protocol.symbols import Symbol

_SIZE = 13
_LABELS = 92  # Width of the names on the left of the strip.
_LINE = '#4a525e'
_TICKS = 12  # At most, along the strip.
_STEPS_S = (1, 2, 5, 10, 20, 50, 100)


def header(
  canvas: np.ndarray,  # (H, W, 3) uint8
  plan: layout.PageLayout,
  title: str,
  now: moment.Instant,
) -> None:
  """Writes what is being flown, and the simulation time."""
  rect, size = plan.header, plan.px(16)
  middle = rect.top + rect.height // 2
  clock = f'{now.time_s:6.2f} s'
  clock_left = rect.right - pen.width_px('000.00 s', plan.px(22), pen.BOLD)
  end = pen.text(
    canvas, clock, clock_left, middle, plan.px(22), weight=pen.BOLD
  )
  label = str(now.sent)
  sent_left = rect.left + rect.width // 2
  end = pen.text(canvas, 'performer: ', sent_left, middle, size)
  pen.chip(canvas, label, end, middle, size, palette.SYMBOLS[now.sent])
  room = sent_left - rect.left - size
  pen.text(canvas, pen.fitted(title, size, room), rect.left, middle, size)


def notes(changed: Sequence[str]) -> list[str]:
  """What is unlike the default scenario, in lines that fit a page."""
  room = layout.plan(1).notes.width
  lines: list[str] = []
  for each in changed:
    longer = f'{lines[-1]}, {each}' if lines else each
    if lines and pen.width_px(longer, _SIZE) <= 0.95 * room:
      lines[-1] = longer
    else:
      lines.append(each)
  return lines


def write_notes(
  canvas: np.ndarray,  # (H, W, 3) uint8
  plan: layout.PageLayout,
  lines: Sequence[str],
) -> None:
  """Writes the lines of `notes` below the header."""
  rect = plan.notes
  for number, line in enumerate(lines):
    middle = rect.top + round((number + 0.5) * rect.height / len(lines))
    pen.text(canvas, line, rect.left, middle, plan.px(_SIZE), palette.YELLOW)


def card(
  canvas: np.ndarray,  # (H, W, 3) uint8
  plan: layout.PageLayout,
  sights: Sequence[moment.View],
) -> None:
  """Writes the latest events, the newest on top."""
  rect = plan.card
  pen.fill(canvas, rect, tiles.BAR)
  head = layout.Rect(rect.left, rect.top, rect.width, plan.px(26))
  middle = head.top + head.height // 2
  pen.text(
    canvas, 'events', rect.left + plan.px(8), middle, plan.px(14),
    weight=pen.BOLD,
  )  # fmt: skip
  rows = [(event, sight.name) for sight in sights for event in sight.events]
  rows.sort(key=lambda row: -row[0].time_s)  # Stable: observers keep order.
  step = plan.px(20)
  for line in range((rect.height - head.height) // step):
    if line < len(rows):
      _entry(canvas, plan, *rows[line], head.bottom + line * step + step // 2)


def _entry(
  canvas: np.ndarray,
  plan: layout.PageLayout,
  event: episode.Event,
  name: str,
  middle: int,
) -> None:
  rect, size = plan.card, plan.px(_SIZE)
  left = rect.left + plan.px(8)
  pen.text(canvas, f'{event.time_s:6.2f}', left, middle, size, palette.GREY)
  left += pen.width_px('000.00 ', size) + plan.px(4)
  pen.text(canvas, name.rpartition('_')[2], left, middle, size)
  left += pen.width_px('00', size) + plan.px(6)
  if isinstance(event, receiver.Event):
    label, colour = str(event.symbol), palette.SYMBOLS[event.symbol]
    left = pen.chip(canvas, label, left, middle, size, colour) + plan.px(6)
  words = pen.fitted(_words(event), size, rect.right - left - plan.px(6))
  pen.text(canvas, words, left, middle, size)


def _words(event: episode.Event) -> str:
  if isinstance(event, observer_agent.Navigation):
    return f'{event.deed} {event.payload.bits}'
  if not isinstance(event, receiver.Event):
    return f'refused: {event.reason}'
  if event.message is not None:
    return f'message {event.message.bits}'
  if event.rejection is not None and event.recognition is None:
    return event.rejection
  if event.recognition is None:
    return ''
  return event.recognition.reason or f'RMSE {event.recognition.rmse:.3f}'


class Strip:
  """All events against time; keeps what is drawn and adds to it."""

  def __init__(
    self,
    plan: layout.PageLayout,
    names: Sequence[str],
    sent: Sequence[story.Sent],
    end_s: float,
  ) -> None:
    """Draws the axis and what the performer will fly.

    Args:
      plan: The page.
      names: Its observers.
      sent: What the performer flies.
      end_s: Where the axis ends.
    """
    self._plan, self._end_s = plan, end_s
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
    for each in sent:
      ground = layout.Rect(
        self._column(each.begin_s),
        self._middle(0) - plan.px(8),
        self._column(each.end_s) - self._column(each.begin_s),
        plan.px(16),
      )
      pen.fill(self._canvas, ground, palette.SYMBOLS[each.symbol])
      self._label(str(each.symbol), ground)

  def _label(self, label: str, ground: layout.Rect) -> None:
    size = self._plan.px(_SIZE)
    colour = palette.ink(palette.SYMBOLS[Symbol(label)])
    label = pen.fitted(label, size, ground.width, pen.BOLD)
    inset = (ground.width - pen.width_px(label, size, pen.BOLD)) // 2
    pen.text(
      self._canvas, label, ground.left + inset, self._middle(0), size, colour,
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
      label = '?' if event.symbol is Symbol.UNKNOWN else str(event.symbol)
      colour = palette.SYMBOLS[event.symbol]
    else:
      label, colour = '!', _DEED
      if isinstance(event, observer_agent.Navigation):
        label = _DEEDS.get(event.deed, '!')
    width = pen.chip_width(label, size)
    left = max(column - width, free)
    if left <= column and left + width <= self._plan.strip.width:
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
