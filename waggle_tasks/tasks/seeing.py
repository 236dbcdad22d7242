"""What tasks share in which vehicles see, and may touch nobody."""

from collections.abc import Mapping, Sequence
import dataclasses

from dm_control import mjcf
from dm_control.composer.observation import observable
from dm_env import specs
import numpy as np

from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import observer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import reference
from waggle_tasks.tasks import (
  actions,
  contacts,
  copies,
  episode_clock,
  objectives,
  steps,
  switches,
)
from waggle_tasks.tasks import fleet as fleet_lib
from waggle_tasks.tasks import parts as parts_lib

OBSERVATIONS = ('camera', 'time_s', 'position_m')
_NOTHING = objectives.Moment()


class Seeing(copies.Uncopied, steps.Framed):
  """Vehicles that see, each through its own eye, and act by references.

  Observations are a list of dicts, one for each of them: `camera` (H, W, 3)
  uint8 of the agreed camera, `time_s` () float64 and `position_m` (3,) float64.
  Actions are a list of (13,) float64 arrays, see `reference.Reference`. Those
  of vehicles that dance by themselves are not followed. Rewards are a list of
  floats, see `roles.Role`. The discount is 0 on contact and 1 otherwise.
  """

  def __init__(self, parts: parts_lib.Parts) -> None:
    """Puts the vehicles into their room and switches on what is to be seen.

    Args:
      parts: What the task is made of.
    """
    self._parts = parts
    self._seeing = parts.observers
    self._fleet = fleet_lib.Fleet(parts)
    for visible in self.observables:
      for name in OBSERVATIONS:
        visible[name].enabled = True
    self.set_timesteps(self.agreement.frame_s, 1 / agreement_lib.STEPS_HZ)

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What all know."""
    return self._parts.agreement

  @property
  def root_entity(self) -> flight_room.FlightRoom:
    """The arena."""
    return self._parts.room

  @property
  def fleet(self) -> fleet_lib.Fleet:
    """The vehicles."""
    return self._fleet

  @property
  def observers(self) -> tuple[observer.Observer, ...]:
    """Those that see, in the order of observations and actions."""
    return tuple(self._seeing.values())

  @property
  def observables(self) -> list[dict[str, observable.Observable]]:
    """For each of them what it may see; those of `OBSERVATIONS` are on."""
    everything = [
      each.observables.as_dict(fully_qualified=False)
      for each in self._seeing.values()
    ]
    usual = [{name: all_[name] for name in OBSERVATIONS} for all_ in everything]
    return [{**a, **b} for a, b in zip(usual, everything, strict=True)]

  def after_compile(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Finds the vehicles' joints and actuators in the compiled model."""
    del random_state
    self._fleet.after_compile(physics)

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Places the vehicles and begins what is danced.

    Raises:
      StepError: if the time step is not that which was compiled.
      ObservableError: if something is to be observed that nobody can see.
    """
    switches.check(self, self.observers, physics)
    self._fleet.begin(physics, self._parts, random_state)
    self._clock = episode_clock.EpisodeClock(physics, self.agreement)
    self._contacts: tuple[tuple[str, str], ...] = ()
    self._tell()
    for name, performance in self._parts.performances.items():
      vehicle = self._parts.vehicles[name]
      vehicle.perform(performance.schedule)
      vehicle.stop(performance.stop_s)

  def _tell(self) -> None:
    """Lets those that see know what they take for their places."""
    errors_m = self._fleet.errors_m(self._clock.time_s)
    for name, each in self._seeing.items():
      each.error_m = errors_m[name]

  def before_step(
    self,
    physics: mjcf.Physics,
    action: Sequence[np.ndarray],
    random_state: np.random.RandomState,
  ) -> None:
    """Commands the vehicles for the coming control step.

    Raises:
      ActionError: if the action is not one finite reference for each of those
        that see.
      StepError: if the physics was set to a state that cannot be flown on.
    """
    del random_state
    self._touched = set[tuple[str, str]]()
    if self._clock.was_set(physics):
      self._replay(physics)
    middle_s = self._clock.middle_s
    for name in self._parts.performances:
      home = self._fleet.homes[name]
      motion = self._parts.vehicles[name].motion(
        np.array(home.position_m), home.yaw_rad, middle_s
      )
      self._fleet.command(physics, name, middle_s, motion)
    read = actions.read(action, [*self._seeing])
    wanted = dict(zip(self._seeing, read, strict=True))
    for name in self._parts.performances:
      wanted.pop(name, None)
    for name, each in self._follow(physics, wanted).items():
      motion = each.position_m, each.velocity_mps, each.acceleration_mps2
      self._fleet.command(physics, name, middle_s, motion, each.turn_rad)

  def _replay(self, physics: mjcf.Physics) -> None:
    """Goes on from a time that the physics was set to."""
    raise NotImplementedError

  def _follow(
    self, physics: mjcf.Physics, wanted: Mapping[str, reference.Reference]
  ) -> dict[str, reference.Reference]:
    """What controllers get for what agents ask for, by vehicle."""
    raise NotImplementedError

  def before_substep(
    self,
    physics: mjcf.Physics,
    action: Sequence[np.ndarray],
    random_state: np.random.RandomState,
  ) -> None:
    """Flies on, with dynamics that ask for it."""
    del action, random_state
    self._fleet.before_substep(physics)

  def after_substep(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Notices who touches, however short."""
    del random_state
    if physics.data.ncon:
      self._touched |= contacts.find(physics)

  def after_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Takes stock of the step."""
    del random_state
    self._clock.tick(physics)
    self._tell()
    self._contacts = tuple(sorted(self._touched))
    touched = {name for pair in self._touched for name in pair}
    moments = self._moments(physics)
    self._rewards = [
      role.objective.reward(
        dataclasses.replace(
          moments.get(role.name, _NOTHING), touched=role.name in touched
        )
      )
      for role in self._parts.roles
      if role.sees
    ]

  def _moments(self, physics: mjcf.Physics) -> dict[str, objectives.Moment]:
    """What has become of vehicles in this step, beside contacts."""
    del physics
    return {}

  def positions_m(self, physics: mjcf.Physics) -> dict[str, np.ndarray]:
    """True position of every vehicle, (3,) world metres, by its name."""
    return self._fleet.positions_m(physics)

  @property
  def contacts(self) -> tuple[tuple[str, str], ...]:
    """Pairs of names that touched in the last step; 'room' is the arena."""
    return self._contacts

  def get_discount(self, physics: mjcf.Physics) -> float:
    """0 on contact, otherwise 1."""
    del physics
    return 0.0 if self._contacts else 1.0

  def get_reward(self, physics: mjcf.Physics) -> list[float]:
    """What each of those that see gets by its objective."""
    del physics
    return self._rewards

  def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
    """Whether this was the last step: on contact and at the end of its time."""
    del physics
    last = self.agreement.frames(self._parts.duration_s)
    return bool(self._contacts) or self._clock.frame >= last

  def action_spec(self, physics: mjcf.Physics) -> list[specs.BoundedArray]:
    """One reference for each of those that see: (13,) float64, bounded."""
    del physics
    return actions.specification([*self._seeing])

  def get_reward_spec(self) -> list[specs.Array]:
    """One float for each of those that see."""
    return [specs.Array((), float, name=name) for name in self._seeing]
