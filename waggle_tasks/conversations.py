"""Builds the task of a conversation, and its parts."""

import dataclasses
from typing import Any

from waggle_tasks import conversation, errors
from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import crazyflie, observer
from waggle_tasks.protocol import checks
from waggle_tasks.tasks import furnish, objectives, roles, talk
from waggle_tasks.tasks import parts as parts_lib

NAME = 'conversation'


def parts(scene: conversation.Conversation) -> parts_lib.Parts:
  """Builds the parts of a conversation's task, to be changed or added to."""
  agreement, poses = scene.accord.agreement, scene.poses()
  members = (
    observer.Observer(
      name,
      sensor=scene.sensor,
      agreement=agreement,
      dynamics=scene.dynamics,
      accent_rgba=crazyflie.AMBER,  # All may dance, and azure is hard to see.
    )
    for name in poses
  )
  made = parts_lib.Parts(
    room=flight_room.FlightRoom(scene.appearance, agreement=agreement),
    roles=tuple(
      roles.Role(each, pose, objective=objectives.KeepClear())
      for each, pose in zip(members, poses.values(), strict=True)
    ),
    duration_s=scene.episode_s,
    agreement=agreement,
    dynamics=scene.dynamics,
    drift=scene.drift,
  )
  furnish.furnish(
    made.room, scene.surroundings, poses, agreement, scene.dynamics == 'rotors'
  )
  return made


def build(scene: conversation.Conversation) -> talk.Talk:
  """Builds the task of a conversation from new entities."""
  return talk.Talk(parts(scene))


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
