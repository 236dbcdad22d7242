"""Builds the task of a conversation."""

import dataclasses
from typing import Any

from waggle_tasks import conversation, errors
from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import crazyflie, observer
from waggle_tasks.protocol import checks
from waggle_tasks.tasks import furnish, talk

NAME = 'conversation'


def build(scene: conversation.Conversation) -> talk.Talk:
  """Builds the task of a conversation from new entities."""
  agreement, poses = scene.accord.agreement, scene.poses()
  members = tuple(
    observer.Observer(
      name,
      sensor=scene.sensor,
      agreement=agreement,
      dynamics=scene.dynamics,
      accent_rgba=crazyflie.AMBER,  # All may dance, and azure is hard to see.
    )
    for name in poses
  )
  room = flight_room.FlightRoom(scene.appearance, agreement=agreement)
  made = talk.TalkParts(
    room, members, poses, scene.episode_s, agreement, scene.dynamics,
    scene.drift,
  )  # fmt: skip
  task = talk.Talk(made)
  furnish.furnish(
    room, scene.surroundings, poses, agreement, scene.dynamics == 'rotors'
  )
  return task


def task(**changes: object) -> tuple[talk.Talk, int]:
  """The task of a conversation with some fields changed, and its seed.

  Raises:
    ScenarioError: if a field is not known, or a value breaks a rule.
  """
  fields = [f.name for f in dataclasses.fields(conversation.Conversation)]
  values: dict[str, Any] = changes
  for field in values:
    checks.choice('field', field, fields, errors.ScenarioError)
  scene = conversation.Conversation(**values)
  return build(scene), scene.seed
