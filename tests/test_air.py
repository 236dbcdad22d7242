"""Wind, gusts and downwash, beside the formulas that they are from."""

from collections.abc import Callable
import math

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.entities import crazyflie, jet, rotors
from waggle_tasks.protocol import limits
from waggle_tasks.tasks import air, coloured, weather

Load = Callable[..., registry.composer.Environment]
HEIGHT_M = 1.3


def hovering(environment: registry.composer.Environment) -> np.ndarray:
  """(T, N, 3) where vehicles are that are told to stay."""
  environment.reset()
  task, physics, out = environment.task, environment.physics, []
  hold = [np.zeros(13) for _ in task.observers]
  for each, observer in zip(hold, task.observers, strict=True):
    home_m = task.positions_m(physics)[observer.mjcf_model.model]
    each[:3] = each[10:] = home_m
  timestep = None
  while timestep is None or not timestep.last():
    timestep = environment.step(hold)
    out.append([*task.positions_m(physics).values()])
  return np.array(out)


@pytest.mark.parametrize(
  ('wind_deg', 'way'), [(0.0, (0, 1)), (90.0, (-1, 0)), (-45.0, (1, 1))]
)
def test_a_vehicle_leans_into_a_steady_wind_and_stays(
  wind_deg: float, way: tuple[float, float], load: Load
) -> None:
  """tan(tilt) = d w / (m g), from the first moment on."""
  environment = load(
    'no_send',
    cameras=False,
    observers=1,
    duration_s=3.0,
    dynamics='rotors',
    air=air.Air(2.0, wind_deg),
  )
  places_m = hovering(environment)
  assert np.abs(places_m - places_m[0]).max() < 2e-3
  push_n = rotors.DRAG_NS_M[0] * 2.0
  weight_n = crazyflie.MASS_KG * 9.81
  for tilt_rad, _, air_mps in environment.task.fleet.flown().values():
    assert tilt_rad == pytest.approx(math.atan(push_n / weight_n), rel=0.01)
    along = np.array(way) / np.hypot(*way)
    np.testing.assert_allclose(air_mps, [*(2.0 * along), 0.0], atol=1e-9)
  rotation = environment.physics.named.data.xmat['observer_1/airframe']
  assert rotation.reshape(3, 3)[:2, 2] @ along < 0  # It leans against it.


def test_gusts_have_the_intensities_and_the_lengths_of_dryden() -> None:
  """MIL-F-8785C at 10 feet; of half an hour."""
  wind_mps = 4.0
  gusts = weather.gusts_mps(
    wind_mps, HEIGHT_M, 1800.0, np.random.RandomState(1)
  )
  ground = 0.177 + 0.000823 * 10
  rms_mps = 0.1 * wind_mps * np.array([ground**-0.4, ground**-0.4, 1.0])
  np.testing.assert_allclose(gusts.std(axis=0), rms_mps, rtol=0.15)
  assert np.abs(gusts.mean(axis=0)).max() < 0.2
  # What is left after a time: of the first kind exp(-t), of the second
  # exp(-t) (1 - t / 2), in units of length over wind.
  lengths_m = 10 / ground**1.2 * 0.3048 * np.array([1, 1, 0]) + (0, 0, 3.048)
  for column, length_m, kept in zip(
    gusts.T, lengths_m, (math.exp(-1), 0.5 * math.exp(-1), 0.5 * math.exp(-1)),
    strict=True,
  ):  # fmt: skip
    lag = round(length_m / wind_mps / coloured.STEP_S)
    found = np.corrcoef(column[:-lag], column[lag:])[0, 1]
    assert found == pytest.approx(kept, abs=0.12)


def test_a_coloured_signal_has_its_variance_at_all_times() -> None:
  draw = np.random.RandomState(0)
  value, slope = coloured.second_order(2.0, 300, 4000, draw)
  first = coloured.first_order(2.0, 300, 4000, draw)
  for signal, rms in ((value, 1.0), (slope, 2.0), (first, 1.0)):
    np.testing.assert_allclose(signal.std(axis=1), rms, rtol=0.08)
  steps = np.diff(value, axis=0) / coloured.STEP_S
  middle = (slope[1:] + slope[:-1]) / 2
  assert np.corrcoef(steps.ravel(), middle.ravel())[0, 1] > 0.99


@pytest.mark.parametrize('down_m', [0.25, 0.6, 1.2])
def test_a_jet_carries_the_weight_of_the_vehicle_above_it(
  down_m: float,
) -> None:
  """The flow of momentum through any plane below it."""
  aside_m = np.linspace(0.0, 5.0, 20001)
  speed_mps = jet.speed_mps(np.full_like(aside_m, down_m), aside_m)
  flow = 2 * math.pi * aside_m * jet.AIR_KG_M3 * speed_mps**2
  step_m = aside_m[1]
  momentum_n = ((flow[1:] + flow[:-1]) / 2 * step_m).sum()
  weight_n = crazyflie.MASS_KG * limits.GRAVITY_MPS2
  assert momentum_n == pytest.approx(weight_n, rel=0.03)


