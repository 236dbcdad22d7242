"""What an observer's events say about where it is in its frame."""

from collections.abc import Iterable
import dataclasses

from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import episode
from waggle_tasks.protocol import frame
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.protocol.symbols import BITS, Symbol
from waggle_tasks.tasks import safety

_WAITS_FOR = {
  frame.State.LEAD_NULL: 'first null',
  frame.State.START: 'START',
  frame.State.SEPARATOR: 'null',
  frame.State.END: 'END',
  frame.State.FINAL_NULL: 'final null',
}


@dataclasses.dataclass(frozen=True)
class Reading:
  """How far one observer is.

  Attributes:
    waits_for: What its frame parser needs next, such as 'bit 3'.
    symbols: The motions of the frame under way, or of the whole one.
    message: The bits of a whole frame, or None.
    deed: What its navigator does: 'flies', 'arrived' or 'refused', or ''.
  """

  waits_for: str = _WAITS_FOR[frame.State.LEAD_NULL]
  symbols: tuple[Symbol, ...] = ()
  message: str | None = None
  deed: str = ''

  @property
  def status(self) -> str:
    """One line about it."""
    if self.deed:
      return f'{self.deed} {self.message}'
    return f'next: {self.waits_for}'

  def after(self, event: episode.Event) -> 'Reading':
    """The reading after one more event."""
    if isinstance(event, receiver.Event):
      return self._read(event)
    if isinstance(event, safety.Refusal):
      return dataclasses.replace(self, deed='refused')
    start = event.deed is observer_agent.Deed.START
    return dataclasses.replace(self, deed='flies' if start else 'arrived')

  def _read(self, event: receiver.Event) -> 'Reading':
    symbols = self.symbols
    ended = event.rejection is not None or event.state is frame.State.START
    if ended and event.message is None:
      symbols = ()  # A frame can only begin anew.
    begun = event.rejection is None or event.state is frame.State.SEPARATOR
    if event.symbol is not Symbol.NULL and begun:
      symbols = (*symbols, event.symbol)
    bits = sum(symbol in BITS for symbol in symbols)
    waits_for = _WAITS_FOR.get(event.state, f'bit {bits + 1}')
    message = event.message.bits if event.message else None
    return Reading(waits_for, symbols, message or self.message, self.deed)


def readings(
  events: Iterable[episode.Event],
) -> list[tuple[float, Reading]]:
  """Each time at which a reading changed, and the new reading."""
  reading, out = Reading(), []
  for event in events:
    reading = reading.after(event)
    out.append((event.time_s, reading))
  return out


@dataclasses.dataclass(frozen=True)
class Sent:
  """A gesture that the performer flew, whole or cut short.

  Attributes:
    symbol: What it stands for.
    begin_s: When it began.
    end_s: When it ended, or was stopped.
  """

  symbol: Symbol
  begin_s: float
  end_s: float


def sent(
  performance: performance_lib.Performance, episode_s: float
) -> tuple[Sent, ...]:
  """What a performer flies, until it or the episode ends.

  Args:
    performance: What it would fly.
    episode_s: When the episode ends.
  """
  stop_s = min(performance.end_s, episode_s)
  return tuple(
    Sent(slot.gesture.symbol, slot.begin_s, min(slot.end_s, stop_s))
    for slot in performance.schedule.slots
    if slot.begin_s < stop_s
  )


def symbol_at(gestures: Iterable[Sent], time_s: float) -> Symbol:
  """What is flown at a time; NULL while hovering."""
  for each in gestures:
    if each.begin_s <= time_s < each.end_s:
      return each.symbol
  return Symbol.NULL
