"""Frames that were read as a whole: each symbol in the time of its slot."""

from collections.abc import Iterable
import dataclasses

from waggle_tasks.agents import receiver
from waggle_tasks.experiments.record import episode, marks, moves, story
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import packets
from waggle_tasks.protocol.symbols import Symbol

_TOLD = 3  # Frames that are told one by one.


@dataclasses.dataclass(frozen=True)
class Frame:
  """A frame as a receiver read it, or why it refused one.

  Attributes:
    time_s: When it did.
    slots: START, the symbols that were read, and END, each when it was flown
      by the clock of the language; empty without a word.
    says: What the word says, such as 'packet 2 of 3'; empty if it is not known.
    refused: Why the frame is none; empty if it is one.
    clear: How much nearer the word was than any other, as a share of how far
      apart they are; None if that was not told, as of the two below.
    view_angle_deg: From where it was seen.
    distance_m: From how far.
  """

  time_s: float
  slots: tuple[moves.Sent, ...]
  says: str
  refused: str
  clear: float | None
  view_angle_deg: float | None
  distance_m: float | None

  @property
  def summary(self) -> str:
    """What it says and how clear it is, in a line."""
    clear = '' if self.clear is None else f'clear {self.clear:.2f}'
    return ', '.join(filter(None, [clear, self.says, self.refused]))

  @property
  def words(self) -> str:
    """All of it in a line."""
    parts = [self.word, self.says]
    if self.clear is not None:
      parts.append(f'clear {self.clear:.2f}')
    if self.view_angle_deg is not None:
      parts.append(f'from {self.view_angle_deg:.0f} degrees')
    if self.distance_m is not None:
      parts.append(f'{self.distance_m:.2f} m away')
    return ', '.join(filter(None, [*parts, self.refused]))

  @property
  def word(self) -> str:
    """What was read between START and END."""
    return ' '.join(each.mark.label for each in self.slots[1:-1])


def opens(event: episode.Event) -> bool:
  """Whether what follows an event is read as a whole."""
  return (
    isinstance(event, receiver.Event)
    and event.symbol is Symbol.START
    and event.recognition is None
  )


def is_whole(event: episode.Event) -> bool:
  """Whether an event tells of a frame that was read as a whole, or refused."""
  if not isinstance(event, receiver.Event):
    return False
  refused = event.recognition is None and event.rejection is not None
  return event.word is not None or (refused and event.symbol is Symbol.UNKNOWN)


def read(
  events: Iterable[episode.Event], agreement: agreement_lib.Agreement
) -> tuple[Frame, ...]:
  """Every frame that an observer read as a whole, or refused.

  Args:
    events: What it saw and did.
    agreement: What both sides know.
  """
  return tuple(
    _frame(event, agreement)
    for event in events
    if isinstance(event, receiver.Event) and is_whole(event)
  )


def lines(
  events: Iterable[episode.Event], agreement: agreement_lib.Agreement
) -> list[str]:
  """What an observer read of frames in few lines; none if by motions.

  Args:
    events: What it saw and did.
    agreement: What both sides know.
  """
  found = [each for each in read(events, agreement) if each.slots]
  if len(found) <= _TOLD:
    return [f'{each.time_s:.2f} s: {each.words}' for each in found]
  clear = [each.clear for each in found if each.clear is not None]
  least = f', clear {min(clear):.2f} and more' if clear else ''
  return [f'{len(found)} frames to {found[-1].time_s:.2f} s{least}']


def _frame(event: receiver.Event, agreement: agreement_lib.Agreement) -> Frame:
  slots: tuple[moves.Sent, ...] = ()
  if event.word is not None:
    language = agreement.spoken
    flown = language.fly([(Symbol.START, *event.word, Symbol.END)])
    names = marks.of(Symbol.START), *marks.of_word(event.word, agreement)
    # It is read when the rest after it is over.
    begin_s = event.time_s - flown[-1].end_s - language.confirm_s
    slots = tuple(
      moves.Sent(mark, slot.begin_s + begin_s, slot.end_s + begin_s)
      for mark, slot in zip([*names, marks.of(Symbol.END)], flown, strict=True)
    )
  return Frame(
    event.time_s, slots, says(event.word, agreement), event.rejection or '',
    event.clear, event.view_angle_deg, event.distance_m,
  )  # fmt: skip


def says(
  word: tuple[int, ...] | None, agreement: agreement_lib.Agreement
) -> str:
  """What a word says, in words; empty for one that is no frame's."""
  bits = story.bits(word, agreement)
  if bits is None:
    return ''
  if agreement.packets is None:
    return f'payload {bits}'
  parsed = agreement.packets.parse(bits)
  return '' if parsed is None else packet(parsed[0], parsed[1])


def packet(number: int, whole: packets.Whole) -> str:
  """Which packet of a message it is, counted from 1."""
  return f'packet {number + 1} of {whole.last + 1}'
