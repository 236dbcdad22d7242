"""Tasks by name, and how one is built from a scenario."""

from dm_control import composer
import mujoco

from waggle_tasks import conversations, fidelity, runtime, scenarios
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import lenses, observer, performer
from waggle_tasks.tasks import broadcast, copies, furnish, roles
from waggle_tasks.tasks import parts as parts_lib

runtime.require_versions(mujoco.__version__)

SCENARIOS, find = scenarios.SCENARIOS, scenarios.find
Scenario = scenario_lib.Scenario


class Environment(copies.Uncopied, composer.Environment):
  """A composer environment that says why it cannot be copied."""


def parts(scenario: Scenario) -> parts_lib.Parts:
  """Builds the parts of a scenario's task, to be changed or added to.

  Those of a task with a second dancer are, for example,
  `dataclasses.replace(made, roles=(*made.roles, roles.Role(...)))`.
  """
  fidelity.check_rendered(scenario)
  agreement, poses = scenario.agreement, scenario.poses()
  observers = (
    observer.Observer(
      name,
      scenario.camera,
      scenario.eye_offset_m,
      sensor,
      agreement,
      scenario.dynamics,
      scenario.eye,
    )
    for name, sensor in zip(
      layouts.names(scenario.observers), scenario.sensors, strict=True
    )
  )
  dancer = performer.Performer(dynamics=scenario.dynamics)
  made = parts_lib.Parts(
    room=flight_room.FlightRoom(
      scenario.appearance,
      agreement=agreement,
      drawn_px=lenses.drawn(agreement.camera, scenario.eye).size,
    ),
    roles=(
      roles.Role(dancer, poses['performer'], scenario.performance),
      *(roles.Role(each, poses[each.mjcf_model.model]) for each in observers),
    ),
    duration_s=scenario.episode_s,
    agreement=agreement,
    jitter_m=scenario.jitter_m,
    drift=scenario.drift,
    dynamics=scenario.dynamics,
    air=scenario.air,
    estimator=scenario.estimator,
    safety=scenario.safety,
  )
  furnish.furnish(
    made.room, scenario.surroundings, poses, agreement,
    scenario.dynamics == 'rotors',
  )  # fmt: skip
  return made


def build(scenario: Scenario) -> broadcast.Broadcast:
  """Builds the task of a scenario from new entities."""
  return broadcast.Broadcast(parts(scenario))


def environment(scenario: Scenario) -> Environment:
  """The environment of a scenario; close it in the thread that made it."""
  return of_task(build(scenario), scenario.seed)


def of_task(task: composer.Task, seed: int = 0) -> Environment:
  """The environment of a task of one's own, as those of scenarios are.

  Args:
    task: The task.
    seed: Of the environment's random state.
  """
  return Environment(
    task,
    random_state=seed,
    strip_singleton_obs_buffer_dim=True,
    recompile_mjcf_every_episode=False,
  )


def load(name: str, **changes: object) -> Environment:
  """Makes the environment of a named scenario.

  Args:
    name: One of `SCENARIOS`, or 'conversation'.
    **changes: Fields of `Scenario`, or of `Conversation`, and their new values.

  Returns:
    The environment; close it in the thread that made it.

  Raises:
    ScenarioError: see `scenarios.find`.
  """
  if name == conversations.NAME:
    return of_task(*conversations.task(**changes))
  return environment(find(name, **changes))
