"""The broadcast: one performer dances, observers read it and fly."""

from collections.abc import Sequence
import dataclasses

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import performer
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import (
  actions,
  episode_clock,
  fleet,
  flights,
  progress,
  safety,
  seeing,
  switches,
)
from waggle_tasks.tasks import parts as parts_lib

OBSERVATIONS = seeing.OBSERVATIONS


class Broadcast(seeing.Seeing):
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
    watching = {o.mjcf_model.model: o for o in parts.observers}
    self._dancers = parts.dancers
    dancing = {name: each.vehicle for name, each in self._dancers.items()}
    vehicles = fleet.Fleet(
      parts.room, {**dancing, **watching}, parts.poses, parts.dynamics,
      parts.agreement.frame_s,
    )  # fmt: skip
    super().__init__(parts.room, parts.agreement, watching, vehicles)

  @property
  def performer(self) -> performer.Performer:
    """The vehicle that dances."""
    return self._parts.performer

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
    self._begin(physics)
    for each in self._dancers.values():
      each.vehicle.perform(each.performance.schedule)
      each.vehicle.stop(each.performance.stop_s)
    self._begin_flights()

  def _begin_flights(self) -> None:
    """Lets every observer wait at its place."""
    self._flights = flights.Flights(self._parts, self._fleet.homes)
    self._rewards = [0.0] * len(self._seeing)
    self._contacts = ()

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
    super().before_step(physics, action, random_state)
    if self._clock.was_set(physics):
      self._replay(physics)
    time_s, middle_s = self._clock.time_s, self._clock.middle_s
    for name, dancer in self._dancers.items():
      home = self._fleet.homes[name]
      motion = dancer.vehicle.motion(
        np.array(home.position_m), home.yaw_rad, middle_s
      )
      self._fleet.command(physics, name, middle_s, motion)
    wanted = actions.read(action, [*self._seeing])
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

  def after_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Takes stock of the step."""
    super().after_step(physics, random_state)
    time_s = self._clock.time_s
    said_s = self._parts.performance.said_s
    authorised = self.sends_message and time_s >= said_s
    # Whether it moved is a matter of what it was told, whether it has arrived
    # one of truth.
    moved = self._fleet.steady(physics, time_s, told=not authorised)
    self._rewards = self._flights.update(*moved, authorised)

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

  def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
    """Whether this was the last step, see the class."""
    del physics
    return (
      bool(self._contacts)
      or self._clock.frame >= self.agreement.frames(self._parts.duration_s)
      or self._flights.done
    )
