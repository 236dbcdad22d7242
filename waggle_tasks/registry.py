"""Tasks by name, and how one is built from a scenario."""

import dataclasses

from dm_control import composer
import mujoco

from waggle_tasks import runtime
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import checks, decoys
from waggle_tasks.tasks import broadcast, controls, copies
from waggle_tasks.tasks import parts as parts_lib

runtime.require_versions(mujoco.__version__)

Scenario = scenario_lib.Scenario


class Environment(copies.Uncopied, composer.Environment):
  """A composer environment that says why it cannot be copied."""


SCENARIOS = {
  'broadcast': Scenario(),
  'no_send': Scenario(control='no_send'),
  'black_input': Scenario(control='black_input'),
  'interrupted': Scenario(control='interrupted'),
  **{name: Scenario(control=name) for name in decoys.DECOYS},
}


def find(name: str, **changes: object) -> Scenario:
  """The scenario of a name, with some of its fields changed.

  Args:
    name: One of `SCENARIOS`.
    **changes: Fields of `Scenario` and their new values.

  Raises:
    ScenarioError: if the name or a field is not known, with the close ones,
      or if a value breaks a rule.
  """
  error = scenario_lib.ScenarioError
  checks.choice('task', name, [*SCENARIOS], error)
  fields = [field.name for field in dataclasses.fields(Scenario)]
  for field in changes:
    checks.choice('field', field, fields, error)
  return dataclasses.replace(SCENARIOS[name], **changes)


def build(scenario: Scenario) -> broadcast.Broadcast:
  """Builds the task of a scenario from new entities."""
  observers = tuple(
    observer.Observer(
      f'observer_{number + 1}',
      scenario.camera,
      scenario.eye_offset_m,
      scenario.sensor,
    )
    for number in range(scenario.observers)
  )
  parts = parts_lib.Parts(
    room=flight_room.FlightRoom(scenario.appearance),
    performer=performer.Performer(),
    observers=observers,
    poses=scenario.poses(),
    dance=scenario.schedule,
    message=scenario.message,
    duration_s=scenario.episode_s,
    units=scenario.units,
    jitter_m=scenario.jitter_m,
    drift=scenario.drift,
  )
  scenario.surroundings.furnish(parts.room, parts.poses)
  match scenario.control:
    case 'no_send':
      return controls.NoSend(parts)
    case 'black_input':
      return controls.BlackInput(parts, scenario.black_observer)
    case 'interrupted':
      return controls.Interrupted(parts, scenario.stop_s)
  if scenario.control in decoys.DECOYS:
    return controls.Decoy(parts)
  return broadcast.Broadcast(parts)


def environment(scenario: Scenario) -> Environment:
  """The environment of a scenario; close it in the thread that made it."""
  return Environment(
    build(scenario),
    random_state=scenario.seed,
    strip_singleton_obs_buffer_dim=True,
    recompile_mjcf_every_episode=False,
  )


def load(name: str, **changes: object) -> Environment:
  """Makes the environment of a named scenario.

  Args:
    name: One of `SCENARIOS`.
    **changes: Fields of `Scenario` and their new values.

  Returns:
    The environment; close it in the thread that made it.

  Raises:
    ScenarioError: see `find`.
  """
  return environment(find(name, **changes))
