"""Vehicles drift as much as is asked for, truly, and are judged fairly."""

from collections.abc import Callable
import dataclasses

import numpy as np
import pytest

from waggle_tasks import registry, scenario, suites
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.protocol import agreement, flight, reference, timing
from waggle_tasks.tasks import drift

AGREED = agreement.Agreement()

STILL = timing.Timing(initial_hover_s=60.0)


def track(
  environment: registry.composer.Environment, seconds: float
) -> dict[str, np.ndarray]:
  """Each vehicle's (T, 4) true position in m and heading in rad."""
  task, rows = environment.task, []
  timestep = environment.reset()
  hold = [
    reference.Reference.hover(each['position_m']).to_array()
    for each in timestep.observation
  ]
  names = [*task.positions_m(environment.physics)]
  for _ in range(AGREED.frames(seconds)):
    timestep = environment.step(hold)
    assert not timestep.last()
    places_m = task.positions_m(environment.physics)
    rows.append([[*places_m[n], heading(environment, n)] for n in names])
  return dict(zip(names, np.moveaxis(rows, 1, 0), strict=True))


def heading(environment: registry.composer.Environment, name: str) -> float:
  matrix = environment.physics.named.data.xmat[f'{name}/airframe']
  return float(np.arctan2(matrix[3], matrix[0]))


