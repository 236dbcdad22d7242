"""When the dance moves, and that it moves smoothly."""

from collections.abc import Callable
import math

import hypothesis
from hypothesis import strategies as st
import numpy as np
import pytest

from waggle_tasks.protocol import (
  agreement,
  frame,
  gestures,
  minimum_jerk,
  payload,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol

AGREED = agreement.Agreement()

# The stock firmware's limits, which the dance must leave room under.
SPEED_MPS, ACCELERATION_MPS2 = 1.0, 3.57


def dance(
  bits: str = '000010',
  codebook: gestures.Codebook = gestures.v_codebook(),
  pauses: timing.Timing = timing.Timing(),
) -> schedule.Schedule:
  motions = frame.motions(payload.Payload.from_bits(bits))
  return schedule.broadcast(motions, codebook, pauses)


def sampled(
  plan: schedule.Schedule, begin_s: float, end_s: float, step_s: float
) -> list[np.ndarray]:
  """Position, velocity and acceleration, (T, 2) each, at even times."""
  times_s = np.arange(begin_s, end_s, step_s)
  moments = [plan.motion(float(time_s)) for time_s in times_s]
  return [np.stack(each) for each in zip(*moments, strict=True)]


def test_the_papers_message_has_the_papers_times() -> None:
  plan = dance()
  begins_s = [slot.begin_s for slot in plan.slots]
  np.testing.assert_allclose(begins_s, 4.0 + 11.5 * np.arange(8))
  np.testing.assert_allclose([s.end_s - s.begin_s for s in plan.slots], 7.5)
  # The paper recognises END at 92.64 s, once the image has been slow.
  assert plan.end_s == pytest.approx(92.0)
  # Its transmission stops at 26 s: after the first bit, before the second.
  assert plan.slots[1].end_s < 26 < plan.slots[2].begin_s


def test_the_gap_of_the_paper_leaves_time_for_its_null() -> None:
  pauses = timing.Timing()
  assert pauses.gap_s == 2.0
  assert pauses.pause_s == pauses.settle_s + pauses.gap_s + pauses.lead_in_s
  assert pauses.pause_s > 3.0 + 0.68  # The null, after motion has ended.
  assert pauses.initial_hover_s > 3.0


@pytest.mark.parametrize('bits', ['000010', '111111'])
def test_a_symbol_is_flown_from_its_begin_to_its_end(bits: str) -> None:
  plan = dance(bits)
  motions = ['START', *bits, 'END']
  for index, symbol in enumerate(motions):
    begin_s = 4.0 + 11.5 * index
    assert plan.symbol_at(begin_s) == symbol
    assert plan.symbol_at(begin_s + 7.49) == symbol
    assert plan.symbol_at(begin_s - 0.01) is Symbol.NULL
    assert plan.symbol_at(begin_s + 7.51) is Symbol.NULL
  assert plan.symbol_at(0.0) is plan.symbol_at(1e4) is Symbol.NULL


def test_the_dance_passes_every_corner_at_rest() -> None:
  plan = dance('010101')
  for slot in plan.slots:
    for leg, corner_m in enumerate(slot.gesture.corners_m):
      offset, velocity, acceleration = plan.motion(
        slot.begin_s + leg * slot.gesture.leg_s
      )
      np.testing.assert_allclose(offset, corner_m, atol=1e-9)
      np.testing.assert_allclose(velocity, 0, atol=1e-9)
      np.testing.assert_allclose(acceleration, 0, atol=1e-6)


def test_the_dance_never_jumps() -> None:
  step_s = 1e-3
  position, velocity, acceleration = sampled(dance('010101'), 3.5, 30.0, step_s)
  # Central differences of each are the next one, across all the joints.
  slope = (position[2:] - position[:-2]) / (2 * step_s)
  np.testing.assert_allclose(slope, velocity[1:-1], atol=1e-5)
  slope = (velocity[2:] - velocity[:-2]) / (2 * step_s)
  np.testing.assert_allclose(slope, acceleration[1:-1], atol=5e-3)
  assert np.abs(np.diff(acceleration, axis=0)).max() < 5e-3


def test_the_dance_stays_far_below_the_stock_limits() -> None:
  plan = dance('010101')
  _, velocity, acceleration = sampled(plan, 0.0, plan.end_s, 0.002)
  speed_mps = np.linalg.norm(velocity, axis=1).max()
  acceleration_mps2 = np.linalg.norm(acceleration, axis=1).max()
  # END's long leg and the bits' legs: 15/8 and 10/sqrt(3) of their means.
  assert speed_mps == pytest.approx(15 / 8 * 0.57 / 2.5, rel=1e-3)
  arm_m = 0.285 * math.sqrt(2)
  expected = 10 / math.sqrt(3) * arm_m / 1.875**2
  assert acceleration_mps2 == pytest.approx(expected, rel=1e-3)
  assert speed_mps < SPEED_MPS / 2
  assert acceleration_mps2 < ACCELERATION_MPS2 / 2


def test_another_codebook_and_another_timing_are_other_values() -> None:
  codebook = gestures.v_codebook(0.1, 0.2, duration_s=2.0)
  pauses = timing.Timing(1.0, 0.25, 0.5, 0.25)
  plan = dance(codebook=codebook, pauses=pauses)
  begins_s = [slot.begin_s for slot in plan.slots]
  np.testing.assert_allclose(begins_s, 1.0 + 3.0 * np.arange(8))
  position, _, _ = sampled(plan, 0.0, plan.end_s, 0.01)
  low_m, high_m = position.min(axis=0), position.max(axis=0)
  np.testing.assert_allclose(low_m, (-0.1, -0.1), atol=1e-3)
  np.testing.assert_allclose(high_m, (0.1, 0.2), atol=1e-3)


def test_no_gestures_are_a_hover() -> None:
  plan = schedule.Schedule(())
  assert plan.end_s == 0
  for time_s in (0.0, 5.0, 100.0):
    assert plan.symbol_at(time_s) is Symbol.NULL
    np.testing.assert_array_equal(plan.motion(time_s), np.zeros((3, 2)))


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (lambda: timing.Timing(-1.0), '`initial_hover_s` must be between 0 and 60'),
    (lambda: timing.Timing(settle_s=math.nan), '`settle_s` must be a finite'),
    (lambda: timing.Timing(gap_s=math.inf), '`gap_s` must be a finite'),
    (lambda: timing.Timing(gap_s='2'), "`gap_s` must be .* got '2'"),
    (lambda: timing.Timing(lead_in_s=61), '`lead_in_s` must be between 0 and'),
    (lambda: timing.Timing(lead_in_s=True), '`lead_in_s` must be .* got True'),
  ],
)
def test_a_pause_that_cannot_be_kept_is_refused(
  make: Callable[[], object], error: str
) -> None:
  with pytest.raises(timing.TimingError, match=error):
    make()


