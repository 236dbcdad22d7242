"""What happened, in words."""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import episode, frames, marks, moves, told
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout, moment, pen, tiles
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol.symbols import Symbol

_SIZE = 13


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
  pen.text(canvas, clock, clock_left, middle, plan.px(22), weight=pen.BOLD)
  sent = now.sent or moves.Sent(marks.of(Symbol.NULL), 0.0, 0.0)
  sent_left = rect.left + rect.width // 2
  end = pen.text(canvas, 'performer: ', sent_left, middle, size)
  colour = palette.SYMBOLS[sent.symbol]
  end = pen.chip(canvas, sent.mark.words, end, middle, size, colour) + size // 2
  part = pen.fitted(sent.part, size, clock_left - end - size // 2)
  pen.text(canvas, part, end, middle, size)
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
  agreement: agreement_lib.Agreement,
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
      middle = head.bottom + line * step + step // 2
      _entry(canvas, plan, *rows[line], middle, agreement)


def _entry(
  canvas: np.ndarray,
  plan: layout.PageLayout,
  event: episode.Event,
  name: str,
  middle: int,
  agreement: agreement_lib.Agreement,
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
  words = _words(event, agreement)
  words = pen.fitted(words, size, rect.right - left - plan.px(6))
  pen.text(canvas, words, left, middle, size)


def _words(event: episode.Event, agreement: agreement_lib.Agreement) -> str:
  if isinstance(event, observer_agent.Navigation):
    return f'{event.deed} {event.payload.bits}'
  if not isinstance(event, receiver.Event):
    return f'refused: {event.reason}'
  if event.message is not None:
    said = event.message.bits
    data = said if agreement.packets else ''
    return f'message {told.message(said, data)}'
  if event.word is not None:
    (found,) = frames.read([event], agreement)
    return found.summary
  if event.rejection is not None and event.recognition is None:
    return event.rejection
  if event.recognition is None:
    return ''
  return event.recognition.reason or f'RMSE {event.recognition.rmse:.3f}'
