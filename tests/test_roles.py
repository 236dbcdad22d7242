"""Any vehicle may see, dance and be rewarded for what its task says."""

from collections.abc import Callable
import dataclasses

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import conversation, conversations, registry
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import gestures, timing
from waggle_tasks.tasks import broadcast, objectives, parts, roles, talk

Fixture = Callable[..., object]
HURRIED = {
  'codebook': gestures.v_codebook(0.02, 0.08, duration_s=0.8),
  'pauses': timing.Timing(0.2, 0.0, 0.1, 0.0),
}


def made() -> parts.Parts:
  return registry.parts(registry.find('broadcast', observers=1, **HURRIED))


def blind(task: composer.Task) -> registry.Environment:
  for each in task.observers:
    each.observables.camera.enabled = False
  return registry.of_task(task)


def test_a_dancer_with_an_eye_sees_and_dances_whatever_its_agent_says(
  episode: Fixture, flyer: Fixture
) -> None:
  usual = made()
  sees = dataclasses.replace(
    usual.roles[0], vehicle=observer.Observer('performer')
  )
  task = broadcast.Broadcast(
    dataclasses.replace(usual, duration_s=8.0, roles=(sees, *usual.roles[1:]))
  )
  environment = blind(task)
  assert [each.name for each in environment.action_spec()] == [
    'performer', 'observer_1',
  ]  # fmt: skip
  away = flyer((0.4, 0.0, 0.0), 0.0)
  for timestep in episode(environment, away):
    assert len(timestep.observation) == 2
    place_m, rate, _ = task.performer.motion(
      np.array(sees.pose.position_m), sees.pose.yaw_rad,
      environment.physics.time(),
    )  # fmt: skip
    seen_m = timestep.observation[0]['position_m']
    assert np.abs(seen_m - place_m).max() < 0.004 + 0.05 * np.abs(rate).max()
  environment.close()


def test_a_vehicle_without_an_eye_or_a_dance_hovers(
  episode: Fixture, hover: Fixture
) -> None:
  usual = made()
  place = dataclasses.replace(usual.poses['performer'], position_m=(1, 0.5, 1))
  idle = roles.Role(performer.Performer('idle'), place)
  task = broadcast.Broadcast(
    dataclasses.replace(usual, duration_s=3.0, roles=(idle, *usual.roles))
  )
  environment = blind(task)
  for timestep in episode(environment, hover):
    assert len(timestep.observation) == 1
    where_m = task.positions_m(environment.physics)['idle']
    np.testing.assert_allclose(where_m, (1, 0.5, 1), atol=1e-3)
  assert task.sends_message
  environment.close()


@dataclasses.dataclass(frozen=True)
class Wary:
  """Rewarded for as long as nothing went wrong."""

  def reward(self, moment: objectives.Moment) -> float:
    return 0.25 - 5 * moment.trespassed


def test_an_objective_of_ones_own_is_what_a_vehicle_is_rewarded_for(
  episode: Fixture, flyer: Fixture
) -> None:
  usual = made()
  wary = dataclasses.replace(usual.roles[1], objective=Wary())
  task = broadcast.Broadcast(
    dataclasses.replace(usual, duration_s=2.0, roles=(usual.roles[0], wary))
  )
  environment = blind(task)
  steps = [*episode(environment, flyer((0.4, 0.0, 0.0), 0.2))]
  rewards = [each.reward[0] for each in steps[1:]]
  assert rewards.count(0.25) == len(rewards) - 1
  assert rewards.count(-4.75) == 1
  environment.close()


@pytest.mark.slow
def test_somebody_in_a_conversation_may_dance_by_itself(
  episode: Fixture, hover: Fixture
) -> None:
  usual = conversations.parts(conversation.Conversation(listeners=2))
  says = registry.find('broadcast', language='swift').performance
  dances = dataclasses.replace(usual.roles[0], performance=says)
  environment = blind(
    talk.Talk(
      dataclasses.replace(
        usual, duration_s=9.0, roles=(dances, *usual.roles[1:])
      )
    )
  )
  heights_m = np.array(
    [
      [each['position_m'][2] for each in timestep.observation]
      for timestep in episode(environment, hover)
    ]
  )
  assert np.ptp(heights_m[:, 0]) > 0.1
  assert np.ptp(heights_m[:, 1:]) < 0.005
  environment.close()
