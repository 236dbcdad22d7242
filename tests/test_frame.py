"""The 17-event frame: only a whole one is ever a message."""

from collections.abc import Iterable, Sequence

import hypothesis
from hypothesis import strategies as st
import pytest

from waggle_tasks.protocol import frame, payload
from waggle_tasks.protocol.symbols import Symbol

NULL, START, END = Symbol.NULL, Symbol.START, Symbol.END
ZERO, ONE, UNKNOWN = Symbol.ZERO, Symbol.ONE, Symbol.UNKNOWN

# A frame's events by their position; the odd ones between 3 and 13 are bits.
FRAME = [{NULL}, {START}] + [{NULL}, {ZERO, ONE}] * 6 + [{NULL}, {END}, {NULL}]
STATES = [frame.State.LEAD_NULL, frame.State.START]
STATES += [frame.State.SEPARATOR, frame.State.BIT] * 6
STATES += [frame.State.SEPARATOR, frame.State.END, frame.State.FINAL_NULL]


def is_beginning(events: Sequence[Symbol]) -> bool:
  """Whether the events are the first ones of some frame."""
  return all(
    event in allowed for event, allowed in zip(events, FRAME, strict=False)
  )


def matched(events: Sequence[Symbol]) -> int:
  """How many of the last events, at most 16, can begin a frame."""
  for count in range(min(len(events), 16), 0, -1):
    if is_beginning(events[-count:]):
      return count
  return 0


def is_whole(events: Sequence[Symbol]) -> bool:
  return len(events) == 17 and is_beginning(events)


def run(
  events: Iterable[Symbol],
) -> tuple[frame.Parser, list[frame.Message | frame.Rejection | None]]:
  """The parser after all events, and the outcome of each."""
  parser, outcomes = frame.Parser(), []
  for event in events:
    parser, outcome = parser.step(event)
    outcomes.append(outcome)
  return parser, outcomes


def messages(events: Iterable[Symbol]) -> list[str]:
  return [
    outcome.payload.bits
    for outcome in run(events)[1]
    if isinstance(outcome, frame.Message)
  ]


def whole(bits: str) -> list[Symbol]:
  motions = [START, *map(Symbol, bits), END]
  return [NULL, *(event for motion in motions for event in (motion, NULL))]


def reasons(events: Iterable[Symbol]) -> list[str]:
  return [
    outcome.reason
    for outcome in run(events)[1]
    if isinstance(outcome, frame.Rejection)
  ]


def test_the_papers_example_is_its_seventeen_events() -> None:
  text = 'NULL START NULL 0 NULL 0 NULL 0 NULL 0 NULL 1 NULL 0 NULL END NULL'
  assert ' '.join(whole('000010')) == text
  assert len(whole('000010')) == 17
  assert whole('000010').count(NULL) == 9
  motions = frame.motions(payload.Payload.from_bits('000010'))
  assert ' '.join(motions) == 'START 0 0 0 0 1 0 END'


@pytest.mark.parametrize('value', range(64))
def test_every_payload_is_accepted_with_its_final_null_and_not_before(
  value: int,
) -> None:
  bits = f'{value:06b}'
  parser, outcomes = run(whole(bits))
  assert outcomes[:-1] == [None] * 16
  assert outcomes[-1] == frame.Message(payload.Payload.from_int(value))
  assert parser.state is frame.State.START


# Whole frames and pieces of them are rare among random events, so they are
# put in and then damaged.
SYMBOLS = st.sampled_from([*Symbol])
BITS = st.text('01', min_size=6, max_size=6)


@pytest.mark.parametrize(
  'units',
  [
    payload.Units(heading_bits=1, distance_bits=1),
    payload.Units(heading_bits=6, distance_bits=5),
  ],
)
def test_a_frame_has_the_agreed_number_of_bits(units: payload.Units) -> None:
  message = payload.Payload.from_int(2**units.num_bits - 2, units)
  parser, read = frame.Parser(units=units), []
  for bits in ('000010', message.bits, message.bits + '0'):
    for event in whole(bits):
      parser, outcome = parser.step(event)
      if isinstance(outcome, frame.Message):
        read.append(outcome.payload)
  assert read == [message]
  assert len(frame.events(message)) == 2 * (units.num_bits + 2) + 1


@st.composite
def damaged(draw: st.DrawFn) -> list[Symbol]:
  """A whole frame after up to three mutations."""
  events = whole(draw(BITS))
  for _ in range(draw(st.integers(0, 3))):
    place = draw(st.integers(0, max(len(events) - 1, 0)))
    kinds = ['drop', 'repeat', 'insert', 'replace', 'swap', 'cut']
    match draw(st.sampled_from(kinds)):
      case 'drop':
        del events[place : place + 1]
      case 'replace':
        events[place : place + 1] = [draw(SYMBOLS)]
      case 'repeat':
        events[place:place] = events[place : place + 1]
      case 'insert':
        events.insert(place, draw(SYMBOLS))
      case 'swap':
        events[place : place + 2] = events[place : place + 2][::-1]
      case 'cut':
        del events[place:]
  return events


