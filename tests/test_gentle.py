"""The language that four rotors can fly, and how long its legs have to be."""

import math

import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.experiments.results import language_measure
from waggle_tasks.protocol import gestures, languages, limits
from waggle_tasks.protocol.symbols import Symbol

GENTLE = languages.LANGUAGES['gentle']


def line(right_m: float, up_m: float, leg_s: float) -> gestures.Gesture:
  """There and back again."""
  corners_m = ((0.0, 0.0), (right_m, up_m), (0.0, 0.0))
  return gestures.Gesture(Symbol.START, corners_m, 2 * leg_s)


@pytest.mark.parametrize('dynamics', limits.DYNAMICS)
@pytest.mark.parametrize(
  ('right_m', 'up_m'), [(0.03, 0.0), (0.4, 0.0), (0.0, 0.3), (0.15, 0.15)]
)
def test_a_leg_takes_no_longer_than_a_vehicle_needs(
  dynamics: str, right_m: float, up_m: float
) -> None:
  most, leg_s = limits.LIMITS[dynamics], limits.least_s(right_m, up_m, dynamics)
  limits.check_motions([line(right_m, up_m, leg_s)], most)
  shorter_s = math.floor(100 * leg_s / 1.01) / 100 - 0.01
  with pytest.raises(limits.LimitError):
    limits.check_motions([line(right_m, up_m, shorter_s)], most)


def test_it_is_flown_by_all_vehicles_and_takes_at_most_30_s() -> None:
  measured = language_measure.measure(GENTLE)
  assert measured.accepted_s <= 30.0
  assert {*measured.refusals.values()} == {''}


@pytest.mark.slow
@pytest.mark.parametrize(
  ('distance_m', 'bearing_deg'),
  [(3.0, 75.0), pytest.param(0.6, 0.0, marks=pytest.mark.long)],
)
def test_it_is_read_when_rotors_fly_it(
  distance_m: float, bearing_deg: float
) -> None:
  scene = scenario.Scenario(
    observers=1, language='gentle', dynamics='rotors', payload='010110',
    distance_m=distance_m, bearing_deg=bearing_deg,
  )  # fmt: skip
  (outcome,) = evaluator.evaluate(scene, rollout.run(scene, 'joint')).outcomes
  assert (outcome.decoded, outcome.failures) == ('010110', ())
