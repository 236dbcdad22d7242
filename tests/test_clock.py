"""A frame has time: only what came when it had to, and was seen, is read."""

from collections.abc import Iterable, Sequence
import dataclasses
import math

import hypothesis
from hypothesis import strategies as st
import pytest

from waggle_tasks.protocol import (
  agreement,
  clock,
  frame,
  gestures,
  payload,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol

AGREED = agreement.Agreement()
CLOCK = AGREED.clock
BITS = '011010'
NULL_S = 3.0
Timed = tuple[Symbol, clock.Moment]


def whole(bits: str = BITS, pace: float = 1.0) -> list[Timed]:
  """The events of a frame at the times at which they are danced."""
  message = payload.Payload.from_bits(bits)
  slots = schedule.broadcast(
    frame.motions(message), AGREED.codebook, AGREED.pauses
  ).slots
  events = [(Symbol.NULL, clock.Moment(0.0, NULL_S * pace))]
  for slot in slots:
    begin_s, end_s = slot.begin_s * pace, slot.end_s * pace
    events.append((slot.gesture.symbol, clock.Moment(begin_s, end_s)))
    events.append((Symbol.NULL, clock.Moment(end_s, end_s + NULL_S)))
  return events


def read(events: Iterable[Timed], known: clock.Clock = CLOCK) -> list[object]:
  """What a parser makes of each event."""
  parser, outcomes = frame.Parser(clock=known), []
  for event in events:
    parser, outcome = parser.step(*event)
    outcomes.append(outcome)
  return outcomes


def messages(events: Iterable[Timed], known: clock.Clock = CLOCK) -> list[str]:
  return [
    each.payload.bits
    for each in read(events, known)
    if isinstance(each, frame.Message)
  ]


def reasons(events: Iterable[Timed]) -> list[str]:
  return [
    each.reason for each in read(events) if isinstance(each, frame.Rejection)
  ]


def later(events: Sequence[Timed], first: int, by_s: float) -> list[Timed]:
  """The events with all from one on later."""
  return [
    (symbol, _moved(moment, by_s) if number >= first else moment)
    for number, (symbol, moment) in enumerate(events)
  ]


def _moved(moment: clock.Moment, by_s: float) -> clock.Moment:
  begin_s, end_s = moment.begin_s + by_s, moment.end_s + by_s
  return dataclasses.replace(moment, begin_s=begin_s, end_s=end_s)


def is_timely(events: Sequence[Timed]) -> bool:
  """Whether 17 events are a frame that came in its time, all in sight."""
  symbols = [symbol for symbol, _ in events]
  bits = ''.join(symbols[3:15:2])
  if len(bits) != 6 or {*bits} - {'0', '1'}:
    return False
  agreed = whole(bits)
  if symbols != [symbol for symbol, _ in agreed]:
    return False
  seen = [moment for _, moment in events[1::2]]
  danced = [moment for _, moment in agreed[1::2]]
  for number, (now, then) in enumerate(zip(seen, danced, strict=True)):
    lasts_s = then.end_s - then.begin_s
    spare_s = 0.02 * lasts_s + 0.6
    lasted_s = now.end_s - now.begin_s
    if not 0.7 * lasts_s - spare_s <= lasted_s <= lasts_s + spare_s:
      return False
    for other in {0, max(number - 1, 0)} - {number}:
      way_s = then.middle_s - danced[other].middle_s
      off_s = now.middle_s - seen[other].middle_s - way_s
      if abs(off_s) > 0.02 * way_s + 0.6:
        return False
  until_s = AGREED.pauses.pause_s + danced[0].end_s - danced[0].begin_s
  if events[16][1].end_s - seen[-1].end_s > 1.02 * until_s + 0.6:
    return False
  longest_s = 0.75 * (danced[0].end_s - danced[0].begin_s)
  return all(moment.unseen_s <= longest_s for _, moment in events[2:])


DELAYS_S = st.one_of(st.floats(-1.5, 1.5), st.floats(-30, 60))
LOSSES_S = st.sampled_from([0.0, 0.4, 5.0, 5.7, 9.0, math.inf])


@st.composite
def observed(draw: st.DrawFn) -> list[Timed]:
  """A frame as it may be seen: late, early, hidden here and there, cut."""
  events = whole(draw(st.text('01', min_size=6, max_size=6)))
  for _ in range(draw(st.integers(0, 3))):
    place = draw(st.integers(0, len(events) - 1))
    symbol, moment = events[place]
    match draw(st.sampled_from(['later', 'long', 'hide', 'drop', 'other'])):
      case 'later':
        events = later(events, place, draw(DELAYS_S))
      case 'long':
        end_s = moment.end_s + draw(DELAYS_S)
        moment = dataclasses.replace(moment, end_s=end_s)
        events[place] = symbol, moment
      case 'hide':
        unseen_s = draw(LOSSES_S)
        moment = dataclasses.replace(moment, unseen_s=unseen_s)
        events[place] = symbol, moment
      case 'drop':
        count = draw(st.integers(1, 4))
        del events[place : place + count]
        if not events:
          return whole()
      case 'other':
        events[place] = draw(st.sampled_from([*Symbol])), moment
  return events


@st.composite
def stories(draw: st.DrawFn) -> list[Timed]:
  """Frames one after the other."""
  events, begin_s = [], 0.0
  for part in draw(st.lists(observed(), min_size=1, max_size=3)):
    events += later(part, 0, begin_s)
    begin_s = events[-1][1].end_s + draw(st.floats(0, 20))
  return events


@hypothesis.settings(max_examples=200)
@hypothesis.given(stories())
def test_a_message_is_accepted_iff_a_whole_frame_came_in_its_time(
  events: list[Timed],
) -> None:
  for count, outcome in enumerate(read(events), 1):
    timely = is_timely(events[max(count - 17, 0) : count])
    assert isinstance(outcome, frame.Message) == timely


def test_a_frame_in_its_time_is_read() -> None:
  assert messages(whole()) == [BITS]
  assert reasons(whole()) == []


@pytest.mark.parametrize(
  ('pace', 'reads'), [(0.98, 1), (1.02, 1), (0.95, 0), (1.05, 0)]
)
def test_clocks_may_differ_by_two_parts_in_a_hundred(
  pace: float, reads: int
) -> None:
  assert len(messages(whole(pace=pace))) == reads


@pytest.mark.parametrize('bit', range(1, 7))
@pytest.mark.parametrize('by_s', [-0.5, 0.5])
def test_what_is_noticed_a_little_late_or_early_is_read(
  bit: int, by_s: float
) -> None:
  place, events = 2 * bit + 1, whole()
  symbol, moment = events[place]
  events[place] = symbol, _moved(moment, by_s)
  assert messages(events) == [BITS]


@pytest.mark.parametrize('bit', range(1, 8))
@pytest.mark.parametrize('by_s', [-2.0, 2.0, 11.5, 60.0])
def test_a_motion_out_of_its_time_breaks_the_frame(
  bit: int, by_s: float
) -> None:
  events = later(whole(), 2 * bit + 1, by_s)
  assert messages(events) == []
  assert 'must come 11.5 s after' in reasons(events)[0]


@pytest.mark.parametrize('place', range(2, 17))
@pytest.mark.parametrize('unseen_s', [6.0, math.inf])
def test_what_may_hide_a_gesture_breaks_the_frame(
  place: int, unseen_s: float
) -> None:
  events = whole()
  symbol, moment = events[place]
  events[place] = symbol, dataclasses.replace(moment, unseen_s=unseen_s)
  assert messages(events) == []
  said = 'given up' if math.isinf(unseen_s) else 'nothing was seen for 6.0 s'
  assert said in reasons(events)[0]


@pytest.mark.parametrize('place', range(17))
def test_what_hides_no_gesture_breaks_nothing(place: int) -> None:
  events = whole()
  symbol, moment = events[place]
  events[place] = symbol, dataclasses.replace(moment, unseen_s=5.0)
  assert messages(events) == [BITS]


def test_the_final_null_must_come_before_another_motion_could() -> None:
  assert messages(later(whole(), 16, 5.0)) == [BITS]
  events = later(whole(), 16, 15.0)
  assert messages(events) == []
  assert 'the final null must come within' in reasons(events)[0]


def test_a_frame_after_a_broken_one_is_read() -> None:
  broken = later(whole('111111'), 7, 20.0)
  again = later(whole(), 0, broken[-1][1].end_s)
  assert messages([*broken, *again]) == [BITS]


def test_without_a_clock_order_is_all() -> None:
  events = later(whole(), 7, 60.0)
  assert messages(events, None) == [BITS]


def test_another_language_has_another_clock() -> None:
  fast = agreement.Agreement(
    gestures.v_codebook(0.12, 0.25, 2.0), timing.Timing(3.2, 0.6, 2.0, 1.8)
  )
  assert fast.clock.blind_s == pytest.approx(1.5)
  assert CLOCK.blind_s == pytest.approx(0.75 * 7.5)
  assert messages(whole(), fast.clock) == []


def test_a_wide_tolerance_takes_more() -> None:
  wide = dataclasses.replace(CLOCK, tolerance=clock.Tolerance(0.05, 3.0))
  assert messages(later(whole(), 7, 2.0), wide) == [BITS]


@pytest.mark.parametrize(
  ('field', 'value'),
  [('clock_rate', -0.1), ('clock_rate', 0.3), ('clock_delay_s', math.nan)],
)
def test_a_tolerance_that_is_none_is_refused(field: str, value: float) -> None:
  with pytest.raises(clock.ClockError, match=f'`{field}` must be'):
    clock.Tolerance(**{field: value})


def test_a_parser_with_a_clock_asks_for_the_moment() -> None:
  with pytest.raises(TypeError, match='`moment` must be given'):
    frame.Parser(clock=CLOCK).step(Symbol.NULL)