PIECES = st.one_of(damaged(), st.lists(SYMBOLS, max_size=8), BITS.map(whole))
SEQUENCES = st.lists(PIECES, min_size=1, max_size=4).map(
  lambda pieces: [event for piece in pieces for event in piece]
)


@hypothesis.settings(max_examples=200)
@hypothesis.given(SEQUENCES)
def test_a_message_is_accepted_iff_the_last_17_events_are_a_whole_frame(
  events: list[Symbol],
) -> None:
  _, outcomes = run(events)
  for count, outcome in enumerate(outcomes, 1):
    last = events[max(count - 17, 0) : count]
    assert isinstance(outcome, frame.Message) == is_whole(last)
    if is_whole(last):
      assert outcome.payload.bits == ''.join(last[3:15:2])


@hypothesis.settings(max_examples=200)
@hypothesis.given(SEQUENCES)
def test_each_break_has_a_reason_and_nothing_else_has(
  events: list[Symbol],
) -> None:
  parser = frame.Parser()
  for count, event in enumerate(events):
    before, after = matched(events[:count]), matched(events[: count + 1])
    assert parser.state is STATES[before]
    parser, outcome = parser.step(event)
    assert parser.state is STATES[after]
    accepted = isinstance(outcome, frame.Message)
    goes_on = after == before + 1 or accepted
    rests = (before, event) == (1, NULL)  # Stillness may last.
    assert isinstance(outcome, frame.Rejection) == (not goes_on and not rests)
    if isinstance(outcome, frame.Rejection):
      assert f', got {event}, after ' in outcome.reason


@hypothesis.settings(max_examples=100)
@hypothesis.given(SEQUENCES, BITS)
def test_whatever_came_before_a_whole_frame_is_read(
  events: list[Symbol], bits: str
) -> None:
  assert messages(events + whole(bits))[-1] == bits


@pytest.mark.parametrize('place', range(17))
def test_a_frame_with_one_event_missing_is_no_message(place: int) -> None:
  events = whole('011010')
  del events[place]
  assert messages(events) == []


@pytest.mark.parametrize('place', range(1, 17))
def test_a_frame_with_one_event_twice_is_no_message(place: int) -> None:
  events = whole('011010')
  events.insert(place, events[place])
  # The second of two final nulls comes after the message, and before the next.
  assert messages(events) == (['011010'] if place == 16 else [])


@pytest.mark.parametrize('place', range(17))
def test_a_frame_with_one_unknown_event_is_no_message(place: int) -> None:
  events = whole('011010')
  events[place] = UNKNOWN
  assert messages(events) == []


@pytest.mark.parametrize(
  ('events', 'reason'),
  [
    ([START], 'expected a null before START, got START, after 0 of 6 bits'),
    ([NULL, ZERO], 'expected START, got 0, after 0 of 6 bits'),
    ([NULL, END, NULL], 'expected START, got END, after 0 of 6 bits'),
    ([NULL, START, ZERO], 'expected a separating null, got 0, after 0 of 6'),
    (
      [NULL, START, NULL, ONE, ZERO],
      'expected a separating null, got 0, after 1 of 6 bits',
    ),
    (
      [NULL, START, NULL, UNKNOWN],
      'expected a bit, got UNKNOWN, after 0 of 6 bits',
    ),
    (
      [NULL, START, NULL, ONE, NULL, END],
      'expected a bit, got END, after 1 of 6 bits',
    ),
    (
      [NULL, START] + [NULL, ONE] * 6 + [NULL, ZERO],
      'expected END, got 0, after 6 of 6 bits',
    ),
    (
      [NULL, START] + [NULL, ONE] * 6 + [NULL, END, END],
      'expected the final null, got END, after 6 of 6 bits',
    ),
  ],
)
def test_a_rejection_tells_what_came_and_what_was_expected(
  events: list[Symbol], reason: str
) -> None:
  assert messages(events) == []
  assert reasons(events)[0].startswith(reason)


def test_an_end_waits_for_its_final_null() -> None:
  parser, outcomes = run(whole('110001')[:-1])
  assert parser.state is frame.State.FINAL_NULL
  assert outcomes == [None] * 16


def test_an_end_alone_is_never_a_message() -> None:
  assert messages([NULL, END, NULL, NULL, END, NULL]) == []


def test_one_null_ends_a_frame_and_begins_the_next() -> None:
  assert messages(whole('000010') + whole('111111')[1:]) == ['000010', '111111']


def test_a_new_start_begins_a_new_frame() -> None:
  events = [NULL, START, NULL, ONE, *whole('000110')]
  assert messages(events) == ['000110']
  assert len(reasons([*events[:5], START])) == 1


@pytest.mark.parametrize('read', range(1, 17, 2))
def test_a_start_after_any_null_begins_anew(read: int) -> None:
  begun = whole('111111')[:read]
  assert begun[-1] is NULL
  assert messages(begun + whole('000110')[1:]) == ['000110']


def test_a_parser_is_a_value() -> None:
  parser, _ = run(whole('000010')[:8])
  assert parser.step(ONE) == parser.step(ONE)
  assert parser == run(whole('000010')[:8])[0]
