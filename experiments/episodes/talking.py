"""Holds a conversation: parts are cast, and the record sees the truth."""

from collections.abc import Callable
import gc

import numpy as np

from waggle_tasks import conversation, conversations, registry
from waggle_tasks.agents import member
from waggle_tasks.experiments.episodes import casting
from waggle_tasks.experiments.record import talk

# Looks on: the images of all members, and the time. It changes nothing.
Onlooker = Callable[[list[np.ndarray], float], None]


def hold(
  scene: conversation.Conversation, onlookers: tuple[Onlooker, ...] = ()
) -> talk.Talk:
  """Holds a conversation to its end.

  Args:
    scene: Its scenario.
    onlookers: Who looks on.
  """
  parts = casting.cast(scene)
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
  frames, danced = 0, np.zeros(len(party.members))
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
    danced += [each.saying for each in party.members]
    contacts |= {*task.contacts}
    off_m = np.linalg.norm((_places(environment) - homes)[:, :2], axis=1)
    drifts_m = task.fleet.drifts(frames * frame_s)
    off_m -= [np.linalg.norm(place[:2]) for place, _ in drifts_m.values()]
    waits = [each.order_s is None for each in party.members]
    aside_m = np.where(waits, np.maximum(aside_m, off_m), aside_m)
  return talk.Talk(
    scene,
    casting.told(scene),
    tuple(tuple(each.part.diary) for each in party.members),
    tuple(each.order_s for each in party.members),
    tuple(round(float(each), 6) for each in aside_m),
    tuple(sorted(contacts)),
    round(frames * frame_s, 6),
    tuple((danced * frame_s).round(6).tolist()),
  )


def _places(environment: registry.Environment) -> np.ndarray:
  """(N, 3) where all members truly are."""
  found = environment.task.positions_m(environment.physics)
  return np.array([*found.values()])
