"""Tasks by name, and how one is built from a scenario."""

from dm_control import composer
import mujoco

from waggle_tasks import runtime, scenarios
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import observer, performer
from waggle_tasks.tasks import broadcast, copies, furnish
from waggle_tasks.tasks import parts as parts_lib

runtime.require_versions(mujoco.__version__)

SCENARIOS, find = scenarios.SCENARIOS, scenarios.find
Scenario = scenario_lib.Scenario


class Environment(copies.Uncopied, composer.Environment):
  """A composer environment that says why it cannot be copied."""


def build(scenario: Scenario) -> broadcast.Broadcast:
  """Builds the task of a scenario from new entities."""
  agreement = scenario.agreement
  observers = tuple(
    observer.Observer(
      f'observer_{number}',
      scenario.camera,
      scenario.eye_offset_m,
      sensor,
      agreement,
    )
    for number, sensor in enumerate(scenario.sensors, 1)
  )
  parts = parts_lib.Parts(
    room=flight_room.FlightRoom(scenario.appearance, agreement=agreement),
    performer=performer.Performer(),
    observers=observers,
    poses=scenario.poses(),
    performance=scenario.performance,
    duration_s=scenario.episode_s,
    agreement=agreement,
    jitter_m=scenario.jitter_m,
    drift=scenario.drift,
  )
  furnish.furnish(parts.room, scenario.surroundings, parts.poses, agreement)
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
    ScenarioError: see `scenarios.find`.
  """
  return environment(find(name, **changes))
