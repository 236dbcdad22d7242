"""Roles: a vehicle, where it begins, what it dances, what it is there for."""

import dataclasses

from waggle_tasks.arenas import layouts
from waggle_tasks.entities import observer, performer
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import objectives


@dataclasses.dataclass(frozen=True, eq=False)
class Role:
  """One vehicle of a task.

  A vehicle with an eye, an `observer.Observer`, has observations, an action and
  a reward. Its action is followed unless it has a performance.

  Attributes:
    vehicle: The vehicle, which belongs to one task only.
    pose: Where it begins.
    performance: What it dances by itself, or None; without an eye it then
      hovers.
    objective: What it is rewarded for.
  """

  vehicle: performer.Performer
  pose: layouts.Pose
  performance: performance_lib.Performance | None = None
  objective: objectives.Objective = objectives.Arrive()

  @property
  def name(self) -> str:
    """The name of its vehicle's model."""
    return str(self.vehicle.mjcf_model.model)

  @property
  def sees(self) -> bool:
    """Whether it has an eye, and so an agent."""
    return isinstance(self.vehicle, observer.Observer)
