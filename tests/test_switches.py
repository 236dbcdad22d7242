"""What a user switches on takes effect, or is refused with the rule."""

from collections.abc import Callable, Iterator
import copy
import pickle

from dm_control import composer
from dm_control.composer.observation import observable
import mujoco
import numpy as np
import pytest

from waggle_tasks import registry, scenario, sensor
from waggle_tasks.protocol import timing
from waggle_tasks.tasks import copies, episode_clock, surroundings, switches

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]

WHOLE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
AT_ONCE = {'pauses': timing.Timing(0.0, 1.0, 2.0, 1.0), 'observers': 1}


@pytest.mark.parametrize('name', ['velocity_mps', 'orientation'])
def test_an_observable_that_is_switched_on_is_observed(
  name: str, load: Load, hover: Fixture
) -> None:
  environment = load(cameras=False, observers=2)
  environment.reset()
  environment.task.observables[1][name].enabled = True
  first, second = environment.reset().observation
  assert name not in first
  assert np.isfinite(second[name]).all()
  assert second[name].shape == environment.observation_spec()[1][name].shape
  seen = environment.step(hover([first, second])).observation
  assert {*seen[1]} == {'time_s', 'position_m', name}


def test_an_observable_of_ones_own_is_observed(load: Load) -> None:
  environment = load(cameras=False, observers=1)
  (each,) = environment.task.observers
  height = observable.Generic(lambda physics: physics.bind(each.centre).xpos[2])
  each.observables.add_observable('height_m', height)
  height.enabled = True
  (seen,) = environment.reset().observation
  assert seen['height_m'] == pytest.approx(1.3)


@pytest.mark.parametrize('whose', ['performer', 'bystander_1'])
def test_an_observable_that_nobody_has_is_refused(
  whose: str, load: Load
) -> None:
  environment = load(
    observers=1, surroundings=surroundings.Surroundings(bystanders=1)
  )
  room = environment.task.root_entity
  (vehicle,) = (
    each for each in room.iter_entities() if each.mjcf_model.model == whose
  )
  vehicle.observables.velocity_mps.enabled = True
  error = f'`enabled` of {whose}/velocity_mps must be False: only observers'
  with pytest.raises(switches.ObservableError, match=error):
    environment.reset()


@pytest.mark.slow
@pytest.mark.parametrize(
  'spoilt', [sensor.Sensor(), sensor.Sensor(noise_sigma=3, late_frames=1)]
)
def test_a_corruptor_of_a_users_own_acts_on_what_comes(
  spoilt: sensor.Sensor, load: Load, hover: Fixture
) -> None:
  def invert(image: np.ndarray, random_state: object) -> np.ndarray:
    del random_state
    np.subtract(255, image, out=image)  # It may write to what it gets.
    return image

  def play(corrupt: bool) -> list[dict[str, np.ndarray]]:
    environment = load(sensor=spoilt, **AT_ONCE)
    if corrupt:
      seen = environment.task.observables[0]
      seen['camera'].corruptor = invert
      seen['time_s'].corruptor = lambda time_s, random_state: time_s + 7
      seen['position_m'].corruptor = lambda at_m, random_state: -at_m
    steps = [environment.reset()]
    for _ in range(5):
      here = [{'position_m': np.array([0.0, -1.3, 1.3])}]
      steps.append(environment.step(hover(here)))
    return [copy.deepcopy(each.observation[0]) for each in steps]

  for plain, changed in zip(play(False), play(True), strict=True):
    np.testing.assert_array_equal(changed['camera'], 255 - plain['camera'])
    assert changed['time_s'] == plain['time_s'] + 7
    np.testing.assert_array_equal(changed['position_m'], -plain['position_m'])


@pytest.mark.slow
@pytest.mark.parametrize(
  ('control_s', 'physics_s', 'error'),
  [
    (
      0.02,
      0.004,
      r'`control_timestep` must be 0.04 s, .* at 25 Hz: got 0.02',
    ),
    (0.08, 0.004, '`control_timestep` must be 0.04 s'),
    (np.nan, 0.004, '`control_timestep` must be 0.04 s'),
    (0.04, 0.02, '`physics_timestep` must be above 0 and at most 0.01 s'),
    (0.04, 0.0, '`physics_timestep` must be above 0'),
    (0.04, -0.004, '`physics_timestep` must be above 0'),
  ],
)
def test_a_time_step_that_is_not_the_dances_is_refused(
  control_s: float, physics_s: float, error: str, load: Load
) -> None:
  task = load(cameras=False, observers=1).task
  with pytest.raises(episode_clock.StepError, match=error):
    task.set_timesteps(control_s, physics_s)
  assert (task.control_timestep, task.physics_timestep) == (0.04, 0.004)
  if control_s != 0.04:
    with pytest.raises(episode_clock.StepError, match=error):
      task.control_timestep = control_s


@pytest.mark.slow
@pytest.mark.parametrize('physics_s', [0.002, 0.01])
def test_another_physics_step_flies_the_same_dance(
  physics_s: float, load: Load, episode: Fixture, hover: Fixture
) -> None:
  def end_m(step_s: float) -> np.ndarray:
    environment = load(cameras=False, duration_s=2.0, **AT_ONCE)
    environment.task.physics_timestep = step_s
    *_, last = episode(environment, hover)
    assert float(last.observation[0]['time_s']) == pytest.approx(2.0)
    return environment.task.positions_m(environment.physics)['performer']

  np.testing.assert_allclose(end_m(physics_s), end_m(0.004), atol=0.003)