@pytest.mark.slow
@pytest.mark.parametrize('time_s', [0.5, 1.0])
def test_the_drift_that_is_flown_is_the_one_asked_for(
  time_s: float, load: Callable
) -> None:
  """Of true positions and headings, over 50 s and all axes."""
  wanted = drift.Drift(0.004, 0.005, 0.3, time_s)
  environment = load(
    cameras=False, observers=2, drift=wanted, duration_s=55.0, pauses=STILL
  )
  flown = track(environment, 50.0)
  yaws_deg = []
  for name, rms_m in (
    ('performer', 0.004),
    ('observer_1', 0.005),
    ('observer_2', 0.005),
  ):
    away = flown[name][75:] - flown[name][0]  # Grown, after 2 s.
    assert np.sqrt((away[:, :3] ** 2).mean()) == pytest.approx(rms_m, rel=0.15)
    assert np.abs(away[:, :3].mean(0)).max() < 0.25 * rms_m
    yaws_deg.append(np.degrees(away[:, 3]))
  assert np.abs(yaws_deg[0]).max() < 1e-3  # The performer keeps its heading.
  rms_deg = np.sqrt(np.square(yaws_deg[1:]).mean())
  assert rms_deg == pytest.approx(0.3, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize('time_s', [0.3, 1.0, 10.0])
def test_the_controller_keeps_up_with_the_drift(
  time_s: float, load: Callable
) -> None:
  environment = load(
    cameras=False, drift=drift.Drift(0.01, 0.01, 0.5, time_s), pauses=STILL
  )
  task, worst_m = environment.task, 0.0
  environment.reset()
  homes_m = task.positions_m(environment.physics)
  hold = [reference.Reference.hover(homes_m[n]).to_array() for n in homes_m]
  for _ in range(400):
    environment.step(hold[1:])
    places_m, drifts_m = task.positions_m(environment.physics), task.drifts_m()
    for name, home_m in homes_m.items():
      miss_m = np.abs(places_m[name] - home_m - drifts_m[name]).max()
      worst_m = max(worst_m, miss_m)
  assert worst_m < 1e-3


@pytest.mark.slow
def test_each_vehicle_and_each_seed_drifts_its_own_way(load: Callable) -> None:
  flown = {}
  for seed in (1, 1, 2):
    environment = load(
      cameras=False,
      observers=2,
      seed=seed,
      drift=drift.Drift(0.005, 0.005),
      pauses=STILL,
    )
    flown.setdefault(seed, []).append(track(environment, 12.0))
  first, again = flown[1]
  for name in first:
    np.testing.assert_array_equal(first[name], again[name])
    assert np.abs(first[name] - flown[2][0][name]).max() > 0.002
  ways = [first[name][75:, 0] - first[name][0, 0] for name in first]
  worst = np.abs(np.corrcoef(ways) - np.eye(3)).max()
  assert worst < 0.9


def test_without_drift_nothing_is_drawn() -> None:
  class Refuses:
    def __getattr__(self, name: str) -> None:
      raise AssertionError(f'{name} was drawn')

  wander = drift.Drift().observer(Refuses())
  assert not np.any(wander.at(3.0))


@pytest.mark.slow
def test_a_drift_is_smooth_and_begins_at_rest() -> None:
  wander = drift.Drift(0.005).performer(np.random.RandomState(0))
  times_s = np.arange(0, 20, 0.001)
  place, rate, second = (
    np.stack(each)
    for each in zip(*(wander.at(t) for t in times_s), strict=True)
  )
  np.testing.assert_array_equal([place[0], rate[0], second[0]], 0)
  np.testing.assert_allclose(
    np.gradient(place, 0.001, axis=0)[1:-1], rate[1:-1], atol=1e-5
  )
  np.testing.assert_allclose(
    np.gradient(rate, 0.001, axis=0)[1:-1], second[1:-1], atol=1e-4
  )
  assert np.abs(second).max() < 0.1


@pytest.mark.slow
@pytest.mark.parametrize('seed', range(3))
def test_a_drift_of_5_mm_is_no_motion_and_lets_flights_arrive(
  seed: int,
  short: dict[str, object],
  load: Callable,
  episode: Callable,
) -> None:
  """The navigator flies from where it truly is; rewards count its command."""
  scene_drift = drift.Drift(0.005, 0.005, 0.3)
  environment = load(
    cameras=False, observers=2, seed=seed, drift=scene_drift, **short
  )
  task = environment.task
  scene = scenario.Scenario(observers=2, seed=seed, **short)
  begin_s = scene.performance.end_s + 3.0
  agent = _Navigating(begin_s)
  positions, drifts, rewards = [], [], np.zeros(2)
  for timestep in episode(environment, agent):
    positions.append(task.positions_m(environment.physics))
    drifts.append(task.drifts_m())
    if timestep.reward is not None:
      rewards += timestep.reward
  np.testing.assert_array_equal(rewards, [1, 1])
  assert not task.refusals
  flown = rollout.Rollout(
    np.arange(len(positions)) * AGREED.frame_s,
    {n: np.stack([p[n] for p in positions]) for n in positions[0]},
    (),
    {},
    '',
    drifts_m={n: np.stack([d[n] for d in drifts]) for n in drifts[0]},
  )
  for name in ('observer_1', 'observer_2'):
    away_m = flown.positions_m[name] - flown.positions_m[name][0]
    assert np.linalg.norm(away_m, axis=1)[: AGREED.frames(begin_s)].max() > 0.01
    assert evaluator._early_motion(flown, name, begin_s) == []
    judged = evaluator._fly(scene, flown, name, begin_s)
    assert judged['failures'] == []
    assert judged['error_m'] < 0.005


class _Navigating:
  """Flies 0.4 m ahead at a time, as navigators do, from where it truly is."""

  def __init__(self, begin_s: float) -> None:
    self._begin_s, self._begins_m = begin_s, None
    self._homes_m: list[np.ndarray] | None = None

  def __call__(self, observations: list[dict]) -> list[np.ndarray]:
    places_m = [each['position_m'].copy() for each in observations]
    self._homes_m = self._homes_m or places_m
    time_s = float(observations[0]['time_s'])
    if time_s < self._begin_s - 1e-6:
      hold = reference.Reference.hover
      return [hold(each).to_array() for each in self._homes_m]
    self._begins_m = self._begins_m or places_m
    out = []
    for begin_m in self._begins_m:
      goal_m = np.add(begin_m, (0.0, 0.4, 0.0))
      goal_m[2] = AGREED.hover_height_m
      plan = flight.Flight(begin_m, goal_m, self._begin_s)
      motion = plan.motion(time_s + AGREED.frame_s / 2)
      out.append(reference.Reference(*motion, 0.0, goal_m).to_array())
    return out


def test_an_observer_that_moves_on_its_own_is_still_found_out(
  load: Callable, episode: Callable, flyer: Callable
) -> None:
  environment = load(
    cameras=False,
    observers=1,
    duration_s=8.0,
    drift=drift.Drift(observer_drift_m=0.005),
  )
  rewards = [
    timestep.reward[0]
    for timestep in episode(environment, flyer((0.0, 0.03, 0.0), 3.0))
    if timestep.reward is not None
  ]
  assert sum(rewards) == -1


def test_neighbours_keep_their_distance_in_spite_of_drift() -> None:
  places = {'layout': 'line', 'spacing_m': 0.18, 'observers': 2}
  scenario.Scenario(**places)
  with pytest.raises(
    layouts.LayoutError, match=r'must start at least 0\.240 m'
  ):
    scenario.Scenario(**places, drift=drift.Drift(observer_drift_m=0.01))


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'performer_drift_m': -0.1}, '`performer_drift_m` must be between 0 and'),
    (
      {'observer_drift_m': 0.031},
      '`observer_drift_m` must be between .* 0.031',
    ),
    ({'observer_yaw_drift_deg': 6}, '`observer_yaw_drift_deg` must be between'),
    ({'drift_time_s': 0.0}, '`drift_time_s` must be between 0.3 and 10'),
    (
      {'performer_hover': 'mocup'},
      "`performer_hover` must be .*'none', .*'mocup'. Did you mean mocap",
    ),
    ({'observer_hover': None}, '`observer_hover` must be one of'),
    ({'hover_amplitude': -1}, '`hover_amplitude` must be between 0 and 2: got'),
    ({'hover_log': 'a.csv'}, '`hover_log` must be a hover.Spectrum: got'),
    ({'drift_time_s': float('nan')}, '`drift_time_s` must be a finite number'),
  ],
)
def test_a_drift_that_cannot_be_flown_is_refused(
  changes: dict[str, float], error: str
) -> None:
  with pytest.raises(drift.DriftError, match=error):
    drift.Drift(**changes)


def test_a_suite_may_ask_for_drift() -> None:
  (case,) = suites.from_rows(
    [{'name': 'windy', 'drift': {'observer_drift_m': 0.002}}]
  )
  assert case.scene.drift == dataclasses.replace(
    drift.Drift(), observer_drift_m=0.002
  )
  (case,) = suites.from_rows(
    [{'name': 'hover', 'drift': {'observer_hover': 'mocap'}}]
  )
  assert case.scene.drift == drift.Drift(observer_hover='mocap')
