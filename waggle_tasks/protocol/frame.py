"""The frame, of 17 events in the paper, and the parser of whole ones alone."""

import dataclasses
import enum

from waggle_tasks import errors
from waggle_tasks.protocol import checks
from waggle_tasks.protocol import clock as clock_lib
from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.protocol.symbols import BITS, Symbol


class FrameError(errors.WaggleError):
  """A rule of frames that is neither kept nor dropped."""


def motions(payload: payload_lib.Payload) -> tuple[Symbol, ...]:
  """The motion symbols of a message: START, its bits, END."""
  bits = tuple(Symbol(bit) for bit in payload.bits)
  return (Symbol.START, *bits, Symbol.END)


def events(payload: payload_lib.Payload) -> tuple[Symbol, ...]:
  """The visual events of a message: 8 motions between 9 nulls for six bits."""
  out = [Symbol.NULL]
  for symbol in motions(payload):
    out += [symbol, Symbol.NULL]
  return tuple(out)


class State(enum.StrEnum):
  """What the parser waits for."""

  LEAD_NULL = 'lead null'
  START = 'start'
  SEPARATOR = 'separator'
  BIT = 'bit'
  END = 'end'
  FINAL_NULL = 'final null'


@dataclasses.dataclass(frozen=True)
class Message:
  """A payload whose whole frame was seen."""

  payload: payload_lib.Payload


@dataclasses.dataclass(frozen=True)
class Rejection:
  """A frame, or the beginning of one, that was given up.

  Attributes:
    reason: What was expected, what came, and how far the frame was.
  """

  reason: str


@dataclasses.dataclass(frozen=True)
class Rules:
  """Which nulls a frame must have, and whether it has a time.

  The null before START and the order of the motions are always demanded.

  Attributes:
    separators: Whether a null must come between two motions; else nulls
      there are passed over, however many.
    final_null: Whether a message is complete with the null after END; else it
      is with END.
    clock: Whether every event must come when the agreed clock lets it, with
      the target in sight; else, as in the paper, order is all that counts.
  """

  separators: bool = True
  final_null: bool = True
  clock: bool = True

  def __post_init__(self) -> None:
    for field in dataclasses.fields(self):
      plain = checks.switch(field.name, getattr(self, field.name), FrameError)
      checks.settle(self, field.name, plain)