@pytest.mark.parametrize(
  ('duration_s', 'frames'), [(0.0, 0), (0.04, 1), (0.68, 17), (26.0, 650)]
)
def test_durations_are_counted_in_frames_of_the_camera(
  duration_s: float, frames: int
) -> None:
  assert AGREED.frames(duration_s) == frames


@pytest.mark.parametrize('duration_s', [0.4, 3.0])
def test_minimum_jerk_is_the_quintic_between_two_rests(
  duration_s: float,
) -> None:
  begin, end = np.array([1.0, -2.0]), np.array([3.0, -2.5])
  shares = np.linspace(0.0, 1.0, 101)
  position = np.stack(
    [
      minimum_jerk.between(begin, end, s * duration_s, duration_s)[0]
      for s in shares
    ]
  )
  quintic = 10 * shares**3 - 15 * shares**4 + 6 * shares**5
  np.testing.assert_allclose(
    position, begin + quintic[:, None] * (end - begin), atol=1e-12
  )
  for elapsed_s, place in [(-1.0, begin), (2 * duration_s, end)]:
    rest = minimum_jerk.between(begin, end, elapsed_s, duration_s)
    np.testing.assert_array_equal(rest[0], place)
    np.testing.assert_array_equal(rest[1:], np.zeros((2, 2)))


NUMBER = st.floats(-2.0, 2.0)


@pytest.mark.slow
@hypothesis.given(NUMBER, NUMBER, NUMBER, st.floats(0.2, 2.0))
def test_braking_begins_with_the_given_state_and_ends_at_rest(
  position: float, velocity: float, acceleration: float, duration_s: float
) -> None:
  state = [np.array([value]) for value in (position, velocity, acceleration)]

  def at(elapsed_s: float) -> tuple[np.ndarray, ...]:
    return minimum_jerk.to_rest(*state, elapsed_s, duration_s)

  np.testing.assert_allclose(at(0.0), state, atol=1e-12)
  end, rest, quiet = at(duration_s)
  np.testing.assert_allclose(
    end, position + velocity * duration_s / 2, atol=1e-12
  )
  np.testing.assert_allclose([rest, quiet], 0, atol=1e-9)
  np.testing.assert_allclose(at(10 * duration_s), (end, rest, quiet))
  np.testing.assert_allclose(at(-1.0), state, atol=1e-12)
  # Each is the slope of the one before.
  times_s = np.linspace(0.0, duration_s, 401)
  x, v, a = (
    np.array(each)[:, 0] for each in zip(*map(at, times_s), strict=True)
  )
  step_s = times_s[1]
  np.testing.assert_allclose((x[2:] - x[:-2]) / 2 / step_s, v[1:-1], atol=2e-3)
  np.testing.assert_allclose((v[2:] - v[:-2]) / 2 / step_s, a[1:-1], atol=2e-2)
