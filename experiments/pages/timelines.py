"""What was sent and what each observer made of it, all on one time axis."""

from collections.abc import Sequence
import itertools
import re

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import (
  archive,
  episode,
  frames,
  marks,
  moves,
  story,
)
from waggle_tasks.experiments.results import palette
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety

_ROW = 19
_BAR = 13
_SMALL_PX = 6.2  # Width of a small letter.


def draw(run: archive.Run) -> markup.Markup:
  """The timelines of a run, as SVG."""
  across = plot.time_scale(run.end_s)
  top = 4.0
  out = [_name('sent', top), *_sent(run.sent, across, top)]
  parts = _parts(run.sent)
  if parts:
    top += _ROW
    out += [_name('packets' if 'packet' in parts[0].part else 'rounds', top)]
    out += [_at(_part(part, across), top) for part in parts]
  top += _ROW + 8
  for name, events in run.events.items():
    out.append(
      markup.tag(
        'line', x1=0, x2=plot.WIDTH, y1=top - 4, y2=top - 4, class_='rule'
      )
    )
    out.append(plot.text(0, top + 11, name, class_='name'))
    rows = (
      ('', _motions(run, name, across)),
      ('nulls', _nulls(events, across)),
      ('frame', _states(run, events, across)),
      ('navigation', _deeds(events, run.end_s, across)),
    )
    for label, blocks in rows:
      out.append(_name(label, top))
      out += [_at(each, top) for each in blocks]
      top += _ROW
    top += 8
  grid = plot.time_axis(across, 0, top)
  return plot.timed(
    top + 32, run.end_s, grid, *out, label='What was sent and received'
  )


def _name(label: str, top: float) -> markup.Markup:
  return plot.text(plot.LEFT - 8, top + 11, label, class_='tick end')


def _at(mark: markup.Markup, top: float) -> markup.Markup:
  return markup.tag('g', mark, transform=f'translate(0 {top:g})')


def block(
  left: float,
  right: float,
  label: str,
  colour: str,
  hint: str,
  striped: bool = False,
) -> markup.Markup:
  """A bar with its label in it, when that fits."""
  width = max(right - left, 2.0)
  body = markup.tag(
    'rect', x=left, y=1, width=width, height=_BAR, fill=colour, rx=2
  )
  stripes = None
  if striped:
    stripes = markup.tag(
      'rect', x=left, y=1, width=width, height=_BAR, fill='url(#stripes)'
    )
  words = None
  if len(label) * _SMALL_PX + 2 <= width:
    words = plot.text(
      (left + right) / 2, 11.5, label, class_='in', fill=palette.ink(colour)
    )
  return markup.tag('g', markup.tag('title', hint), body, stripes, words)


def _sent(
  sent: Sequence[moves.Sent], across: plot.Scale, top: float
) -> list[markup.Markup]:
  return [
    _at(
      block(
        across(each.begin_s),
        across(each.end_s),
        each.mark.label,
        palette.SYMBOLS[each.symbol],
        f'sent {each.words}, {each.begin_s:.2f} to {each.end_s:.2f} s',
      ),
      top,
    )
    for each in sent
  ]


def _parts(sent: Sequence[moves.Sent]) -> list[moves.Sent]:
  """The packets or rounds that are sent, each from START to END."""
  groups = itertools.groupby(sent, key=lambda each: each.part)
  spans = [(part, [*members]) for part, members in groups if part]
  return [
    moves.Sent(marks.of(Symbol.START), own[0].begin_s, own[-1].end_s, part)
    for part, own in spans
  ]


def _part(part: moves.Sent, across: plot.Scale) -> markup.Markup:
  """A packet or a round; where there is little room, by numbers alone."""
  begin, end = across(part.begin_s), across(part.end_s)
  short = re.sub(r'\w+ (\d+) of (\d+)', r'\1/\2', part.part)
  label = part.part if len(part.part) * _SMALL_PX + 2 <= end - begin else short
  hint = f'{part.part}, {part.begin_s:.2f} to {part.end_s:.2f} s'
  return block(begin, end, label, _BIT, hint)


