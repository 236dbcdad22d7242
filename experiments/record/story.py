"""What an observer's events say about where it is in its frame."""

from collections.abc import Iterable
import dataclasses

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import episode, marks
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import frame, packets
from waggle_tasks.protocol.symbols import BITS, Symbol
from waggle_tasks.tasks import safety

_WAITS_FOR = {
  frame.State.LEAD_NULL: 'first null',
  frame.State.START: 'START',
  frame.State.SEPARATOR: 'null',
  frame.State.END: 'END',
  frame.State.FINAL_NULL: 'final null',
}


_LISTED = 4  # Packets that are told one by one.


@dataclasses.dataclass(frozen=True)
class Reading:
  """How far one observer is.

  Attributes:
    agreement: What both sides know.
    waits_for: What its receiver needs next, such as 'bit 3'; empty for what it
      needs first.
    symbols: The motions of the frame under way, or of the last whole one.
    message: The bits of a whole message, or None.
    deed: What its navigator does: 'flies', 'arrived' or 'refused', or ''.
    collected: What it has of a message in packets; None before the first one.
  """

  agreement: agreement_lib.Agreement = agreement_lib.Agreement()
  waits_for: str = ''
  symbols: tuple[marks.Mark, ...] = ()
  message: str | None = None
  deed: str = ''
  collected: packets.Collector | None = None

  def __post_init__(self) -> None:
    if not self.waits_for:
      first = self._waits_for(frame.State.LEAD_NULL)
      object.__setattr__(self, 'waits_for', first)

  @property
  def status(self) -> str:
    """One line about it."""
    if self.deed:
      return f'{self.deed} {self.message}'
    had = f'{self.parts}, ' if self.parts else ''
    return f'{had}next: {self.waits_for}'

  @property
  def parts(self) -> str:
    """Which packets of a message it has; empty before the first one."""
    if self.collected is None or self.collected.whole is None:
      return ''
    count, has = self.collected.whole.last + 1, len(self.collected.chunks)
    if has == count:
      return 'has all packets' if count > 1 else 'has the packet'
    numbers = [str(number + 1) for number, _ in self.collected.chunks]
    if has > _LISTED:
      return f'has {has} of {count} packets'
    plural = 's' if has > 1 else ''
    return f'has packet{plural} {", ".join(numbers)} of {count}'

  def after(self, event: episode.Event) -> 'Reading':
    """The reading after one more event."""
    if isinstance(event, receiver.Event):
      return self._read(event)
    if isinstance(event, safety.Refusal):
      return dataclasses.replace(self, deed='refused')
    start = event.deed is observer_agent.Deed.START
    return dataclasses.replace(self, deed='flies' if start else 'arrived')

  def _read(self, event: receiver.Event) -> 'Reading':
    if event.word is not None:
      return self._whole(event, event.word)
    symbols = self.symbols
    ended = event.rejection is not None or event.state is frame.State.START
    confirmed = self.waits_for == _WAITS_FOR[frame.State.FINAL_NULL]
    if event.rejection is None and confirmed:
      ended = False  # It stays to be seen, whole as it is.
    if event.symbol is Symbol.START or (ended and event.message is None):
      symbols = ()  # A frame can only begin anew.
    begun = event.rejection is None or event.state is frame.State.SEPARATOR
    if event.symbol is not Symbol.NULL and begun:
      symbols = (*symbols, marks.of(event.symbol))
    count = sum(mark.symbol in BITS for mark in symbols)
    waits_for = self._waits_for(event.state, f'bit {count + 1}')
    if event.symbol is Symbol.START and event.recognition is None and begun:
      waits_for = _WAITS_FOR[frame.State.END]  # All is read with it.
    message = event.message.bits if event.message else self.message
    return dataclasses.replace(
      self, waits_for=waits_for, symbols=symbols, message=message
    )

  def _waits_for(self, state: frame.State, other: str = '') -> str:
    """What a receiver needs in a state."""
    if state is frame.State.LEAD_NULL and self.agreement.language is not None:
      state = frame.State.START  # Only the paper's frames begin with a null.
    return _WAITS_FOR.get(state, other)

  def _whole(self, event: receiver.Event, word: tuple[int, ...]) -> 'Reading':
    """After a frame that was read as a whole."""
    between = marks.of_word(word, self.agreement)
    start, end = marks.of(Symbol.START), marks.of(event.symbol)
    collected, said = self.collected, bits(word, self.agreement)
    if self.agreement.packets and said and event.rejection is None:
      collected = collected or packets.Collector(self.agreement.packets)
      collected = collected.add(said)
    return dataclasses.replace(
      self,
      waits_for=self._waits_for(event.state, self.waits_for),
      symbols=(start, *between, end),
      collected=collected,
    )


def bits(
  word: tuple[int, ...] | None, agreement: agreement_lib.Agreement
) -> str | None:
  """The bits of a frame's word; None if it is no frame's."""
  if word is None:
    return None
  size = agreement.spoken.alphabet.size
  return agreement.coding.judge(word, agreement.frame_bits, size)[1]


def readings(
  events: Iterable[episode.Event],
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
) -> list[tuple[float, Reading]]:
  """Each time at which a reading changed, and the new reading."""
  reading, out = Reading(agreement), []
  for event in events:
    reading = reading.after(event)
    out.append((event.time_s, reading))
  return out