@dataclasses.dataclass(frozen=True)
class Parser:
  """A frame parser as a value: `step` returns the next one and an outcome.

  By the paper's rules a message is accepted if and only if the last events, 17
  of them for six bits, are a whole frame (section 'Motion alphabet and message
  framing'). With a clock each of them must also have come in its time, and
  nothing may have been hidden meanwhile.

  Attributes:
    state: What it waits for.
    bits: The bits read since START.
    units: How many bits a payload has.
    rules: Which nulls it demands.
    clock: When motions come; None for a parser that knows order alone.
    moments: With a clock, when the motions since START were.
  """

  state: State = State.LEAD_NULL
  bits: str = ''
  units: payload_lib.Units = payload_lib.Units()
  rules: Rules = Rules()
  clock: clock_lib.Clock | None = None
  moments: tuple[clock_lib.Moment, ...] = ()

  @property
  def begun(self) -> bool:
    """Whether a frame is under way: START was seen, and its end was not."""
    return self.state not in (State.LEAD_NULL, State.START)

  def step(
    self, symbol: Symbol, moment: clock_lib.Moment | None = None
  ) -> tuple['Parser', Message | Rejection | None]:
    """Takes one event.

    Args:
      symbol: Any symbol, UNKNOWN included.
      moment: When it was; only a parser with a clock needs it.

    Returns:
      The next parser, and a Message when the event completes a frame, a
      Rejection when it breaks one, or None.
    """
    if self.clock is None:
      return self._ordered(symbol)
    if moment is None:
      raise TypeError('`moment` must be given to a parser with a clock')
    return self._timed(self.clock, symbol, moment)

  def _timed(
    self, clock: clock_lib.Clock, symbol: Symbol, moment: clock_lib.Moment
  ) -> tuple['Parser', Message | Rejection | None]:
    """Takes an event by its order, if it also came in its time."""
    after, outcome = self._ordered(symbol)
    if isinstance(outcome, Rejection):
      if self.moments and (unseen := clock.unseen(moment)):
        outcome = Rejection(f'{outcome.reason}; {unseen}')
      if symbol is Symbol.START and clock.motion(symbol, moment):
        after = self._at(State.LEAD_NULL)  # It was none, so begins no frame.
      return after._since(symbol, moment), outcome
    if reason := self._untimely(clock, symbol, moment):
      null = symbol is Symbol.NULL
      broken = self._at(State.START if null else State.LEAD_NULL)
      broken = dataclasses.replace(broken, moments=())
      return broken, Rejection(f'{reason}, {self._progress}')
    return after._since(symbol, moment, self.moments), outcome

  def _since(
    self,
    symbol: Symbol,
    moment: clock_lib.Moment,
    before: tuple[clock_lib.Moment, ...] = (),
  ) -> 'Parser':
    """With the moments of all motions since START, of which this may be one."""
    if not self.begun:
      return dataclasses.replace(self, moments=())
    null = symbol is Symbol.NULL
    moments = before if null else (*before, moment)
    return dataclasses.replace(self, moments=moments)

  def _untimely(
    self, clock: clock_lib.Clock, symbol: Symbol, moment: clock_lib.Moment
  ) -> str:
    """Why an event that is in its order is out of its time, or empty."""
    null = symbol is Symbol.NULL
    if not self.moments:  # Nothing before START belongs to the frame.
      return '' if null else clock.motion(symbol, moment)
    if reason := clock.unseen(moment):
      return reason
    if not null:
      before = (Symbol.START, *map(Symbol, self.bits))
      return clock.motion(symbol, moment, before, self.moments)
    if self.state is State.FINAL_NULL:
      return clock.final_null(self.moments[-1], moment)
    return ''

  def _ordered(
    self, symbol: Symbol
  ) -> tuple['Parser', Message | Rejection | None]:
    """Takes an event by its order alone."""
    null = symbol is Symbol.NULL
    match self.state:
      case State.LEAD_NULL if null:
        return self._at(State.START), None
      case State.START if symbol is Symbol.START:
        return self._after_motion(''), None
      case State.START if null:
        return self, None
      case State.SEPARATOR if null:
        return self._at(self._next_motion(self.bits), self.bits), None
      case State.BIT | State.END if null and not self.rules.separators:
        return self, None
      case State.BIT if symbol in BITS:
        return self._after_motion(self.bits + symbol), None
      case State.END if symbol is Symbol.END and self.rules.final_null:
        return self._at(State.FINAL_NULL, self.bits), None
      case State.END if symbol is Symbol.END:
        return self._at(State.LEAD_NULL), self._message()
      case State.FINAL_NULL if null:
        return self._at(State.START), self._message()
    return self._restart(symbol), Rejection(self._reason(symbol))

  def _at(self, state: State, bits: str = '') -> 'Parser':
    return dataclasses.replace(self, state=state, bits=bits)

  def _after_motion(self, bits: str) -> 'Parser':
    """What comes after START or a bit."""
    if self.rules.separators:
      return self._at(State.SEPARATOR, bits)
    return self._at(self._next_motion(bits), bits)

  def _next_motion(self, bits: str) -> State:
    return State.END if len(bits) == self.units.num_bits else State.BIT

  def _message(self) -> Message:
    return Message(payload_lib.Payload.from_bits(self.bits, self.units))

  def _restart(self, symbol: Symbol) -> 'Parser':
    """Where the next frame can begin, given the event that broke this one.

    A START can begin it after a null; without separators, also right after
    START or a bit of the frame that it breaks.
    """
    if symbol is Symbol.NULL:
      return self._at(State.START)
    null_came_before = self.state in (State.START, State.BIT, State.END)
    if symbol is Symbol.START and null_came_before:
      return self._after_motion('')
    return self._at(State.LEAD_NULL)

  def _reason(self, symbol: Symbol) -> str:
    expected = {
      State.LEAD_NULL: 'a null before START',
      State.START: 'START',
      State.SEPARATOR: 'a separating null',
      State.BIT: 'a bit',
      State.END: 'END',
      State.FINAL_NULL: 'the final null',
    }[self.state]
    return f'expected {expected}, got {symbol}, {self._progress}'

  @property
  def _progress(self) -> str:
    return f'after {len(self.bits)} of {self.units.num_bits} bits'
