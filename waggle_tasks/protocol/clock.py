"""The clock that both sides agree on: when the motions of a message come.

The codebook says how long each gesture lasts and the pauses say how long the
rests between them are, so the first motion of a message tells when all others
come. A receiver sees motions begin and end a little late, its clock may run at
another pace, and images may be late: that is what a tolerance stands for.
"""

from collections.abc import Sequence
import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import checks, gestures, timing
from waggle_tasks.protocol.symbols import Symbol

# Of a gesture; to be away for less does not make one.
_TELLING = 0.75
# Of a gesture, what is seen at least: from the side it hardly leaves its rest.
_LEAST = 0.7


class ClockError(errors.WaggleError):
  """A tolerance that is none."""


@dataclasses.dataclass(frozen=True)
class Tolerance:
  """How far from its time a motion may be seen.

  Attributes:
    clock_rate: By what share the paces of two clocks may differ, 0 to 0.2.
    clock_delay_s: How much later, or earlier, one motion may be noticed than
      another one, 0 to 10 s.
  """

  clock_rate: float = 0.02
  clock_delay_s: float = 0.6

  def __post_init__(self) -> None:
    bounds = {'clock_rate': (0.0, 0.2), 'clock_delay_s': (0.0, 10.0)}
    checks.settle_numbers(self, bounds, ClockError)

  def allowed_s(self, elapsed_s: float) -> float:
    """How much a time that should be `elapsed_s` may be off."""
    return self.clock_rate * elapsed_s + self.clock_delay_s


@dataclasses.dataclass(frozen=True)
class Moment:
  """When an event was seen.

  Attributes:
    begin_s: When the motion began, or the rest.
    end_s: When it was over; of a rest, when it was long enough.
    unseen_s: The longest time, since the event before, for which the target
      was not seen; infinity when it was given up and sought anew.
    unseen_from_s: When that began.
  """

  begin_s: float
  end_s: float
  unseen_s: float = 0.0
  unseen_from_s: float = 0.0

  @property
  def middle_s(self) -> float:
    """Half way."""
    return (self.begin_s + self.end_s) / 2


@dataclasses.dataclass(frozen=True)
class Clock:
  """When motions come.

  Attributes:
    codebook: The agreed gestures, with their durations.
    pauses: The agreed pauses.
    tolerance: How far from its time a motion may be seen.
  """

  codebook: gestures.Codebook
  pauses: timing.Timing
  tolerance: Tolerance = Tolerance()

  @property
  def blind_s(self) -> float:
    """The longest time without sight in which no gesture can be hidden.

    A shorter loss hides no way out and back, as the shortest gesture is away
    from its rest for longer.
    """
    shortest_s = min(each.duration_s for each in self.codebook.gestures)
    return _TELLING * shortest_s

  @property
  def least_s(self) -> float:
    """How long the shortest gesture is seen to last at least."""
    shortest_s = min(each.duration_s for each in self.codebook.gestures)
    return _LEAST * (1 - self.tolerance.clock_rate) * shortest_s

  def motion(
    self,
    symbol: Symbol,
    now: Moment,
    before: Sequence[Symbol] = (),
    moments: Sequence[Moment] = (),
  ) -> str:
    """Why a motion did not come in its time; empty when it did.

    Args:
      symbol: What it is.
      now: When it was.
      before: The motions of the frame before it; the first is START.
      moments: When they were.
    """
    reason = self._duration(symbol, now)
    if reason or not before:
      return reason
    lasts_s = [self.codebook[each].duration_s for each in (*before, symbol)]
    # From middle to middle, as slow beginnings and ends are hardly seen.
    last_s = sum(lasts_s[-2:]) / 2 + self.pauses.pause_s
    first_s = sum(lasts_s) - (lasts_s[0] + lasts_s[-1]) / 2
    first_s += self.pauses.pause_s * len(before)
    return self._distance(
      symbol, now, before[-1], moments[-1], last_s
    ) or self._distance(symbol, now, before[0], moments[0], first_s)

  def _distance(
    self,
    symbol: Symbol,
    now: Moment,
    earlier: Symbol,
    then: Moment,
    agreed_s: float,
  ) -> str:
    allowed_s = self.tolerance.allowed_s(agreed_s)
    elapsed_s = now.middle_s - then.middle_s
    if abs(elapsed_s - agreed_s) <= allowed_s:
      return ''
    return (
      f'{symbol} must come {agreed_s:.1f} s after {earlier}, within'
      f' {allowed_s:.1f} s: it came {elapsed_s:.1f} s after it'
    )

  def _duration(self, symbol: Symbol, now: Moment) -> str:
    lasts_s = self.codebook[symbol].duration_s
    lasted_s = now.end_s - now.begin_s
    allowed_s = self.tolerance.allowed_s(lasts_s)
    least_s, most_s = _LEAST * lasts_s - allowed_s, lasts_s + allowed_s
    if least_s <= lasted_s <= most_s:
      return ''
    return (
      f'{symbol} must last {max(least_s, 0):.1f} to {most_s:.1f} s: it lasted'
      f' {lasted_s:.1f} s'
    )

  def final_null(self, end: Moment, null: Moment) -> str:
    """Why a rest after END confirms nothing; empty when it does.

    What was hidden until it was confirmed could have been another motion once
    a pause and a gesture have passed.

    Args:
      end: When END was.
      null: When the rest was.
    """
    shortest_s = min(each.duration_s for each in self.codebook.gestures)
    limit_s = self.pauses.pause_s + shortest_s
    allowed_s = limit_s + self.tolerance.allowed_s(limit_s)
    waited_s = null.end_s - end.end_s
    if waited_s <= allowed_s:
      return ''
    return (
      f'the final null must come within {allowed_s:.1f} s after END: it came'
      f' after {waited_s:.1f} s'
    )

  def unseen(self, moment: Moment) -> str:
    """Why what was not seen before an event breaks a frame; or empty."""
    if moment.unseen_s <= self.blind_s:
      return ''
    if math.isinf(moment.unseen_s):
      return 'the target was given up and sought anew'
    return (
      f'nothing was seen for {moment.unseen_s:.1f} s from'
      f' {moment.unseen_from_s:.1f} s on, which can hide a gesture (more than'
      f' {self.blind_s:.1f} s)'
    )
