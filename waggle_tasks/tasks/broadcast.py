"""The broadcast: one performer dances, observers read it and fly."""

from collections.abc import Sequence
import dataclasses

from dm_control import mjcf
from dm_control.composer.observation import observable
from dm_env import specs
import numpy as np

from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import (
  actions,
  contacts,
  copies,
  episode_clock,
  fleet,
  flights,
  progress,
  safety,
  steps,
  switches,
)
from waggle_tasks.tasks import parts as parts_lib

OBSERVATIONS = ('camera', 'time_s', 'position_m')


class Broadcast(copies.Uncopied, steps.Framed):
  """Observers see a dance, each through its own eye, and fly its message.

  Observations are a list of dicts, one for each observer: `camera`
  (H, W, 3) uint8 of the agreed camera, `time_s` () float64 and `position_m`
  (3,) float64. Actions are a list of (13,) float64 arrays, see
  `reference.Reference`: the reference for the middle of the coming frame. What
  a reference asks for is judged by `safety`.

  Rewards are a list of floats: 1 when an observer has arrived where the
  message says, -1 when it first moves before the message is complete. The
  discount is 0 on contact and 1 otherwise. The episode is over on contact,
  when every observer has arrived and held its place for 2 s, and at the end
  of the protocol's time.
  """

  def __init__(self, parts: parts_lib.Parts) -> None:
    """Puts the vehicles into the room.

    Args:
      parts: What the task is made of.
    """
    self._parts = parts
    self._observers = {o.mjcf_model.model: o for o in parts.observers}
    self._dancers = parts.dancers
    dancing = {name: each.vehicle for name, each in self._dancers.items()}
    self._fleet = fleet.Fleet(
      parts.room, {**dancing, **self._observers}, parts.poses,
      parts.dynamics, parts.agreement.frame_s,
    )  # fmt: skip
    for visible in self.observables:
      for name in OBSERVATIONS:
        visible[name].enabled = True
    self.set_timesteps(self.agreement.frame_s, 1 / agreement_lib.STEPS_HZ)

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides know."""
    return self._parts.agreement

  @property
  def root_entity(self) -> flight_room.FlightRoom:
    """The arena."""
    return self._parts.room

  @property
  def fleet(self) -> fleet.Fleet:
    """The vehicles."""
    return self._fleet

  @property
  def performer(self) -> performer.Performer:
    """The vehicle that dances."""
    return self._parts.performer

  @property
  def observers(self) -> tuple[observer.Observer, ...]:
    """The vehicles that watch, in the order of observations and actions."""
    return tuple(self._observers.values())

  @property
  def observables(self) -> list[dict[str, observable.Observable]]:
    """For each observer what it may see; those of `OBSERVATIONS` are on."""
    everything = [
      each.observables.as_dict(fully_qualified=False)
      for each in self._observers.values()
    ]
    usual = [{name: all_[name] for name in OBSERVATIONS} for all_ in everything]
    return [{**a, **b} for a, b in zip(usual, everything, strict=True)]

  def say(
    self, performance: performance_lib.Performance, duration_s: float
  ) -> None:
    """Lets the performer fly something else from the next reset on.

    Args:
      performance: What it flies, in the language that is agreed.
      duration_s: How long an episode lasts at most.
    """
    self._parts = dataclasses.replace(
      self._parts, performance=performance, duration_s=duration_s
    )
    self._dancers = self._parts.dancers

  def after_compile(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Finds the vehicles' joints and actuators in the compiled model."""
    del random_state
    self._fleet.after_compile(physics)

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Places the vehicles and begins the dance.

    Raises:
      StepError: if the time step is not that which was compiled.
      ObservableError: if something is to be observed that nobody can see.
    """
    switches.check(self, self.observers, physics)
    self._fleet.place(physics, self._parts.jitter_m, random_state)
    drift, sways = self._parts.drift, {}
    for name, home in self._fleet.homes.items():
      draw = drift.performer if name in self._dancers else drift.observer
      sways[name] = draw(random_state, home.yaw_rad, self.agreement.rate_hz)
    self._fleet.let_drift(sways)
    self._fleet.begin(physics, self._parts, random_state)
    self._clock = episode_clock.EpisodeClock(physics, self.agreement)
    self._tell()
    for each in self._dancers.values():
      each.vehicle.perform(each.performance.schedule)
      each.vehicle.stop(each.performance.stop_s)
    self._begin_flights()

  def _tell(self) -> None:
    """Lets observers know what they take for their places."""
    errors_m = self._fleet.errors_m(self._clock.time_s)
    for name, each in self._observers.items():
      each.error_m = errors_m[name]

  def _begin_flights(self) -> None:
    """Lets every observer wait at its place."""
    self._flights = flights.Flights(self._parts, self._fleet.homes)
    self._rewards = [0.0] * len(self._observers)
    self._contacts: tuple[tuple[str, str], ...] = ()

  @property
  def sends_message(self) -> bool:
    """Whether this episode's dance is a whole message."""
    return self._parts.performance.message is not None

  def before_step(
    self,
    physics: mjcf.Physics,
    action: Sequence[np.ndarray],
    random_state: np.random.RandomState,
  ) -> None:
    """Commands the vehicles for the coming control step.

    Raises:
      ActionError: if the action is not one finite reference per observer.
      StepError: if the physics was set to a state that cannot be flown on.
    """
    del random_state
    self._touched = set[tuple[str, str]]()
    if self._clock.was_set(physics):
      self._replay(physics)
    time_s, middle_s = self._clock.time_s, self._clock.middle_s
    for name, dancer in self._dancers.items():
      home = self._fleet.homes[name]
      motion = dancer.vehicle.motion(
        np.array(home.position_m), home.yaw_rad, middle_s
      )
      self._fleet.command(physics, name, middle_s, motion)
    wanted = actions.read(action, [*self._observers])
    followed = self._flights.follow(wanted, self._fleet, physics, time_s)
    for name, each in followed.items():
      motion = each.position_m, each.velocity_mps, each.acceleration_mps2
      self._fleet.command(physics, name, middle_s, motion, each.turn_rad)

  def _replay(self, physics: mjcf.Physics) -> None:
    """Goes on from a time that the physics was set to."""
    if self._flights.begun:
      raise episode_clock.StepError(
        '`time` must not be set once an observer was given its command:'
        ' `reset` and play the actions again'
      )
    if any(each.is_spoilt for each in self.observers):
      raise episode_clock.StepError(
        '`time` must not be set where a sensor spoils images, as it draws on'
        ' and on: `load` again with the same seed and play the actions again'
      )
    self._clock.set(physics)
    self._begin_flights()
    physics.forward()

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
    time_s = self._clock.time_s
    said_s = self._parts.performance.said_s
    authorised = self.sends_message and time_s >= said_s
    # Whether it moved is a matter of what it was told, whether it has arrived
    # one of truth.
    moved = self._fleet.steady(physics, time_s, told=not authorised)
    self._rewards = self._flights.update(*moved, authorised)

  def positions_m(self, physics: mjcf.Physics) -> dict[str, np.ndarray]:
    """True position of every vehicle, (3,) world metres, by its name."""
    return self._fleet.positions_m(physics)

  def drifts_m(self) -> dict[str, np.ndarray]:
    """How far each vehicle is taken from its reference, (3,), by its name.

    What a vehicle was told to do is judged without it: nobody is told of it.
    """
    drifts = self._fleet.drifts(self._clock.time_s)
    return {name: place.copy() for name, (place, _) in drifts.items()}

  def attitudes_rad(self) -> dict[str, np.ndarray]:
    """Roll, pitch and yaw that each vehicle's hover gives it, (3,), by name."""
    return self._fleet.attitudes_rad(self._clock.time_s)

  @property
  def contacts(self) -> tuple[tuple[str, str], ...]:
    """Pairs of names that touched in the last step; 'room' is the arena."""
    return self._contacts

  @property
  def refusals(self) -> tuple[safety.Refusal, ...]:
    """The commands that the safety checks refused in this episode."""
    return self._flights.refusals

  @property
  def achieved(self) -> tuple[progress.Progress, ...]:
    """What each observer has achieved in this episode."""
    return self._flights.achieved

  def get_reward(self, physics: mjcf.Physics) -> list[float]:
    """One reward for each observer, see the class."""
    del physics
    return self._rewards

  def get_discount(self, physics: mjcf.Physics) -> float:
    """0 on contact, otherwise 1."""
    del physics
    return 0.0 if self._contacts else 1.0

  def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
    """Whether this was the last step, see the class."""
    del physics
    return (
      bool(self._contacts)
      or self._clock.frame >= self.agreement.frames(self._parts.duration_s)
      or self._flights.done
    )

  def action_spec(self, physics: mjcf.Physics) -> list[specs.BoundedArray]:
    """One reference for each observer: (13,) float64, bounded."""
    del physics
    return actions.specification([*self._observers])

  def get_reward_spec(self) -> list[specs.Array]:
    """One float for each observer."""
    return [specs.Array((), float, name=name) for name in self._observers]
