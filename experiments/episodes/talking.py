"""Holds a conversation: parts are cast, and the record sees the truth."""

from collections.abc import Callable
import gc

import numpy as np

from waggle_tasks import conversation, conversations, registry
from waggle_tasks.agents import (
  caller,
  contender,
  listener,
  member,
  part,
  relay,
)
from waggle_tasks.experiments.record import talk
from waggle_tasks.protocol import letters

# Looks on: the images of all members, and the time. It changes nothing.
Onlooker = Callable[[list[np.ndarray], float], None]


def told(scene: conversation.Conversation) -> tuple[talk.Told, ...]:
  """What is to be told to whom."""
  if scene.mission == 'relay':
    return (talk.Told(0, scene.hops, scene.payload),)
  if scene.mission == 'ack':
    said = scene.bits or scene.payload
    audience = range(1, scene.listeners + 1)
    return tuple(talk.Told(0, each, said) for each in audience)
  return tuple(
    talk.Told(dancer, recipient, bits)
    for dancer in range(scene.dancers)
    for recipient, bits in scene.letters_of(dancer)
  )


def cast(scene: conversation.Conversation) -> list[part.Part]:
  """What each member does, by number."""
  accord, numbers = scene.accord, range(len(scene.poses()))
  if scene.mission == 'relay':
    first = letters.Letter(scene.payload, recipient=scene.hops)
    return [relay.Relay(accord, k, None if k else first) for k in numbers]
  if scene.mission == 'ack':
    said = scene.bits or scene.payload
    return [
      caller.Caller(accord, 0, said, scene.blind, scene.seed),
      *(listener.Listener(accord, k, scene.blind) for k in numbers[1:]),
    ]
  dancers = numbers[: scene.dancers]
  return [
    *(
      contender.Contender(
        accord, k, scene.letters_of(k), scene.seed, not scene.together
      )
      for k in dancers
    ),
    *(
      listener.Listener(accord, k, flies=False)
      for k in numbers[scene.dancers :]
    ),
  ]


def hold(
  scene: conversation.Conversation, onlookers: tuple[Onlooker, ...] = ()
) -> talk.Talk:
  """Holds a conversation to its end.

  Args:
    scene: Its scenario.
    onlookers: Who looks on.
  """
  parts = cast(scene)
  party = member.Party(scene.accord, parts)
  environment = registry.of_task(conversations.build(scene), scene.seed)
  try:
    return _play(scene, environment, party, onlookers)
  finally:
    environment.close()
    gc.collect()  # Environments are cycles, and large.


def _play(
  scene: conversation.Conversation,
  environment: registry.Environment,
  party: member.Party,
  onlookers: tuple[Onlooker, ...],
) -> talk.Talk:
  task = environment.task
  timestep = environment.reset()
  homes = _places(environment)
  aside_m = np.zeros(len(party.members))
  contacts: set[tuple[str, str]] = set()
  frames = danced = 0
  frame_s = task.agreement.frame_s
  while not timestep.last():
    action = party.step(timestep.observation)
    if party.done:
      break
    for onlooker in onlookers:
      images = [each['camera'] for each in timestep.observation]
      onlooker(images, frames * frame_s)
    timestep = environment.step(action)
    frames += 1
    danced += sum(each.saying for each in party.members)
    contacts |= {*task.contacts}
    off_m = np.linalg.norm((_places(environment) - homes)[:, :2], axis=1)
    drifts_m = task.fleet.drifts(frames * frame_s)
    off_m -= [np.linalg.norm(place[:2]) for place, _ in drifts_m.values()]
    waits = [each.order_s is None for each in party.members]
    aside_m = np.where(waits, np.maximum(aside_m, off_m), aside_m)
  return talk.Talk(
    scene,
    told(scene),
    tuple(tuple(each.part.diary) for each in party.members),
    tuple(each.order_s for each in party.members),
    tuple(round(float(each), 6) for each in aside_m),
    tuple(sorted(contacts)),
    round(frames * frame_s, 6),
    round(danced * frame_s, 6),
  )


def _places(environment: registry.Environment) -> np.ndarray:
  """(N, 3) where all members truly are."""
  found = environment.task.positions_m(environment.physics)
  return np.array([*found.values()])
