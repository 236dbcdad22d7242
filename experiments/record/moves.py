"""What is flown, each symbol in its time."""

from collections.abc import Iterable
import dataclasses

from waggle_tasks.experiments.record import marks
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.protocol.symbols import Symbol


@dataclasses.dataclass(frozen=True)
class Sent:
  """A symbol that was flown, whole or cut short.

  Attributes:
    mark: What it stands for.
    begin_s: When it began.
    end_s: When it ended, or was stopped.
    part: Which part of the message it belongs to, such as 'packet 2 of 3,
      round 1 of 2'; empty where all is said in one frame.
  """

  mark: marks.Mark
  begin_s: float
  end_s: float
  part: str = ''

  @property
  def symbol(self) -> Symbol:
    """What it is, without its number."""
    return self.mark.symbol

  @property
  def words(self) -> str:
    """What it is and where it belongs."""
    return f'{self.mark.words} ({self.part})' if self.part else self.mark.words


def sent(
  performance: performance_lib.Performance,
  agreement: agreement_lib.Agreement,
  episode_s: float,
) -> tuple[Sent, ...]:
  """What a performer flies, until it or the episode ends.

  Args:
    performance: What it would fly.
    agreement: What both sides know.
    episode_s: When the episode ends.
  """
  stop_s = min(performance.end_s, episode_s)
  slots = performance.schedule.slots
  parts = _parts(performance, agreement)
  return tuple(
    Sent(
      marks.of_path(slot.gesture, agreement), slot.begin_s,
      min(slot.end_s, stop_s), part,
    )
    for slot, part in zip(slots, parts, strict=True)
    if slot.begin_s < stop_s
  )  # fmt: skip


def _parts(
  performance: performance_lib.Performance, agreement: agreement_lib.Agreement
) -> list[str]:
  """Of each slot, which packet it belongs to, and which round."""
  symbols = [each.gesture.symbol for each in performance.schedule.slots]
  if performance.says is None:
    return [''] * len(symbols)
  of_round, cut = 1, agreement.packets
  if cut is not None:
    of_round = len(cut.split(performance.says.bits))
  rounds = symbols.count(Symbol.START) // of_round
  out, number = [], -1
  for symbol in symbols:
    number += symbol is Symbol.START
    turn, place = divmod(number, of_round)
    told = [('packet', place, of_round), ('round', turn, rounds)]
    out.append(
      ', '.join(f'{w} {k + 1} of {count}' for w, k, count in told if count > 1)
    )
  return out


def sent_at(flown: Iterable[Sent], time_s: float) -> Sent | None:
  """What is flown at a time; None while hovering."""
  for each in flown:
    if each.begin_s <= time_s < each.end_s:
      return each
  return None
