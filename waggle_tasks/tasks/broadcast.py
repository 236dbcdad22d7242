"""The broadcast: one performer dances, observers read it and fly."""

from collections.abc import Mapping
import dataclasses

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import performer
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.protocol import reference
from waggle_tasks.tasks import (
  episode_clock,
  flights,
  objectives,
  progress,
  safety,
  seeing,
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

  Rewards are a list of floats, by default 1 when an observer has arrived where
  the message says, and -1 when it first moves before the message is complete
  (`objectives.Arrive`). The discount is 0 on contact and 1 otherwise. The
  episode is over on contact, when every observer has arrived and held its place
  for 2 s, and at the end of the protocol's time.
  """

  def __init__(self, parts: parts_lib.Parts) -> None:
    """Puts the vehicles into the room.

    Args:
      parts: What the task is made of.

    Raises:
      PartsError: if nobody dances.
    """
    self._name = parts.performer
    super().__init__(parts)

  @property
  def performer(self) -> performer.Performer:
    """The vehicle that dances for the observers."""
    return self._parts.vehicles[self._name]

  @property
  def performance(self) -> performance_lib.Performance:
    """What it dances."""
    return self._parts.performances[self._name]

  def say(
    self, performance: performance_lib.Performance, duration_s: float
  ) -> None:
    """Lets the performer fly something else from the next reset on.

    Args:
      performance: What it flies, in the language that is agreed.
      duration_s: How long an episode lasts at most.
    """
    self._parts = dataclasses.replace(
      self._parts.saying(performance), duration_s=duration_s
    )

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """See `Seeing`; every observer waits at its place."""
    super().initialize_episode(physics, random_state)
    self._begin_flights()

  def _begin_flights(self) -> None:
    """Lets every observer wait at its place."""
    self._flights = flights.Flights(self._parts, self._fleet.homes)
    self._contacts = ()

  @property
  def sends_message(self) -> bool:
    """Whether this episode's dance is a whole message."""
    return self.performance.message is not None

  def _follow(
    self, physics: mjcf.Physics, wanted: Mapping[str, reference.Reference]
  ) -> dict[str, reference.Reference]:
    """See `Seeing`."""
    return self._flights.follow(
      wanted, self._fleet, physics, self._clock.time_s
    )

  def _replay(self, physics: mjcf.Physics) -> None:
    """See `Seeing`."""
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

  def _moments(self, physics: mjcf.Physics) -> dict[str, objectives.Moment]:
    """See `Seeing`."""
    time_s = self._clock.time_s
    authorised = self.sends_message and time_s >= self.performance.said_s
    # Whether it moved is a matter of what it was told, whether it has arrived
    # one of truth.
    moved = self._fleet.steady(physics, time_s, told=not authorised)
    return self._flights.update(*moved, authorised)

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

  def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
    """Whether this was the last step, see the class."""
    return super().should_terminate_episode(physics) or self._flights.done
