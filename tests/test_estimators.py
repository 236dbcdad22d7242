"""Vehicles that do not quite know where they are wander as real ones do."""

from collections.abc import Callable
import math

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import reference
from waggle_tasks.tasks import coloured, estimators

Load = Callable[..., registry.composer.Environment]
STEP_S = 0.04
# Hover that was measured, along an axis: rms of place in windows of 4 s and of
# speed, lowest and highest.
MEASURED = {
  'mocap': ((4.5, 7.5), (10.0, 16.0)),
  'lighthouse': ((3.5, 6.0), (11.0, 17.0)),
  'flow_deck': ((3.3, 6.8), (14.0, 37.0)),
}


class Watch:
  """What vehicles did and took for the truth while they were told to stay."""

  def __init__(
    self, environment: registry.composer.Environment, seconds: float
  ) -> None:
    task = environment.task
    timestep = environment.reset()
    hold = [
      reference.Reference.hover(each['position_m']).to_array()
      for each in timestep.observation
    ]
    places_m, speeds_mps, yaws_rad, told_m = [], [], [], []
    for _ in range(round(seconds / STEP_S)):
      timestep = environment.step(hold)
      places_m.append([*task.positions_m(environment.physics).values()])
      speeds_mps.append(
        [*task.fleet.velocities_mps(environment.physics).values()]
      )
      yaws_rad.append(
        [
          2 * math.atan2(quaternion[3], quaternion[0])
          for quaternion in environment.physics.data.qpos.reshape(-1, 7)[:, 3:]
        ]
      )
      told_m.append([each['position_m'] for each in timestep.observation])
    self.places_m = np.array(places_m)  # (T, N, 3)
    self.speeds_mps = np.array(speeds_mps)
    self.yaws_rad = np.unwrap(yaws_rad, axis=0)  # (T, N)
    self.told_m = np.array(told_m)  # (T, N - 1, 3), of observers.


def rms(values: np.ndarray) -> float:
  return float(np.sqrt(np.square(values).mean()))


@pytest.fixture
def watch(load: Load) -> Callable[..., Watch]:
  def run(estimator: str, seconds: float, **changes: object) -> Watch:
    environment = load(
      'no_send', cameras=False, dynamics='rotors', estimator=estimator,
      duration_s=seconds + 1.0, **changes,
    )  # fmt: skip
    return Watch(environment, seconds)

  return run


@pytest.mark.slow
@pytest.mark.parametrize('estimator', MEASURED)
def test_hover_wanders_as_was_measured(
  estimator: str, watch: Callable[..., Watch]
) -> None:
  seen = watch(estimator, 27.0, observers=4, half_span_deg=60.0)
  places_mm = 1e3 * seen.places_m[75:].reshape(6, 100, -1)
  places_mm = places_mm - places_mm.mean(axis=1, keepdims=True)
  place, speed = MEASURED[estimator]
  assert place[0] < rms(places_mm) < place[1]
  assert speed[0] < rms(1e3 * seen.speeds_mps[75:]) < speed[1]


@pytest.mark.slow
def test_headings_are_held_by_what_shows_them(
  watch: Callable[..., Watch],
) -> None:
  found = {}
  for name in ('mocap', 'lighthouse'):
    yaws = np.degrees(watch(name, 12.0, observers=3).yaws_rad)
    found[name] = rms(yaws[75:] - yaws[0])
  assert 0.6 < found['mocap'] < 2.5
  assert 0.1 < found['lighthouse'] < 0.5
  # Nothing shows its heading to a flow deck: it is lost, bit by bit.
  errors = estimators.PRESETS['flow_deck'].draw(
    200, 100.0, np.random.RandomState(0)
  )
  assert math.degrees(rms(errors.errors(100.0)[2][:, 2])) > 0.8


@pytest.mark.slow
def test_an_observation_tells_the_estimate_and_not_the_truth(
  watch: Callable[..., Watch],
) -> None:
  """It stays where it takes itself to be: the truth wanders."""
  seen = watch('mocap', 12.0, observers=2)
  apart_m = seen.told_m - seen.places_m[:, 1:]
  assert 0.004 < rms(apart_m[75:]) < 0.02
  assert rms((seen.told_m - seen.told_m[0])[75:]) < 0.005
  assert np.abs(apart_m[0]).max() < 1e-4  # Errors grow from nothing.
  exact = watch('none', 1.0, observers=2)
  np.testing.assert_array_equal(exact.told_m, exact.places_m[:, 1:])


@pytest.mark.slow
def test_each_vehicle_and_each_seed_errs_its_own_way(
  watch: Callable[..., Watch],
) -> None:
  first, again, other = (
    watch('lighthouse', 8.0, observers=2, seed=seed).places_m
    for seed in (1, 1, 2)
  )
  np.testing.assert_array_equal(first, again)
  assert np.abs(first - other).max() > 0.002
  ways = (first - first[0])[:, :, 0].T
  assert np.abs(np.corrcoef(ways) - np.eye(3)).max() < 0.98


def test_an_error_and_its_speed_belong_together() -> None:
  errors = estimators.PRESETS['flow_deck'].draw(
    3, 20.0, np.random.RandomState(3)
  )
  times_s = coloured.STEP_S * np.arange(900)
  place, speed, _ = (
    np.array(each) for each in zip(*map(errors.errors, times_s), strict=True)
  )
  steps = np.diff(place, axis=0) / coloured.STEP_S
  middle = (speed[1:] + speed[:-1]) / 2
  assert rms(steps - middle) < 0.25 * rms(middle)


def test_vehicles_that_err_start_further_apart() -> None:
  near = {'dynamics': 'rotors', 'observers': 2, 'distance_m': 0.6}
  scenario.Scenario(half_span_deg=10.0, **near)
  with pytest.raises(layouts.LayoutError, match=r'at least 0.24\d m apart'):
    scenario.Scenario(half_span_deg=10.0, estimator='mocap', **near)


def test_an_estimator_that_nobody_knows_is_refused() -> None:
  with pytest.raises(scenario.ScenarioError, match=r"one of \['none', 'mocap'"):
    scenario.Scenario(dynamics='rotors', estimator='gps')
