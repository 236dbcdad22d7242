"""Messages are read through real cameras."""

import contextlib

import pytest

from waggle_tasks import registry
from waggle_tasks.agents import observer_agent, receiver
from waggle_tasks.experiments.record import scenario_fields


def read(name: str, **values: object) -> list[str]:
  """Everything that one observer reads of a dance, up to its first message."""
  scene = scenario_fields.make({'observers': 1, 'payload': '100110', **values})
  team = observer_agent.Team(1, name, scene.agreement)
  (agent,) = team.agents
  with contextlib.closing(registry.environment(scene)) as environment:
    timestep = environment.reset()
    while not timestep.last():
      action = team.step(timestep.observation)
      messages = [
        each.message.bits
        for each in agent.events
        if isinstance(each, receiver.Event) and each.message is not None
      ]
      if messages:
        return messages
      timestep = environment.step(action)
  return []


SMALL = {'camera_width_px': 320, 'camera_height_px': 240}
# A camera that is upside down, or looks up, is known to be.
MOUNTS = {
  'upside down': {'roll_deg': 180.0, **SMALL},
  'up and aslant': {'pitch_deg': 8.0, 'roll_deg': -20.0, **SMALL},
  'shaking': {'vibration_px': 1.0, **SMALL},
}


@pytest.mark.slow
@pytest.mark.parametrize(
  'mount',
  [
    'upside down',
    'up and aslant',
    pytest.param('shaking', marks=pytest.mark.long),
  ],
)
def test_a_message_is_read_however_the_camera_is_mounted(mount: str) -> None:
  assert read('joint', language='swift', **MOUNTS[mount]) == ['100110']


@pytest.mark.slow
def test_a_message_is_read_through_the_smallest_camera() -> None:
  assert read('joint', language='swift', eye='ai_deck') == ['100110']


@pytest.mark.long
@pytest.mark.parametrize('name', ['fpv', 'phone', 'webcam'])
def test_a_message_is_read_through_each_camera(name: str) -> None:
  if name == 'phone':
    pytest.importorskip('av')
  assert read('joint', language='swift', eye=name) == ['100110']


@pytest.mark.long
@pytest.mark.parametrize('name', ['ai_deck', 'fpv', 'webcam'])
def test_the_paper_s_language_is_read_through_each_camera(name: str) -> None:
  quick = {'half_width_m': 0.2, 'gesture_s': 4.0, 'settle_s': 0.9}
  assert read('view_bank', eye=name, **quick) == ['100110']


@pytest.mark.long
def test_a_message_is_read_before_clutter_by_a_camera_that_rolls() -> None:
  moving = {'rolling_deg': 2.0, 'walls': 'clutter'}
  assert read('joint', language='swift', **moving) == ['100110']


@pytest.mark.slow
def test_no_message_is_read_of_a_dance_that_is_none() -> None:
  scene = {'control': 'no_send', 'eye': 'ai_deck', 'duration_s': 4.0}
  assert read('joint', language='swift', **scene) == []
