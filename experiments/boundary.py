"""Shows that a receiver's events come from its own images and times alone.

Two experiments on one scenario. In the first, a second world differs in all
that a receiver could have peeked at: another payload, other positions of all
vehicles, another dance, and so other images for everybody; each receiver works
in that world beside teammates that see it, but is itself given the images that
it had in the first. Its events must not change. In the second, two observers'
images are swapped: their events must swap. Exit status 0 when both hold, 1
when not.
"""

from collections.abc import Callable, Sequence
import dataclasses
import sys
from typing import TYPE_CHECKING, Any

from absl import flags
import numpy as np
import tqdm

from waggle_tasks import errors, scenario
from waggle_tasks.agents import observer_agent, receiver, receivers
from waggle_tasks.experiments import (
  launch,
  receiver_flag,
  scenario_flags,
  table,
)
from waggle_tasks.protocol import checks, timing

if TYPE_CHECKING:
  import dm_env

scenario_flags.define()
_RECEIVER = receiver_flag.define()
_OTHER = flags.DEFINE_string(
  'other_payload', '110101', 'Six bits that the other world sends.'
)
_SWAP = flags.DEFINE_list('swap', ['1', '2'], 'Two observers, by number.')

Images = list[np.ndarray]
Events = list[list[receiver.Event]]


class SwapError(errors.WaggleError):
  """Observers that cannot be swapped."""


class _World:
  """An environment, its team, and what the team is shown instead."""

  def __init__(self, scene: scenario.Scenario, receiver_name: str) -> None:
    # Imported here: help needs no simulator.
    from waggle_tasks import registry

    self.team = observer_agent.Team(
      scene.observers, receiver_name, scene.agreement
    )
    self.environment = registry.environment(scene)
    self.timestep: dm_env.TimeStep = self.environment.reset()

  @property
  def images(self) -> Images:
    """What the observers' cameras see now, one for each."""
    return [each['camera'] for each in self.timestep.observation]

  def shown(self, images: Images) -> list[dict[str, np.ndarray]]:
    """What this world's observers observe, but for the images."""
    return [
      {**observation, 'camera': image}
      for observation, image in zip(
        self.timestep.observation, images, strict=True
      )
    ]

  def step(self, images: Images) -> None:
    """Lets the team act on images."""
    action = self.team.step(self.shown(images))
    if not self.timestep.last():
      self.timestep = self.environment.step(action)

  @property
  def seen(self) -> Events:
    """What each receiver saw so far."""
    return _seen(self.team)


class _Probe:
  """A team in another world, one of which has its images of its own world."""

  def __init__(
    self, scene: scenario.Scenario, receiver_name: str, index: int
  ) -> None:
    # Imported here: help needs no simulator.

    self.team = observer_agent.Team(
      scene.observers, receiver_name, scene.agreement
    )
    self._index = index

  def step(self, own: Images, foreign: _World) -> None:
    """Shows the team the other world, and one of it its own image."""
    images = foreign.images
    images[self._index] = own[self._index]
    self.team.step(foreign.shown(images))

  @property
  def seen(self) -> list[receiver.Event]:
    """What the one receiver saw so far."""
    return _seen(self.team)[self._index]


def _seen(team: observer_agent.Team) -> Events:
  return [
    [e for e in agent.events if isinstance(e, receiver.Event)]
    for agent in team.agents
  ]


def experiment(
  scene: scenario.Scenario,
  other: scenario.Scenario,
  receiver_name: str,
  swap: tuple[int, int],
  tick: Callable[[], object] = lambda: None,
) -> tuple[Events, Events, Events]:
  """Runs three worlds side by side.

  Args:
    scene: The scenario whose images are used.
    other: A scenario that differs in everything else.
    receiver_name: The receiver.
    swap: Indices of the observers whose images are swapped.
    tick: Called after each frame.

  Returns:
    For each observer its events: in its own world, in the other world with
    its own images, and in its own world with two observers' images swapped.
  """
  own, foreign = (_World(each, receiver_name) for each in (scene, other))
  swapped = _World(scene, receiver_name)
  probes = [
    _Probe(scene, receiver_name, index) for index in range(scene.observers)
  ]
  worlds = (own, foreign, swapped)
  order = list(range(scene.observers))
  order[swap[0]], order[swap[1]] = swap[1], swap[0]
  try:
    for _ in range(timing.frames(scene.episode_s)):
      images = own.images
      own.step(images)
      for probe in probes:
        probe.step(images, foreign)
      foreign.step(foreign.images)
      swapped.step([images[k] for k in order])
      tick()
      if own.timestep.last():
        break
  finally:
    for world in worlds:
      world.environment.close()
  return own.seen, [probe.seen for probe in probes], swapped.seen


def main(argv: Sequence[str]) -> int:
  """Runs both experiments and returns the exit status."""
  del argv
  scene = scenario_flags.read()
  receivers.make(_RECEIVER.value, scene.agreement)
  other = dataclasses.replace(
    scene, payload=_OTHER.value, jitter_m=0.01, seed=scene.seed + 1
  )
  if other.payload == scene.payload:
    raise SwapError(
      f'`other_payload` must differ from `payload`: got {other.payload}'
    )
  swap = _swap(scene.observers)
  with tqdm.tqdm(total=timing.frames(scene.episode_s), desc='frames') as bar:
    own, foreign, swapped = experiment(
      scene, other, _RECEIVER.value, swap, bar.update
    )
  expected = list(own)
  expected[swap[0]], expected[swap[1]] = own[swap[1]], own[swap[0]]
  rows = [
    (
      f'observer_{k + 1}',
      _message(own[k]),
      str(len(own[k])),
      'yes' if own[k] == foreign[k] else 'NO',
      _message(swapped[k]),
      'yes' if swapped[k] == expected[k] else 'NO',
    )
    for k in range(scene.observers)
  ]
  header = (
    'observer', 'message', 'events', f'same under {other.payload}',
    'message, swapped', 'swapped',
  )  # fmt: skip
  print(table.render(header, rows))
  holds = own == foreign and swapped == expected
  print('The boundary holds.' if holds else 'The boundary is BROKEN.')
  return 0 if holds else 1


def _swap(observers: int) -> tuple[int, int]:
  # Words that are no numbers are refused by the check below.
  numbers: list[Any] = [int(n) if n.isdecimal() else n for n in _SWAP.value]
  if len(numbers) != 2 or numbers[0] == numbers[1]:
    raise SwapError(f'`swap` must name two observers: got {_SWAP.value}')
  one, other = (
    checks.integer('swap', number, 1, observers, SwapError)
    for number in numbers
  )
  return one - 1, other - 1


def _message(events: Sequence[receiver.Event]) -> str:
  return next((e.message.bits for e in events if e.message), '-')


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
