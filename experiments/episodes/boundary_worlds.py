"""Worlds side by side, in which receivers get images of their own or not."""

from collections.abc import Callable

import dm_env
import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.agents import observer_agent, receiver

Images = list[np.ndarray]
Events = list[list[receiver.Event]]


class _World:
  """An environment, its team, and what the team is shown instead."""

  def __init__(self, scene: scenario.Scenario, receiver_name: str) -> None:
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
    for _ in range(scene.agreement.frames(scene.episode_s)):
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