@pytest.mark.slow
def test_a_physics_step_that_comes_too_late_is_refused(load: Load) -> None:
  environment = load(cameras=False, observers=1)
  environment.reset()
  environment.task.physics_timestep = 0.002
  with pytest.raises(episode_clock.StepError, match='before the first reset'):
    environment.reset()


def play(
  environment: composer.Environment, hover: Fixture, frames: int
) -> Iterator[np.ndarray]:
  """The images of some more steps."""
  here = [{'position_m': np.array([0.0, -1.3, 1.3])}]
  for _ in range(frames):
    (seen,) = environment.step(hover(here)).observation
    yield seen['camera'].copy()


BUSY = {
  **AT_ONCE,
  'surroundings': surroundings.Surroundings(bystanders=1, occluder_every_s=5),
}


@pytest.mark.slow
def test_a_state_that_is_set_is_seen(load: Load, hover: Fixture) -> None:
  environment = load(**BUSY)
  environment.reset()
  physics, states, images = environment.physics, [], []
  for image in play(environment, hover, 25):
    images.append(image)
    states.append(physics.get_state(WHOLE))
  camera = environment.task.observables[0]['camera']
  for state, image in zip(states, images, strict=True):
    physics.set_state(state, WHOLE)
    np.testing.assert_array_equal(camera(physics), image)


@pytest.mark.slow
def test_a_state_with_its_time_is_flown_again(
  load: Load, hover: Fixture
) -> None:
  environment = load(**BUSY)
  environment.reset()
  [*play(environment, hover, 10)]
  state = environment.physics.get_state(WHOLE)
  once = [*play(environment, hover, 30)]
  for _ in range(2):
    environment.physics.set_state(state, WHOLE)
    again = [*play(environment, hover, 30)]
    np.testing.assert_array_equal(again, once)
  assert (once[0] != once[-1]).any()


@pytest.mark.slow
def test_a_state_is_flown_again_in_another_episode(
  load: Load, hover: Fixture
) -> None:
  environment = load(**AT_ONCE)
  environment.reset()
  [*play(environment, hover, 10)]
  state = environment.physics.get_state(WHOLE)
  once = [*play(environment, hover, 10)]
  environment.reset()
  environment.physics.set_state(state, WHOLE)
  np.testing.assert_array_equal([*play(environment, hover, 10)], once)


def test_a_state_without_its_time_is_refused(
  load: Load, hover: Fixture
) -> None:
  environment = load(cameras=False, **AT_ONCE)
  here = hover(environment.reset().observation)
  states = []
  for _ in range(20):
    states.append(environment.physics.get_state())
    environment.step(here)
  environment.physics.set_state(states[10])
  error = (
    r'time was not, so that the dance would go on from 0.8 s: take .*INTEG'
  )
  with pytest.raises(episode_clock.StepError, match=error):
    environment.step(here)
  environment.reset()
  environment.physics.set_state(states[0])
  environment.step(here)  # That is where it is.
  environment.physics.step()
  with pytest.raises(episode_clock.StepError, match='whole number of frames'):
    environment.step(here)


def test_time_stays_once_there_was_a_command(
  load: Load, flyer: Fixture
) -> None:
  environment = load(cameras=False, **AT_ONCE)
  timestep, agent = environment.reset(), flyer((0.0, 0.4, 0.0), 0.0)
  state = environment.physics.get_state(WHOLE)
  for _ in range(10):
    timestep = environment.step(agent(timestep.observation))
  environment.physics.set_state(state, WHOLE)
  with pytest.raises(
    episode_clock.StepError, match='once an observer was given its'
  ):
    environment.step(agent(timestep.observation))


def test_time_stays_where_a_sensor_draws(load: Load, hover: Fixture) -> None:
  chosen = sensor.Sensor(dropped_share=0.1)
  environment = load(cameras=False, sensor=chosen, **AT_ONCE)
  here = hover(environment.reset().observation)
  state = environment.physics.get_state(WHOLE)
  environment.step(here)
  environment.physics.set_state(state, WHOLE)
  with pytest.raises(
    episode_clock.StepError, match='where a sensor spoils images'
  ):
    environment.step(here)


@pytest.mark.parametrize('copied', [copy.copy, copy.deepcopy, pickle.dumps])
def test_an_environment_says_that_it_cannot_be_copied(
  copied: Callable[[object], object], load: Load
) -> None:
  environment = load(cameras=False, observers=1)
  with pytest.raises(copies.CopyError, match='copy or pickle its `Scenario`'):
    copied(environment)
  environment.reset()
  for each in (environment, environment.task):
    with pytest.raises(copies.CopyError, match='cannot be copied or pickled'):
      copied(each)


@pytest.mark.parametrize('name', registry.SCENARIOS)
def test_a_scenario_can_be_copied_and_pickled(name: str) -> None:
  scene = registry.find(name, seed=3, sensor=sensor.Sensor(noise_sigma=2.0))
  for copied in (copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
    assert isinstance(copied, scenario.Scenario)
    assert copied == scene
    assert copied.performance.schedule.end_s == scene.performance.schedule.end_s