def _motions(
  run: archive.Run, name: str, across: plot.Scale
) -> list[markup.Markup]:
  """Each motion from its beginning to its rest, then when it was confirmed."""
  trace = run.traces.get(name)
  spans = {m.confirmed_s: m for m in trace.motions} if trace else {}
  out = []
  seen = frames.read(run.events[name], run.config.agreement)
  for event in motions(run.events[name]):
    span = spans.get(event.time_s)
    begin_s = span.begin_s if span else event.time_s
    unknown = event.symbol is Symbol.UNKNOWN
    hint = f'{event.symbol} confirmed at {event.time_s:.2f} s'
    if event.recognition is not None:
      scores = event.recognition
      hint += f', RMSE {scores.rmse:.3f}. {scores.reason}'
    if event.rejection is not None:
      hint += f'. {event.rejection}'
    out.append(
      block(
        across(begin_s), across(event.time_s),
        '?' if unknown else str(event.symbol), palette.SYMBOLS[event.symbol],
        hint, unknown,
      )
    )  # fmt: skip
  return [*out, *(_read(slot, each, across) for each in seen
                  for slot in each.slots)]  # fmt: skip


def _read(
  slot: moves.Sent, whole: frames.Frame, across: plot.Scale
) -> markup.Markup:
  """A symbol of a frame that was read as a whole, in its time."""
  hint = (
    f'read {slot.mark.words}, {slot.begin_s:.2f} to {slot.end_s:.2f} s; the'
    f' frame at {whole.time_s:.2f} s: {whole.words}'
  )
  colour = palette.SYMBOLS[slot.symbol]
  return block(
    across(slot.begin_s), across(slot.end_s), slot.mark.label, colour, hint
  )


def motions(events: Sequence[episode.Event]) -> list[receiver.Event]:
  """The motions among an observer's events."""
  return [
    event
    for event in events
    if isinstance(event, receiver.Event) and event.symbol is not Symbol.NULL
  ]


def _nulls(
  events: Sequence[episode.Event], across: plot.Scale
) -> list[markup.Markup]:
  """A diamond where each null was confirmed."""
  out = []
  for event in events:
    if isinstance(event, receiver.Event) and event.symbol is Symbol.NULL:
      x = float(across(event.time_s))
      out.append(
        markup.tag(
          'path',
          markup.tag('title', f'NULL at {event.time_s:.2f} s'),
          d=f'M{x:.1f} 2l5 5.5l-5 5.5l-5 -5.5z',
          class_='null',
        )
      )
  return out


def _states(
  run: archive.Run, events: Sequence[episode.Event], across: plot.Scale
) -> list[markup.Markup]:
  """What the frame parser waited for, from event to event."""
  agreed, end_s = run.config.agreement, run.end_s
  changes = [(0.0, story.Reading(agreed))]
  for time_s, reading in story.readings(events, agreed):
    if reading.deed:
      end_s = min(end_s, time_s)  # Navigating, it parses no more.
    elif reading.waits_for != changes[-1][1].waits_for:
      changes.append((time_s, reading))
  out = []
  ends = [time_s for time_s, _ in changes[1:]] + [end_s]
  for (begin_s, reading), stop_s in zip(changes, ends, strict=True):
    label = reading.waits_for
    colour = _WAITING.get(label, _BIT)
    hint = f'waits for {label}, {begin_s:.2f} to {stop_s:.2f} s'
    if reading.parts:
      hint += f'; {reading.parts}'
    out.append(block(across(begin_s), across(stop_s), label, colour, hint))
  return out


_BIT = '#cfe8f7'
_WAITING = {
  'first null': '#e4e7eb',
  'null': '#e4e7eb',
  'START': '#b9d3e6',
  'END': '#efd5e3',
  'final null': '#d5ead9',
}


def _deeds(
  events: Sequence[episode.Event], end_s: float, across: plot.Scale
) -> list[markup.Markup]:
  """The flight, the hold after it, or the refusal."""
  out: list[markup.Markup] = []
  started_s: float | None = None
  for event in events:
    time_s = event.time_s
    if isinstance(event, safety.Refusal):
      hint = f'refused at {time_s:.2f} s: {event.reason}'
      stop_s = min(time_s + 1.0, end_s)
      out.append(
        block(
          across(time_s), across(stop_s), 'refused', palette.VERMILLION, hint
        )
      )
    elif not isinstance(event, observer_agent.Navigation):
      continue
    elif event.deed is observer_agent.Deed.START:
      started_s = time_s
    elif started_s is not None:
      hint = f'flew {started_s:.2f} to {time_s:.2f} s, then held'
      fly = block(
        across(started_s), across(time_s), 'fly', palette.YELLOW, hint
      )
      hold = block(across(time_s), across(end_s), 'hold', palette.GREEN, hint)
      return [*out, fly, hold]
  if started_s is not None:
    hint = f'flew from {started_s:.2f} s and never arrived'
    out.append(
      block(across(started_s), across(end_s), 'fly', palette.YELLOW, hint)
    )
  return out
