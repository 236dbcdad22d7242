"""What a task is made of: built entities and what all of them know."""

from collections.abc import Sequence
import dataclasses
import functools

from waggle_tasks import errors
from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks, limits
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import drift as drift_lib
from waggle_tasks.tasks import estimators
from waggle_tasks.tasks import roles as roles_lib
from waggle_tasks.tasks import safety as safety_lib


class PartsError(errors.WaggleError):
  """Vehicles that cannot be told apart, or nobody who dances."""


@dataclasses.dataclass(frozen=True, eq=False)
class Parts:
  """The built parts of one task; entities belong to one task only.

  Attributes:
    room: The arena.
    roles: The vehicles and what they do. The first that dances is the
      performer, whose message tells the others where to fly.
    duration_s: How long an episode lasts at most.
    agreement: What all know.
    jitter_m: Bound of each vehicle's initial x and y offset.
    minimum_spacing_m: Smallest distance allowed between two vehicles.
    drift: How far vehicles wander from their references.
    dynamics: One of `limits.DYNAMICS`, that which all vehicles were built for.
    air: What the air does, where vehicles have rotors.
    estimator: How they know where they are: one of `estimators.ESTIMATORS`.
    safety: What is done about flights that would meet: one of
      `safety_lib.SAFETIES`.
  """

  room: flight_room.FlightRoom
  roles: tuple[roles_lib.Role, ...]
  duration_s: float
  agreement: agreement_lib.Agreement = agreement_lib.Agreement()
  jitter_m: float = 0.0
  minimum_spacing_m: float = safety_lib.MINIMUM_SPACING_M
  drift: drift_lib.Drift = drift_lib.Drift()
  dynamics: str = 'ideal'
  air: air_lib.Air = air_lib.Air()
  estimator: str = 'none'
  safety: str = 'refuse'

  def __post_init__(self) -> None:
    names = [role.name for role in self.roles]
    for name in names:
      if names.count(name) > 1:
        raise PartsError(f'each vehicle must have its own name: two are {name}')
    checks.choice('safety', self.safety, safety_lib.SAFETIES, PartsError)
    self._check_dynamics(self.roles)

  def _check_dynamics(self, roles: Sequence[roles_lib.Role]) -> None:
    """Refuses vehicles of other dynamics, and what theirs do not feel."""
    checks.choice('dynamics', self.dynamics, limits.DYNAMICS, PartsError)
    for role in roles:
      if role.vehicle.spinning != (self.dynamics == 'rotors'):
        raise PartsError(
          f'`dynamics` of {role.name} must be those of the task,'
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
  def poses(self) -> dict[str, layouts.Pose]:
    """Where each vehicle begins, by its name."""
    return {role.name: role.pose for role in self.roles}

  @property
  def kept_m(self) -> float:
    """How far apart vehicles that avoid are kept."""
    wander_m = self.drift.near_m + estimators.near_m(self.estimator)
    return safety_lib.kept_m(wander_m, self.minimum_spacing_m)

  @functools.cached_property
  def observers(self) -> dict[str, observer.Observer]:
    """All that see, by their names."""
    return {
      role.name: role.vehicle
      for role in self.roles
      if isinstance(role.vehicle, observer.Observer)
    }

  @functools.cached_property
  def vehicles(self) -> dict[str, performer.Performer]:
    """All vehicles, by their names."""
    return {role.name: role.vehicle for role in self.roles}

  @functools.cached_property
  def performances(self) -> dict[str, performance_lib.Performance]:
    """What each that has no agent flies, and each that dances, by their names.

    Who has neither an eye nor a performance hovers.
    """
    return {
      role.name: role.performance or performance_lib.Performance()
      for role in self.roles
      if role.performance is not None or not role.sees
    }

  @property
  def performer(self) -> str:
    """Who tells the others where to fly.

    Raises:
      PartsError: if nobody dances.
    """
    for role in self.roles:
      if role.performance is not None:
        return role.name
    raise PartsError('`roles` must hold one with a `performance`: none has one')

  def saying(self, performance: performance_lib.Performance) -> 'Parts':
    """The same with something else for the performer to dance."""
    changed = tuple(
      dataclasses.replace(role, performance=performance)
      if role.name == self.performer
      else role
      for role in self.roles
    )
    return dataclasses.replace(self, roles=changed)
