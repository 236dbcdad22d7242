"""Frames that an observer read as a whole, beside what was sent."""

from collections.abc import Sequence

from waggle_tasks.agents import receiver
from waggle_tasks.experiments.pages import markup
from waggle_tasks.experiments.record import archive, frames, moves
from waggle_tasks.experiments.results import palette
from waggle_tasks.protocol.symbols import Symbol

tag = markup.tag
_HEADER = (
  'read at, s', 'began, s', 'symbols', 'says', 'clear', 'from', 'away, m',
  'as sent',
)  # fmt: skip
_NONE = '\u2013'


def are_told(run: archive.Run, name: str) -> bool:
  """Whether an observer's receiver reads frames as a whole, not by motions."""
  spoken = run.config.agreement.language is not None
  return spoken or any(
    isinstance(event, receiver.Event) and event.word is not None
    for event in run.events[name]
  )


def draw(run: archive.Run, name: str, limits: Sequence[str]) -> markup.Markup:
  """What an observer read of each frame, and what it refused.

  Args:
    run: The run.
    name: The observer.
    limits: What its receiver asks of a frame; empty if it does not tell.
  """
  events = run.events[name]
  found = frames.read(events, run.config.agreement)
  begun = sum(
    isinstance(event, receiver.Event) and event.symbol is Symbol.START
    for event in events
  )
  if not begun and not found:
    return tag('p', 'It saw no START.', class_='faint')
  asked = None
  if limits:
    asked = tag(
      'details', tag('summary', 'What a frame is read by'),
      tag('ul', *(tag('li', limit) for limit in limits)), class_='faint',
    )  # fmt: skip
  told = f'It took {begun} motion{"" if begun == 1 else "s"} for START.'
  if not found:
    return tag(
      'div', tag('p', f'{told} No frame was over.', class_='faint'), asked
    )
  rows = [_row(each, run.sent) for each in found]
  about = (
    f'{told} Clear is how much nearer what was read is than any other word, as'
    ' a share of how far they are apart.'
  )
  return tag('div', markup.table(_HEADER, rows, about), asked)


def _row(
  each: frames.Frame, sent: Sequence[moves.Sent]
) -> list[markup.Content]:
  time = f'{each.time_s:.2f}'
  said = markup.join(
    [each.says, tag('span', each.refused, class_='reason')], ' '
  )
  if not each.slots:
    return [time, _NONE, _NONE, said, *[_NONE] * 4]
  angle_deg, away_m = each.view_angle_deg, each.distance_m
  return [
    time,
    f'{each.slots[0].begin_s:.2f}',
    markup.join([_chip(slot) for slot in each.slots], ' '),
    said,
    _NONE if each.clear is None else f'{each.clear:.2f}',
    _NONE if angle_deg is None else f'{angle_deg:.0f}\u00b0',
    _NONE if away_m is None else f'{away_m:.2f}',
    _as_sent(each, sent),
  ]


def _chip(slot: moves.Sent) -> markup.Markup:
  colour = palette.SYMBOLS[slot.symbol]
  return tag(
    'span', slot.mark.label, class_='symbol',
    style=f'background:{colour};color:{palette.ink(colour)}',
  )  # fmt: skip


def _as_sent(each: frames.Frame, sent: Sequence[moves.Sent]) -> str:
  """Whether these symbols were flown at that time, or which were."""
  begin_s, end_s = each.slots[0].begin_s, each.slots[-1].end_s
  flown = [
    one.mark for one in sent
    if begin_s <= (one.begin_s + one.end_s) / 2 <= end_s
  ]  # fmt: skip
  if flown == [slot.mark for slot in each.slots]:
    return '\u2713'
  labels = ' '.join(mark.label for mark in flown)
  return f'\u2717 sent: {labels or "nothing"}'
