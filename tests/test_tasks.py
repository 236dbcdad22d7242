"""Every task as an environment: specs, actions, and dm_env's own checks."""

from collections.abc import Callable
import math

from absl.testing import absltest
from dm_control import composer
from dm_env import specs, test_utils
import numpy as np
import pytest

from waggle_tasks import registry
from waggle_tasks.tasks import actions

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]

TASKS = ('broadcast', 'no_send', 'black_input', 'interrupted')


class Conformance(test_utils.EnvironmentTestMixin):
  """dm_env's own checks, over the end of an episode."""

  name = ''

  def make_object_under_test(self) -> composer.Environment:
    return registry.load(self.name, observers=2, duration_s=0.4)


class TestBroadcastConforms(Conformance, absltest.TestCase):
  name = 'broadcast'


class TestNoSendConforms(Conformance, absltest.TestCase):
  name = 'no_send'


class TestBlackInputConforms(Conformance, absltest.TestCase):
  name = 'black_input'


class TestInterruptedConforms(Conformance, absltest.TestCase):
  name = 'interrupted'


@pytest.mark.slow
@pytest.mark.parametrize('name', TASKS)
@pytest.mark.parametrize('observers', [2, 5])
def test_each_observer_has_its_observations_and_its_action(
  name: str, observers: int, load: Load, hover: Fixture
) -> None:
  environment = load(name, observers=observers)
  seen = environment.observation_spec()
  assert len(seen) == len(environment.action_spec()) == observers
  assert len(environment.reward_spec()) == observers
  for each in seen:
    assert {*each} == {'camera', 'time_s', 'position_m'}
    camera = each['camera']
    assert isinstance(camera, specs.BoundedArray)
    assert (camera.shape, camera.dtype) == ((480, 640, 3), np.uint8)
    assert (camera.minimum, camera.maximum) == (0, 255)
    assert (each['time_s'].shape, each['time_s'].dtype) == ((), np.float64)
    assert each['position_m'].shape == (3,)
    assert each['position_m'].dtype == np.float64
  for number, action in enumerate(environment.action_spec(), 1):
    assert action.name == f'observer_{number}'
    assert (action.shape, action.dtype) == ((13,), np.float64)
    assert np.isfinite(action.minimum).all()
    assert (action.minimum < action.maximum).all()
  for each, action in zip(
    hover(environment.reset().observation),
    environment.action_spec(),
    strict=True,
  ):
    action.validate(each)


def test_times_are_those_of_the_camera(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(cameras=False, duration_s=2.0)
  times_s = [
    float(each['time_s'])
    for timestep in episode(environment, hover)
    for each in timestep.observation[:1]
  ]
  np.testing.assert_allclose(times_s, 0.04 * np.arange(51), atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize('name', TASKS)
def test_a_random_agent_runs(name: str, load: Load, episode: Fixture) -> None:
  environment = load(name, duration_s=1.2)
  random_state = np.random.RandomState(0)
  spec = environment.action_spec()

  def agent(observations: list[dict[str, np.ndarray]]) -> list[np.ndarray]:
    del observations
    return [random_state.uniform(s.minimum, s.maximum) for s in spec]

  steps = [*episode(environment, agent)]
  assert steps[-1].last()
  for timestep in steps[1:]:
    assert {*timestep.reward} <= {-1.0, 0.0, 1.0}
    for each in timestep.observation:
      assert np.isfinite(each['position_m']).all()


@pytest.mark.parametrize('duration_s', [0.04, 0.4, 1.0, 26.0])
def test_an_episode_ends_with_its_time(
  duration_s: float, load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(cameras=False, observers=1, duration_s=duration_s)
  steps = len([*episode(environment, hover)]) - 1
  assert steps == round(duration_s * 25)


BAD_NUMBERS = [math.nan, math.inf, -math.inf]


@pytest.mark.parametrize(
  ('spoil', 'error'),
  [
    (lambda a: a[:1], 'one reference for each of 2 observers: got 1'),
    (lambda a: [*a, a[0]], 'one reference for each of 2 observers: got 3'),
    (lambda a: a[0], 'one reference for each of 2 observers: got 13'),
    (lambda a: [a[0], a[1][:12]], '`action` of observer_2 must be 13 finite'),
    (lambda a: [a[0][None], a[1]], '`action` of observer_1 must be 13 finite'),
    (lambda a: [a[0], None], '`action` of observer_2 must be 13 finite'),
  ]
  + [
    (
      lambda a, bad=bad: [a[0], np.append(a[1][:-1], bad)],
      rf'`action` of observer_2 must be 13 finite numbers: got [^`]*{bad}',
    )
    for bad in BAD_NUMBERS
  ],
)
def test_an_action_that_is_no_reference_is_refused(
  spoil: Callable[[list[np.ndarray]], object],
  error: str,
  load: Load,
  hover: Fixture,
) -> None:
  environment = load(cameras=False, observers=2)
  action = hover(environment.reset().observation)
  with pytest.raises(actions.ActionError, match=error):
    environment.step(spoil(action))
  timestep = environment.step(action)  # The environment goes on.
  assert float(timestep.observation[0]['time_s']) == pytest.approx(0.04)


def test_an_action_out_of_bounds_is_brought_within_them(load: Load) -> None:
  environment = load(cameras=False, observers=1)
  environment.reset()
  for _ in range(25):
    timestep = environment.step([np.full(13, 1e30)])
  (seen,) = timestep.observation
  spec = environment.action_spec()[0]
  assert (seen['position_m'] >= spec.minimum[:3]).all()
  assert (seen['position_m'] <= spec.maximum[:3]).all()
