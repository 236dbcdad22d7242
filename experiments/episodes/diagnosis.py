"""Where reading failed, as far as a receiver's own events tell."""

from collections.abc import Sequence
import itertools

from waggle_tasks import scenario
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.record import episode, frames, moves
from waggle_tasks.protocol.symbols import Symbol

# How late a receiver may be to take a motion for START, or to refuse a frame.
_LATE_S = 0.75


def diagnose(scene: scenario.Scenario, events: Sequence[episode.Event]) -> str:
  """Where reading failed: the first motion or frame that was not understood.

  Args:
    scene: The scenario.
    events: What an observer saw and did, without a message.
  """
  seen = [e for e in events if isinstance(e, receiver.Event)]
  if scene.agreement.language is not None:
    return _whole(scene, seen)
  if not seen:
    return 'no null was ever confirmed'
  for number, event in enumerate(seen):
    if event.symbol == 'UNKNOWN':
      motions = sum(e.symbol != 'NULL' for e in seen[: number + 1])
      if event.recognition is None and frames.is_whole(event):
        return f'the frame was refused at {event.time_s:.2f} s: {_why(event)}'
      return f'motion {motions} unknown: {_why(event)}'
  for event in seen:
    if event.rejection is not None:
      return event.rejection
  return f'still waited for {seen[-1].state} at the end'


def _why(event: receiver.Event) -> str:
  """Why something was not understood."""
  if event.recognition is not None:
    return event.recognition.reason
  return event.rejection or 'no scores'


def _whole(scene: scenario.Scenario, seen: Sequence[receiver.Event]) -> str:
  """The first part of a message that was read in no round."""
  agreed = scene.agreement
  lost: dict[str, list[str]] = {}
  for part, sent in _frames(scene):
    end_s = sent[-1].end_s + agreed.spoken.confirm_s
    during = [
      e for e in seen
      if sent[0].begin_s < e.time_s <= end_s + _LATE_S + agreed.frame_s
    ]  # fmt: skip
    lost.setdefault(part, []).append(_fate(sent, during))
  for part, fates in lost.items():
    if all(fates):
      first = f'{part}: {fates[0]}' if part else fates[0]
      again = f', and in none of {len(fates)} rounds' if len(fates) > 1 else ''
      return first + again
  return 'all of it was read, and its parts make no message'


def _frames(
  scene: scenario.Scenario,
) -> list[tuple[str, list[moves.Sent]]]:
  """Each frame that was sent, with the packet that it is; see `moves.Sent`."""
  sent = moves.sent(scene.performance, scene.agreement, scene.episode_s)
  count = itertools.accumulate(each.symbol is Symbol.START for each in sent)
  grouped: dict[int, list[moves.Sent]] = {}
  for number, each in zip(count, sent, strict=True):
    grouped.setdefault(number, []).append(each)
  return [
    (own[0].part.partition(', ')[0] if 'packet' in own[0].part else '', own)
    for own in grouped.values()
  ]


def _fate(sent: Sequence[moves.Sent], during: Sequence[receiver.Event]) -> str:
  """Why a frame was not read; empty if it was.

  Args:
    sent: What was flown.
    during: What was seen meanwhile, and soon after.
  """
  end_s = sent[-1].end_s
  over = [e for e in during if e.time_s >= end_s]
  if any(e.word is not None and e.rejection is None for e in over):
    return ''
  begun = any(
    e.symbol is Symbol.START and 0 <= e.time_s - sent[0].end_s <= _LATE_S
    for e in during
  )
  if not begun:
    return f'START, flown at {sent[0].begin_s:.2f} s, was never seen'
  refused = [e for e in over if e.rejection]
  if not refused:
    return f'START was seen, and of the rest nothing was made by {end_s:.2f} s'
  # Other motions may have been taken for a START; its frame is due at its end.
  first = refused[0]
  return f'the frame was refused at {first.time_s:.2f} s: {_why(first)}'
