"""The 17-event frame and the state machine that accepts only whole ones."""

import dataclasses
import enum

from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.protocol.symbols import BITS, Symbol


def motions(payload: payload_lib.Payload) -> tuple[Symbol, ...]:
  """The eight motion symbols of a message: START, six bits, END."""
  bits = tuple(Symbol(bit) for bit in payload.bits)
  return (Symbol.START, *bits, Symbol.END)


def events(payload: payload_lib.Payload) -> tuple[Symbol, ...]:
  """The 17 visual events of a message: 8 motions between 9 nulls."""
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
class Parser:
  """A frame parser as a value: `step` returns the next one and an outcome.

  A message is accepted if and only if the last 17 events are a whole frame
  (paper, section 'Motion alphabet and message framing').

  Attributes:
    state: What it waits for.
    bits: The bits read since START.
  """

  state: State = State.LEAD_NULL
  bits: str = ''

  def step(self, symbol: Symbol) -> tuple['Parser', Message | Rejection | None]:
    """Takes one event.

    Args:
      symbol: Any symbol, UNKNOWN included.

    Returns:
      The next parser, and a Message when the event completes a frame, a
      Rejection when it breaks one, or None.
    """
    null = symbol is Symbol.NULL
    match self.state:
      case State.LEAD_NULL if null:
        return Parser(State.START), None
      case State.START if symbol is Symbol.START:
        return Parser(State.SEPARATOR), None
      case State.START if null:
        return self, None
      case State.SEPARATOR if null:
        whole = len(self.bits) == payload_lib.NUM_BITS
        return Parser(State.END if whole else State.BIT, self.bits), None
      case State.BIT if symbol in BITS:
        return Parser(State.SEPARATOR, self.bits + symbol), None
      case State.END if symbol is Symbol.END:
        return Parser(State.FINAL_NULL, self.bits), None
      case State.FINAL_NULL if null:
        payload = payload_lib.Payload.from_bits(self.bits)
        return Parser(State.START), Message(payload)
    return self._restart(symbol), Rejection(self._reason(symbol))

  def _restart(self, symbol: Symbol) -> 'Parser':
    """Where the next frame can begin, given the event that broke this one."""
    if symbol is Symbol.NULL:
      return Parser(State.START)
    null_came_before = self.state in (State.START, State.BIT, State.END)
    if symbol is Symbol.START and null_came_before:
      return Parser(State.SEPARATOR)
    return Parser()

  def _reason(self, symbol: Symbol) -> str:
    expected = {
      State.LEAD_NULL: 'a null before START',
      State.START: 'START',
      State.SEPARATOR: 'a separating null',
      State.BIT: 'a bit',
      State.END: 'END',
      State.FINAL_NULL: 'the final null',
    }[self.state]
    return (
      f'expected {expected}, got {symbol}, after'
      f' {len(self.bits)} of {payload_lib.NUM_BITS} bits'
    )
