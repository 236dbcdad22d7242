"""A receiver gets images and times, and nothing else ever tells it anything."""

from collections.abc import Callable, Iterator, Mapping
import dataclasses
import inspect

import numpy as np
import pytest

from waggle_tasks import registry
from waggle_tasks.agents import observer_agent, receiver, receivers
from waggle_tasks.protocol import agreement

SHAPE = (480, 640, 3)


@pytest.mark.parametrize('name', receivers.RECEIVERS)
def test_a_receiver_takes_an_image_and_its_time(name: str) -> None:
  parameters = inspect.signature(receivers.RECEIVERS[name].step).parameters
  assert [*parameters] == ['self', 'image', 'time_s']
  reader = receivers.make(name)
  assert reader.step(np.zeros(SHAPE, np.uint8), 0.0) == ()


class Watched(Mapping):
  """An observation that notes what is taken from it."""

  def __init__(self, values: dict[str, object]) -> None:
    self._values = values
    self.taken: set[str] = set()

  def __getitem__(self, name: str) -> object:
    self.taken.add(name)
    return self._values[name]

  def __iter__(self) -> Iterator[str]:
    raise AssertionError('an agent looks at everything there is')

  def __len__(self) -> int:
    return len(self._values)


def test_an_agent_takes_its_image_time_and_position_only() -> None:
  truth = {'payload': '000010', 'phase': 'END', 'performer_m': (0, 0, 1.3)}
  seen = Watched(
    {
      'camera': np.zeros(SHAPE, np.uint8),
      'time_s': np.array(0.0),
      'position_m': np.array([0.0, -1.3, 1.3]),
      **truth,
    }
  )
  observer_agent.Team(1).step([seen])
  assert seen.taken == {'camera', 'time_s', 'position_m'}


@dataclasses.dataclass
class Tape:
  """A receiver that hands another's recorded images to a real one."""

  reader: receiver.Receiver
  clip: object
  events: list[receiver.Event] = dataclasses.field(default_factory=list)
  frames: int = 0

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    del image  # What this world would have shown.
    recorded = self.clip.images[self.frames]
    assert time_s == self.clip.times_s[self.frames]
    self.frames += 1
    events = self.reader.step(recorded, time_s)
    self.events += events
    return events


@pytest.mark.parametrize(
  'truth',
  [
    {'payload': '111111'},
    {'distance_m': 1.0, 'jitter_m': 0.05, 'seed': 7},
    {'layout': 'line', 'observers': 2},
    {'control': 'interrupted', 'stop_s': 4.0},
  ],
  ids=lambda truth: '-'.join(truth),
)
def test_the_same_images_under_another_truth_give_the_same_events(
  truth: dict[str, object],
  clip: object,
  short: dict[str, object],
  load: Callable[..., registry.composer.Environment],
) -> None:
  agreed = agreement.Agreement(**short)
  alone = receivers.make('klt', agreed)
  expected = [
    event
    for image, time_s in zip(clip.images, clip.times_s, strict=True)
    for event in alone.step(image, time_s)
  ]
  assert len(expected) == 5
  changes = short | {'observers': 1, 'duration_s': 15.8} | truth
  environment = load(cameras=False, **changes)
  team = observer_agent.Team(changes['observers'], 'klt', agreed)
  tape = Tape(receivers.make('klt', agreed), clip)
  team.agents[0].receiver = tape
  blank = np.zeros(SHAPE, np.uint8)
  timestep = environment.reset()
  while True:
    seen = [{**each, 'camera': blank} for each in timestep.observation]
    action = team.step(seen)
    if timestep.last():
      break
    timestep = environment.step(action)
  assert tape.events == expected
  assert tape.frames == len(clip.images)