def test_a_jet_is_below_its_vehicle_and_grows_weaker_and_wider() -> None:
  assert jet.speed_mps(np.array(-0.1), np.array(0.0)) == 0
  down_m = np.array([0.3, 0.6, 1.2])
  on_axis = jet.speed_mps(down_m, np.zeros(3))
  assert (np.diff(on_axis) < 0).all()
  half_m = 0.07668 * (down_m + 5.817 * jet.SIZE_M)
  np.testing.assert_allclose(jet.speed_mps(down_m, half_m), on_axis / 2)
  places_m = np.array([[0, 0, 2.0], [0, 0, 1.4], [1.0, 0, 1.4]])
  sinks = jet.downwash_mps(places_m)
  assert sinks[0] == 0
  assert sinks[1] == pytest.approx(on_axis[1])
  assert sinks[2] < 0.01 * sinks[1]


@pytest.mark.slow
def test_who_hovers_below_another_needs_more_thrust_and_stays(
  load: Load,
) -> None:
  class Below:
    def poses(self, count: int) -> tuple[layouts.Pose, ...]:
      return (layouts.Pose((0.0, -0.01, 0.6), math.pi / 2),)

  thrusts = {}
  for downwash in (False, True):
    environment = load(
      'no_send', cameras=False, observers=1, duration_s=4.0,
      dynamics='rotors', layout=Below(), air=air.Air(downwash=downwash),
    )  # fmt: skip
    places_m = hovering(environment)
    below_m = places_m[:, 1]
    assert np.abs(below_m[-1] - below_m[0]).max() < 0.005
    flown = environment.task.fleet.flown()
    thrusts[downwash] = {n: each[1].sum() for n, each in flown.items()}
  sinks = jet.speed_mps(np.array(0.7), np.array(0.01))
  more_n = thrusts[True]['observer_1'] - thrusts[False]['observer_1']
  assert more_n == pytest.approx(rotors.DRAG_NS_M[2] * sinks, rel=0.02)
  assert thrusts[True]['performer'] == pytest.approx(
    thrusts[False]['performer'], rel=1e-6
  )


@pytest.mark.slow
def test_gusts_are_those_of_the_seed_and_move_everybody(load: Load) -> None:
  flown = {}
  for seed in (1, 1, 2):
    environment = load(
      'no_send', cameras=False, observers=2, duration_s=6.0, seed=seed,
      dynamics='rotors', air=air.Air(2.0, gusts=True),
    )  # fmt: skip
    flown.setdefault(seed, []).append(hovering(environment))
  first, again = flown[1]
  np.testing.assert_array_equal(first, again)
  away_m = first - first[0]
  assert 0.001 < np.abs(away_m).max() < 0.05
  assert np.abs(first - flown[2][0]).max() > 0.001


def test_resting_air_draws_nothing() -> None:
  class Refuses:
    def __getattr__(self, name: str) -> None:
      raise AssertionError(f'{name} was drawn')

  for still in (air.Air(), air.Air(1.0), air.Air(downwash=True)):
    weather.draw(still, HEIGHT_M, 10.0, Refuses())


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'wind_mps': -1.0}, '`wind_mps` must be between 0 and 4: got -1.0'),
    ({'wind_mps': 9.0}, '`wind_mps` must be between 0 and 4: got 9.0'),
    ({'wind_mps': math.nan}, '`wind_mps` must be a finite number'),
    ({'wind_deg': 360}, '`wind_deg` must be between -180 and 180: got 360'),
    ({'gusts': True}, '`gusts` must be False without wind'),
    ({'wind_mps': 1.0, 'gusts': 1}, '`gusts` must be True or False: got 1'),
    ({'downwash': 'yes'}, "`downwash` must be True or False: got 'yes'"),
  ],
)
def test_air_that_cannot_be_is_refused(
  changes: dict[str, object], error: str
) -> None:
  with pytest.raises(air.AirError, match=error):
    air.Air(**changes)


@pytest.mark.parametrize(
  ('changes', 'field'),
  [
    ({'air': air.Air(1.0)}, 'wind_mps'),
    ({'air': air.Air(downwash=True)}, 'downwash'),
    ({'estimator': 'mocap'}, 'estimator'),
  ],
)
def test_ideal_dynamics_have_neither_air_nor_estimates(
  changes: dict[str, object], field: str
) -> None:
  error = f"`{field}` must not be given with `dynamics` 'ideal'.*'rotors'"
  with pytest.raises(scenario.ScenarioError, match=error):
    scenario.Scenario(**changes)
  scenario.Scenario(dynamics='rotors', **changes)
