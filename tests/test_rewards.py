"""What an episode earns, when it ends, and what the controls show."""

from collections.abc import Callable
import dataclasses

from dm_control import composer, mjcf
import numpy as np
import pytest

from waggle_tasks import registry
from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import gestures, timing
from waggle_tasks.tasks import broadcast, parts, roles

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]

TASKS = ('broadcast', 'no_send', 'black_input', 'interrupted')
FORWARD = (0.0, 0.4, 0.0)
HURRIED = {
  'codebook': gestures.v_codebook(0.02, 0.08, duration_s=0.8),
  'pauses': timing.Timing(0.2, 0.0, 0.1, 0.0),
}
HURRIED_END_S = 0.2 + 8 * 0.8 + 7 * 0.1


@pytest.mark.slow
@pytest.mark.parametrize('observers', [1, 3])
def test_flying_the_message_earns_one_and_ends_the_episode(
  observers: int, load: Load, episode: Fixture, flyer: Fixture
) -> None:
  environment = load(
    cameras=False, observers=observers, duration_s=20.0, **HURRIED
  )
  steps = [*episode(environment, flyer(FORWARD, HURRIED_END_S))]
  rewards = np.array([each.reward for each in steps[1:]])  # (T, N)
  assert [*rewards.sum(axis=0)] == [1.0] * observers
  assert np.count_nonzero(rewards) == observers
  arrival_s = 0.04 * (1 + rewards[:, 0].argmax())
  assert arrival_s == pytest.approx(HURRIED_END_S + 3.14, abs=0.08)
  # Held for 2 s and a little more, and then there is nothing left to do.
  assert 2.0 <= 0.04 * len(rewards) - arrival_s < 2.4
  assert all(each.discount == 1 for each in steps[1:])


@pytest.mark.slow
@pytest.mark.parametrize(
  ('bits', 'offset_m'),
  [
    ('000110', (-0.2828, 0.2828, 0)),
    ('001010', (-0.4, 0, 0)),
    ('100010', (0, -0.4, 0)),
  ],
)
def test_the_reward_is_where_the_message_says(
  bits: str,
  offset_m: tuple[float, ...],
  load: Load,
  episode: Fixture,
  flyer: Fixture,
) -> None:
  earned = []
  for offset in (offset_m, FORWARD):
    environment = load(
      cameras=False, observers=1, payload=bits, duration_s=12.0, **HURRIED
    )
    steps = [*episode(environment, flyer(offset, HURRIED_END_S))]
    earned.append(sum(each.reward[0] for each in steps[1:]))
  assert earned == [1.0, 0.0]


@pytest.mark.slow
def test_moving_before_the_message_is_complete_costs_one(
  load: Load, episode: Fixture, flyer: Fixture
) -> None:
  environment = load(cameras=False, duration_s=14.0, **HURRIED)
  steps = [*episode(environment, flyer(FORWARD, 2.0))]
  rewards = np.array([each.reward for each in steps[1:]])
  assert [*rewards.sum(axis=0)] == [-1.0] * 3
  first_s = 0.04 * (1 + rewards[:, 0].argmin())
  assert 2.0 < first_s < 3.5
  # It is where the message says at the end, and that earns nothing more.
  assert 0.04 * len(rewards) == pytest.approx(14.0)


@pytest.mark.slow
@pytest.mark.parametrize('name', ['no_send', 'interrupted'])
def test_without_a_message_flying_only_costs(
  name: str, load: Load, episode: Fixture, flyer: Fixture
) -> None:
  changes = {'stop_s': 3.0} if name == 'interrupted' else {}
  environment = load(
    name, cameras=False, observers=1, duration_s=14.0, **HURRIED, **changes
  )
  steps = [*episode(environment, flyer(FORWARD, HURRIED_END_S))]
  assert [each.reward[0] for each in steps[1:]].count(-1.0) == 1
  assert sum(each.reward[0] for each in steps[1:]) == -1.0


