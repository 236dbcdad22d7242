"""Tasks by name, changed field by field, with layouts of a user's own."""

from collections.abc import Callable
import dataclasses
import math
import os
import subprocess
import sys

from dm_control import composer
import numpy as np
import pytest

import waggle_tasks
from waggle_tasks import registry, scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import decoys, reference

Load = Callable[..., composer.Environment]


@dataclasses.dataclass(frozen=True)
class Ring:
  """Observers all around the performer."""

  radius_m: float = 1.3

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    angles = 2 * math.pi * np.arange(count) / count
    return tuple(
      layouts.facing_performer(
        self.radius_m * math.sin(angle), -self.radius_m * math.cos(angle)
      )
      for angle in angles
    )


@pytest.mark.slow
@pytest.mark.parametrize('name', registry.SCENARIOS)
def test_each_name_makes_an_environment_that_says_whether_it_sends(
  name: str, load: Load
) -> None:
  sends = name in ('broadcast', 'black_input')
  assert load(name).task.sends_message is sends


def test_every_name_is_covered_here() -> None:
  names = ['broadcast', 'no_send', 'black_input', 'interrupted']
  assert [*registry.SCENARIOS] == [*names, *decoys.DECOYS]


def test_the_package_loads_what_the_registry_does() -> None:
  environment = waggle_tasks.load('broadcast', observers=1, payload='111111')
  try:
    assert isinstance(environment, composer.Environment)
    assert len(environment.task.observers) == 1
  finally:
    environment.close()


@pytest.mark.parametrize(
  ('name', 'hint'),
  [
    ('brodcast', " got 'brodcast'. Did you mean broadcast?"),
    ('interupted', " got 'interupted'. Did you mean interrupted?"),
    ('zzz', " got 'zzz'."),
    ('', " got ''."),
  ],
)
def test_an_unknown_name_lists_all_and_the_close_ones(
  name: str, hint: str
) -> None:
  with pytest.raises(scenario.ScenarioError) as caught:
    waggle_tasks.load(name)
  names = [*registry.SCENARIOS]
  assert str(caught.value) == f'`task` must be one of {names}:{hint}'


def test_an_unknown_field_lists_the_close_ones() -> None:
  error = r"`field` must be one of .* got 'observer'. Did you mean observers"
  with pytest.raises(scenario.ScenarioError, match=error):
    registry.find('broadcast', observer=2)


def test_a_bad_value_is_refused_before_anything_is_built() -> None:
  with pytest.raises(scenario.ScenarioError, match='`observers` must be'):
    waggle_tasks.load('broadcast', observers=0)


def test_changes_reach_the_scenario_and_leave_the_table_alone() -> None:
  scene = registry.find('no_send', seed=7, layout='line')
  assert (scene.control, scene.seed, scene.layout) == ('no_send', 7, 'line')
  assert registry.find('no_send').seed == 0


@pytest.mark.slow
@pytest.mark.parametrize('count', [1, 3, 8])
def test_vehicles_stand_where_the_layout_puts_them(
  count: int, load: Load
) -> None:
  environment = load('broadcast', cameras=False, observers=count, layout=Ring())
  environment.reset()
  positions_m = environment.task.positions_m(environment.physics)
  names = ['performer', *(f'observer_{i}' for i in range(1, count + 1))]
  assert [*positions_m] == names
  expected = [(0, 0, 1.3), *(pose.position_m for pose in Ring().poses(count))]
  np.testing.assert_allclose([*positions_m.values()], expected, atol=1e-9)


@pytest.mark.slow
def test_a_layout_of_ones_own_runs_an_episode(load: Load) -> None:
  environment = load('broadcast', observers=4, layout=Ring(1.5), duration_s=0.4)
  timestep = environment.reset()
  steps = 0
  while not timestep.last():
    hovers = [
      reference.Reference.hover(each['position_m']).to_array()
      for each in timestep.observation
    ]
    timestep = environment.step(hovers)
    steps += 1
  assert steps == 10
  assert timestep.discount == 1
  images = [each['camera'] for each in timestep.observation]
  assert all(image.std() > 1 for image in images)


def test_a_room_that_is_too_small_is_said_so() -> None:
  error = '`pose` of observer_1 must lie in the room'
  with pytest.raises(layouts.LayoutError, match=error):
    waggle_tasks.load('broadcast', observers=64, layout='line')


@pytest.mark.slow
def test_the_seed_decides_the_jitter(load: Load) -> None:
  def begin(seed: int) -> np.ndarray:
    environment = load('broadcast', cameras=False, jitter_m=0.01, seed=seed)
    environment.reset()
    return np.stack(
      [*environment.task.positions_m(environment.physics).values()]
    )

  first, again, other = begin(3), begin(3), begin(4)
  np.testing.assert_array_equal(first, again)
  assert np.abs(first - other).max() > 1e-4
  still = np.array([p.position_m for p in scenario.Scenario().poses().values()])
  moved_m = np.abs(first - still)
  assert moved_m[:, :2].max() <= 0.01
  assert (moved_m[:, :2] > 0).all()
  np.testing.assert_allclose(moved_m[:, 2], 0, atol=1e-9)


def test_each_reset_draws_its_own_jitter(load: Load) -> None:
  environment = load('broadcast', cameras=False, jitter_m=0.01, observers=1)
  places_m = []
  for _ in range(2):
    environment.reset()
    positions_m = environment.task.positions_m(environment.physics)
    places_m.append(positions_m['observer_1'])
  assert np.abs(places_m[0] - places_m[1]).max() > 1e-4


@pytest.mark.slow
def test_dm_control_may_be_imported_first_where_there_is_no_display() -> None:
  """As sorted imports do; the GL backend must be chosen all the same."""
  code = (
    'from dm_control import composer, mjcf; import waggle_tasks;'
    "env = waggle_tasks.load('no_send', observers=1, duration_s=0.04);"
    "print(env.reset().observation[0]['camera'].shape); env.close()"
  )
  hidden = ('DISPLAY', 'WAYLAND_DISPLAY', 'MUJOCO_GL')
  environ = {k: v for k, v in os.environ.items() if k not in hidden}
  child = subprocess.run(
    [sys.executable, '-c', code],
    capture_output=True,
    text=True,
    check=False,
    env=environ,
  )
  assert child.stdout == '(480, 640, 3)\n', child.stderr
