"""What a task is made of: built entities and what both sides know."""

from collections.abc import Mapping, Sequence
import dataclasses

from waggle_tasks import errors
from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import crazyflie, observer, performer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks, limits
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import drift as drift_lib
from waggle_tasks.tasks import estimators
from waggle_tasks.tasks import safety as safety_lib


class PartsError(errors.WaggleError):
  """Vehicles that cannot be told apart, or have no place."""


@dataclasses.dataclass(frozen=True, eq=False)
class Dancer:
  """A vehicle that dances.

  Attributes:
    vehicle: The vehicle.
    performance: What it flies.
  """

  vehicle: performer.Performer
  performance: performance_lib.Performance


@dataclasses.dataclass(frozen=True, eq=False)
class Parts:
  """The built parts of one task; entities belong to one task only.

  Attributes:
    room: The arena.
    performer: The vehicle that dances for the observers.
    observers: The vehicles that watch.
    poses: Where each vehicle starts, by the name of its model.
    performance: What the performer flies, and what that says.
    duration_s: How long an episode lasts at most.
    agreement: What both sides know.
    jitter_m: Bound of each vehicle's initial x and y offset.
    minimum_spacing_m: Smallest distance allowed between two vehicles.
    drift: How far vehicles wander from their references.
    others: Vehicles that dance beside the performer.
    dynamics: One of `limits.DYNAMICS`, that which all vehicles were built for.
    air: What the air does, where vehicles have rotors.
    estimator: How they know where they are: one of `estimators.ESTIMATORS`.
    safety: What is done about flights that would meet: one of
      `safety_lib.SAFETIES`.
  """

  room: flight_room.FlightRoom
  performer: performer.Performer
  observers: tuple[observer.Observer, ...]
  poses: Mapping[str, layouts.Pose]
  performance: performance_lib.Performance
  duration_s: float
  agreement: agreement_lib.Agreement = agreement_lib.Agreement()
  jitter_m: float = 0.0
  minimum_spacing_m: float = safety_lib.MINIMUM_SPACING_M
  drift: drift_lib.Drift = drift_lib.Drift()
  others: tuple[Dancer, ...] = ()
  dynamics: str = 'ideal'
  air: air_lib.Air = air_lib.Air()
  estimator: str = 'none'
  safety: str = 'refuse'

  def __post_init__(self) -> None:
    vehicles = [self.performer, *self.observers]
    vehicles += [each.vehicle for each in self.others]
    names = [each.mjcf_model.model for each in vehicles]
    for name in names:
      if names.count(name) > 1:
        raise PartsError(f'each vehicle must have its own name: two are {name}')
      if name not in self.poses:
        raise PartsError(
          f'`poses` must hold one of every vehicle: there is none of {name},'
          f' only of {[*self.poses]}'
        )

    checks.choice('safety', self.safety, safety_lib.SAFETIES, PartsError)
    self._check_dynamics(vehicles)

  def _check_dynamics(self, vehicles: Sequence[crazyflie.Crazyflie]) -> None:
    """Refuses vehicles of other dynamics, and what theirs do not feel."""
    checks.choice('dynamics', self.dynamics, limits.DYNAMICS, PartsError)
    for each in vehicles:
      if each.spinning != (self.dynamics == 'rotors'):
        raise PartsError(
          f'`dynamics` of {each.mjcf_model.model} must be those of the task,'
          f' {self.dynamics!r}: it was built for others'
        )
    if self.dynamics == 'ideal' and not (
      self.air.rests and self.estimator == 'none'
    ):
      raise PartsError(
        "`air` and `estimator` must not be given with `dynamics` 'ideal', which"
        ' feel no air and know the truth'
      )

  @property
  def kept_m(self) -> float:
    """How far apart vehicles that avoid are kept."""
    wander_m = self.drift.near_m + estimators.near_m(self.estimator)
    return safety_lib.kept_m(wander_m, self.minimum_spacing_m)

  @property
  def dancers(self) -> dict[str, Dancer]:
    """All that dance, the performer first, by the name of their models."""
    first = Dancer(self.performer, self.performance)
    return {
      each.vehicle.mjcf_model.model: each for each in (first, *self.others)
    }