@pytest.mark.slow
@pytest.mark.parametrize('name', TASKS)
def test_hovering_earns_nothing(
  name: str, load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(name, cameras=False, duration_s=8.0, **HURRIED)
  steps = [*episode(environment, hover)]
  assert all(each.reward == [0.0] * 3 for each in steps[1:])


def test_contact_ends_the_episode_with_discount_zero(
  load: Load, episode: Fixture, hover: Fixture, flyer: Fixture
) -> None:
  environment = load(cameras=False, observers=1, duration_s=20.0)
  steps = [*episode(environment, flyer((0.0, 0.0, -1.3), 0.0))]
  assert steps[-1].discount == 0
  assert all(each.discount == 1 for each in steps[1:-1])
  assert 0.04 * (len(steps) - 1) < 4.0
  assert environment.task.contacts == (('observer_1', 'room'),)
  assert environment.step(hover(steps[-1].observation)).first()
  assert environment.step(hover(steps[0].observation)).discount == 1


def test_a_graze_of_milliseconds_within_a_step_counts(
  load: Load, hover: Fixture
) -> None:
  environment = load('no_send', cameras=False, observers=1)
  observations = environment.reset().observation
  (vehicle,) = environment.task.observers
  home_m = observations[0]['position_m'].copy()
  low_m, substeps = np.array([*home_m[:2], 0.0]), []

  def dip(physics: mjcf.Physics, *_: object) -> None:
    substeps.append(physics.time())
    place_m = low_m if len(substeps) == 3 else home_m
    vehicle.set_pose(physics, position=place_m)
    vehicle.set_velocity(physics, np.zeros(3), np.zeros(3))

  environment.add_extra_hook('before_substep', dip)
  timestep = environment.step(hover(observations))
  assert len(substeps) == 10  # Each physics step of the control step.
  assert timestep.discount == 0
  assert environment.task.contacts == (('observer_1', 'room'),)


def test_a_second_dancer_needs_a_name() -> None:
  made = registry.parts(registry.find('no_send', observers=1))
  dancer = roles.Role(performer.Performer(), made.poses['performer'])
  error = 'must have its own name: two are performer'
  with pytest.raises(parts.PartsError, match=error):
    dataclasses.replace(made, roles=(*made.roles, dancer))


def test_a_broadcast_needs_somebody_who_dances() -> None:
  made = registry.parts(registry.find('no_send', observers=1))
  nobody = dataclasses.replace(made, roles=made.roles[1:])
  with pytest.raises(parts.PartsError, match='must hold one with a'):
    broadcast.Broadcast(nobody)


def test_two_vehicles_that_touch_are_named(
  episode: Fixture, hover: Fixture, flyer: Fixture
) -> None:
  """Without safety, as the checks would refuse the way."""
  scene = registry.find('broadcast', observers=2, **HURRIED)
  audience = {
    'observer_1': layouts.facing_performer(-0.2, -1.3),
    'observer_2': layouts.facing_performer(0.2, -1.3),
  }
  dancer = performer.Performer()
  task = broadcast.Broadcast(
    parts.Parts(
      room=flight_room.FlightRoom(),
      roles=(
        roles.Role(dancer, layouts.performer_pose(), scene.performance),
        *(roles.Role(observer.Observer(n), p) for n, p in audience.items()),
      ),
      duration_s=10.0,
      minimum_spacing_m=0.0,
    )
  )
  for each in task.observers:
    each.observables.camera.enabled = False
  environment = composer.Environment(task, strip_singleton_obs_buffer_dim=True)
  to_the_right = flyer((0.4, 0.0, 0.0), 0.0)

  def agent(observations: list[dict[str, np.ndarray]]) -> list[np.ndarray]:
    return [to_the_right(observations)[0], hover(observations)[1]]

  *_, last = episode(environment, agent)
  assert last.discount == 0
  assert environment.task.contacts == (('observer_1', 'observer_2'),)
  environment.close()


def test_nobody_moves_when_nothing_is_sent(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load('no_send', cameras=False)
  task = environment.task
  places = []
  for timestep in episode(environment, hover):
    assert len(timestep.observation) == 3
    positions_m = task.positions_m(environment.physics)
    places.append(np.stack([*positions_m.values()]))
  assert len(places) == 251  # 10 s.
  np.testing.assert_allclose(places, [places[0]] * 251, atol=1e-4)
  assert not task.sends_message


@pytest.mark.slow
@pytest.mark.parametrize('black', [1, 2, 3])
def test_one_observer_sees_only_black(
  black: int, load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load('black_input', black_observer=black, duration_s=0.2)
  for _ in range(2):
    for timestep in episode(environment, hover):
      brightest = [each['camera'].max() for each in timestep.observation]
      assert brightest[black - 1] == 0
      assert min(brightest[: black - 1] + brightest[black:]) > 100


@pytest.mark.slow
@pytest.mark.parametrize('stop_s', [0.1, 0.5, 3.0, 4.02])
def test_a_performer_that_is_stopped_brakes_and_hovers(
  stop_s: float, load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load(
    'interrupted', cameras=False, stop_s=stop_s, duration_s=6.0, **HURRIED
  )
  free = load('broadcast', cameras=False, duration_s=6.0, **HURRIED)
  places = []
  for each in (environment, free):
    rows = [
      each.task.positions_m(each.physics)['performer']
      for _ in episode(each, hover)
    ]
    places.append(np.stack(rows))
  stopped, danced = places
  until = int(stop_s * 25)
  np.testing.assert_allclose(stopped[:until], danced[:until], atol=1e-9)
  rest = stopped[int((stop_s + 1.4) * 25) :]
  np.testing.assert_allclose(rest, [rest[0]] * len(rest), atol=1e-3)
  assert not environment.task.sends_message
  assert free.task.sends_message
