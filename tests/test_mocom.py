"""MoCom's motions and timelines, and what reads them."""

import itertools

import numpy as np
import pytest
import tracks_kit as kit

from waggle_tasks import scenario
from waggle_tasks.experiments.record import fitting, nulls
from waggle_tasks.experiments.studies import mocom_flights
from waggle_tasks.protocol import (
  clock,
  frame,
  mocom,
  payload,
  performance,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import MOTIONS, Symbol

READER = fitting.usual(mocom.AGREEMENT)


def timeline(bits: str, seed: int = 0) -> performance.Performance:
  message = payload.Payload.from_bits(bits)
  rng = np.random.RandomState(seed)
  return performance.Performance(mocom.timeline(message, rng), says=message)


def test_its_motions_stand_for_what_is_published() -> None:
  ways = {s: np.array(mocom.codebook()[s].corners_m) for s in MOTIONS}
  assert not ways[Symbol.START][:, 0].any()  # Up and down.
  assert not ways[Symbol.END][:, 1].any()  # To the left and to the right.
  for bit, side in ((Symbol.ONE, 1), (Symbol.ZERO, -1)):
    left, middle, right = ways[bit][1:-1]
    assert left[0] < 0 < right[0]
    assert middle[1] * side > 0


def test_a_timeline_is_as_long_as_those_that_are_told_of() -> None:
  slots = timeline('011010').schedule.slots
  assert [slot.gesture.symbol for slot in slots] == [
    'START', *'011010', 'END',
  ]  # fmt: skip
  lasts_s = [slot.gesture.duration_s for slot in slots]
  gaps_s = [b.begin_s - a.end_s for a, b in itertools.pairwise(slots)]
  assert all(7.1 <= each <= 8.4 for each in lasts_s)
  assert all(1.8 <= each <= 3.3 for each in gaps_s)
  assert len({*lasts_s}) == len(lasts_s)
  assert timeline('011010', 1).schedule != timeline('011010').schedule


@pytest.mark.parametrize('gesture_s', mocom.GESTURE_S)
@pytest.mark.parametrize('gap_s', mocom.GAP_S)
def test_every_timeline_is_within_the_agreed_clock(
  gesture_s: float, gap_s: float
) -> None:
  message = payload.Payload.from_bits('101010')
  symbols = frame.motions(message)
  flown = schedule.broadcast(
    symbols, mocom.codebook(gesture_s), timing.Timing(4.0, 0.0, gap_s, 0.0)
  )
  moments = [clock.Moment(s.begin_s, s.end_s) for s in flown.slots]
  agreed = mocom.AGREEMENT.clock
  for number, symbol in enumerate(symbols):
    before = symbols[:number], moments[:number]
    assert agreed.motion(symbol, moments[number], *before) == ''


def test_a_gesture_that_was_hidden_is_out_of_the_clock() -> None:
  flown = timeline('101010').schedule.slots
  moments = [clock.Moment(s.begin_s, s.end_s) for s in flown]
  agreed = mocom.AGREEMENT.clock
  before = (Symbol.START, Symbol.ONE), moments[:2]
  assert agreed.motion(Symbol.ONE, moments[3], *before)


@pytest.mark.slow
@pytest.mark.parametrize(
  ('bits', 'angle_deg'),
  [
    ('011010', -45.0),
    *(
      pytest.param(bits, angle_deg, marks=pytest.mark.long)
      for bits in ('111111', '000000', '101101')
      for angle_deg in (-60.0, 0.0, 60.0)
    ),
  ],
)
def test_every_symbol_and_null_of_its_timelines_is_read_from_tracks(
  bits: str, angle_deg: float
) -> None:
  flown = timeline(bits, int(bits, 2))
  rows = kit.seen(mocom.AGREEMENT, flown, angle_deg, 1.2)
  events = kit.read(READER, mocom.AGREEMENT, rows)
  assert [e.symbol for e in events] == [*frame.events(flown.says)]
  assert kit.said(events) == bits


@pytest.mark.parametrize(
  'view',
  [
    'behind',
    pytest.param('upside down', marks=pytest.mark.long),
    pytest.param('on its side', marks=pytest.mark.long),
  ],
)
def test_a_camera_that_is_not_upright_reads_nothing(view: str) -> None:
  flown = timeline('011010')
  rows = kit.seen(mocom.AGREEMENT, flown, view=view)
  assert kit.said(kit.read(READER, mocom.AGREEMENT, rows)) is None


def test_upside_down_and_mirrored_a_1_is_a_0_and_no_start_tells_of_it() -> None:
  flown = timeline('011010')
  rows = kit.seen(mocom.AGREEMENT, flown, view='upside down and mirrored')
  events = kit.read(READER, mocom.AGREEMENT, rows)
  symbols = [e.symbol for e in events if e.symbol is not Symbol.NULL]
  assert symbols == [Symbol.UNKNOWN, *'100101', Symbol.END]
  assert kit.said(events) is None


@pytest.mark.long
@pytest.mark.parametrize(('seed', 'distance_m'), [(1, 0.9), (2, 1.5)])
def test_every_symbol_and_null_of_its_timelines_is_read_from_pictures(
  seed: int, distance_m: float
) -> None:
  scene = mocom_flights.scene('011010', distance_m, seed)
  events = mocom_flights.read(scene, [READER])[READER]
  assert [e.symbol for e in events] == [*frame.events(scene.message)]
  count = mocom_flights.count(scene, events)
  assert count == mocom_flights.Count(8, 8, 9, 9, 1, 1, 0)


def test_counting_takes_no_name_at_another_time_for_the_right_one() -> None:
  scene = mocom_flights.scene('011010', 1.2, 0)
  flown = scene.performance
  rows = kit.seen(mocom.AGREEMENT, flown)
  events = kit.read(READER, mocom.AGREEMENT, rows)
  assert mocom_flights.count(scene, events).motions_read == 8
  other = mocom_flights.scene('111010', 1.2, 0)
  found = mocom_flights.count(other, events)
  assert (found.motions_read, found.messages_read, found.wrong) == (7, 0, 1)
  assert mocom_flights.count(scene, events[4:]).motions_read == 6
  assert mocom_flights.count(scene, events[4:]).nulls_read == 7


@pytest.mark.parametrize('name', ['klt', 'view_bank'])
def test_nulls_are_fitted_to_the_pauses_and_else_left(name: str) -> None:
  fitted = fitting.fitted(name, mocom.AGREEMENT)
  assert fitted != name
  shortest = timing.Timing(4.0, 0.0, mocom.GAP_S[0], 0.0)
  needed_s = nulls.needed_s(fitted, mocom.AGREEMENT)
  assert needed_s <= shortest.pause_s
  assert fitting.fitted(name, scenario.Scenario().agreement) == name
