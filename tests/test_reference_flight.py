"""The action as an array, and the agreed way to fly a message."""

import math

import numpy as np
import pytest

from waggle_tasks.protocol import agreement, flight, reference

AGREED = agreement.Agreement()


def test_a_reference_is_thirteen_numbers_and_back() -> None:
  array = np.arange(13.0)
  wanted = reference.Reference.from_array(array)
  np.testing.assert_array_equal(wanted.position_m, [0, 1, 2])
  np.testing.assert_array_equal(wanted.velocity_mps, [3, 4, 5])
  np.testing.assert_array_equal(wanted.acceleration_mps2, [6, 7, 8])
  assert wanted.turn_rad == 9
  np.testing.assert_array_equal(wanted.goal_m, [10, 11, 12])
  np.testing.assert_array_equal(wanted.to_array(), array)
  assert reference.SIZE == 13


def test_a_hover_rests_where_it_is() -> None:
  place_m = np.array([1.0, 2.0, 1.3])
  hover = reference.Reference.hover(place_m).to_array()
  np.testing.assert_array_equal(hover, [*place_m, *[0] * 7, *place_m])


@pytest.fixture
def forward() -> flight.Flight:
  """The paper's default displacement, from the front observer's place."""
  begin_m = np.array([0.0, -1.3, 1.3])
  return flight.Flight(begin_m, begin_m + np.array([0, 0.4, 0]), 95.64)


def test_a_flight_is_straight_and_rests_at_both_ends(
  forward: flight.Flight,
) -> None:
  times_s = forward.begin_s + np.linspace(-1, flight.DURATION_S + 1, 501)
  position, velocity, acceleration = (
    np.stack(each) for each in zip(*map(forward.motion, times_s), strict=True)
  )
  np.testing.assert_array_equal(position[0], forward.begin_m)
  np.testing.assert_allclose(position[-1], forward.goal_m)
  for ends in (velocity[[0, -1]], acceleration[[0, -1]]):
    np.testing.assert_array_equal(ends, np.zeros((2, 3)))
  np.testing.assert_allclose(position[:, [0, 2]], [(0, 1.3)] * 501)
  assert (np.diff(position[:, 1]) >= 0).all()


def test_a_flight_arrives_when_the_papers_does(forward: flight.Flight) -> None:
  """3.144 s after the final null: 98.784 s and 95.64 s in the paper."""
  since_s = math.nan
  for frame in range(200):
    time_s = forward.begin_s + 0.04 * frame
    position, velocity, _ = forward.motion(time_s)
    error_m = np.linalg.norm(position - forward.goal_m)
    if not flight.is_arrived(float(error_m), float(np.linalg.norm(velocity))):
      since_s = math.nan
    elif math.isnan(since_s):
      since_s = time_s
    if time_s - since_s >= flight.ARRIVAL_DWELL_S - 1e-6:
      break
  assert time_s - forward.begin_s == pytest.approx(3.144, abs=0.04)


@pytest.mark.parametrize(
  ('error_m', 'speed_mps', 'arrived'),
  [
    (0.0, 0.0, True),
    (0.0149, 0.0249, True),
    (0.015, 0.0, False),
    (0.0, 0.025, False),
    (math.nan, 0.0, False),
    (0.0, math.nan, False),
  ],
)
def test_near_and_slow_counts_towards_arrival(
  error_m: float, speed_mps: float, arrived: bool
) -> None:
  assert flight.is_arrived(error_m, speed_mps) is arrived


def test_arrival_and_hold_are_the_papers() -> None:
  limits = (
    flight.ARRIVAL_ERROR_M,
    flight.ARRIVAL_SPEED_MPS,
    flight.ARRIVAL_DWELL_S,
    flight.HOLD_S,
    AGREED.hover_height_m,
  )
  assert limits == (0.015, 0.025, 0.4, 2.0, 1.3)
