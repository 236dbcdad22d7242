"""What tasks share in which vehicles see, and may touch nobody."""

from collections.abc import Mapping, Sequence

from dm_control import mjcf
from dm_control.composer.observation import observable
from dm_env import specs
import numpy as np

from waggle_tasks.arenas import flight_room
from waggle_tasks.entities import observer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.tasks import (
  actions,
  contacts,
  copies,
  episode_clock,
  steps,
)
from waggle_tasks.tasks import fleet as fleet_lib

OBSERVATIONS = ('camera', 'time_s', 'position_m')


class Seeing(copies.Uncopied, steps.Framed):
  """Vehicles that see, each through its own eye, and act by references.

  Observations are a list of dicts, one for each of them: `camera` (H, W, 3)
  uint8 of the agreed camera, `time_s` () float64 and `position_m` (3,) float64.
  Actions are a list of (13,) float64 arrays, see `reference.Reference`. The
  discount is 0 on contact and 1 otherwise.
  """

  def __init__(
    self,
    room: flight_room.FlightRoom,
    agreement: agreement_lib.Agreement,
    seeing: Mapping[str, observer.Observer],
    fleet: fleet_lib.Fleet,
  ) -> None:
    """Switches on what is to be seen.

    Args:
      room: The arena.
      agreement: What all know.
      seeing: Who sees, by the name of its model.
      fleet: All vehicles.
    """
    self._room, self._agreement = room, agreement
    self._seeing, self._fleet = dict(seeing), fleet
    for visible in self.observables:
      for name in OBSERVATIONS:
        visible[name].enabled = True
    self.set_timesteps(agreement.frame_s, 1 / agreement_lib.STEPS_HZ)

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What all know."""
    return self._agreement

  @property
  def root_entity(self) -> flight_room.FlightRoom:
    """The arena."""
    return self._room

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

  def _begin(self, physics: mjcf.Physics) -> None:
    """Begins an episode of vehicles that are in their places."""
    self._clock = episode_clock.EpisodeClock(physics, self._agreement)
    self._contacts: tuple[tuple[str, str], ...] = ()
    self._tell()

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
    """Forgets who touched before."""
    del physics, action, random_state
    self._touched = set[tuple[str, str]]()

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

  def action_spec(self, physics: mjcf.Physics) -> list[specs.BoundedArray]:
    """One reference for each of those that see: (13,) float64, bounded."""
    del physics
    return actions.specification([*self._seeing])

  def get_reward_spec(self) -> list[specs.Array]:
    """One float for each of those that see."""
    return [specs.Array((), float, name=name) for name in self._seeing]
