"""Where vehicles start: layouts are values that return poses.

World axes: x right and y away as the front observer sees them, z up. The
performer hovers above the origin and observers stand on the -y side, first to
last from -x to +x. The distance parameter is the radius of an arc and the
longitudinal separation of a line (paper, section 'Evaluation protocol').
"""

from collections.abc import Mapping, Sequence
import dataclasses
import itertools
import math
import sys
from typing import Protocol

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import agreement, checks

_USUAL_M = agreement.Agreement.hover_height_m  # A scenario may have another.
_DISTANCE_M = (0.001, 100.0)  # Smallest and largest.


class LayoutError(errors.WaggleError):
  """A layout's parameter, or the placement it leads to, breaks a rule."""


@dataclasses.dataclass(frozen=True)
class Pose:
  """A position and a heading.

  Attributes:
    position_m: World x, y and z.
    yaw_rad: Rotation about world z; at zero the nose points along +x.
    at_hover: Whether a scenario puts it at the height that it agrees on,
      whatever z is here.
  """

  position_m: tuple[float, float, float]
  yaw_rad: float
  at_hover: bool = dataclasses.field(default=False, compare=False, repr=False)

  def __post_init__(self) -> None:
    position_m = tuple(map(float, self.position_m))
    if len(position_m) != 3 or not all(map(math.isfinite, position_m)):
      raise LayoutError(
        f'`position_m` must be 3 finite numbers: got {position_m}'
      )
    checks.settle(self, 'position_m', position_m)
    endless = -math.inf, math.inf
    checks.settle_numbers(self, {'yaw_rad': endless}, LayoutError)

  def settled(self, height_m: float) -> 'Pose':
    """The pose where the agreed height is known; one of its own stays."""
    if not self.at_hover or self.position_m[2] != _USUAL_M:
      return self
    return Pose((*self.position_m[:2], height_m), self.yaw_rad)

  def moved(self, up_m: float, left_rad: float) -> 'Pose':
    """The pose higher up, and turned to the left."""
    if not up_m and not left_rad:
      return self
    x_m, y_m, z_m = self.position_m
    return Pose((x_m, y_m, z_m + up_m), self.yaw_rad + left_rad)


def names(count: int) -> list[str]:
  """What observers are called, in the order of their poses."""
  return [f'observer_{number}' for number in range(1, count + 1)]


class Layout(Protocol):
  """Whatever places observers around the performer."""

  def poses(self, count: int) -> tuple[Pose, ...]:
    """The poses of `observer_1` to `observer_{count}`, for any count >= 1."""
    ...


@dataclasses.dataclass(frozen=True)
class Arc:
  """Observers on an arc around the performer, evenly spaced, each facing it.

  Attributes:
    radius_m: Horizontal distance to the performer.
    half_span_rad: Angle from the middle of the arc to its end, 0 to pi; a
      single observer is in the middle.
    bearing_rad: Where the middle is as the performer sees it, -pi to pi; at
      zero straight ahead, positive towards +x.
  """

  radius_m: float = 1.3
  half_span_rad: float = math.radians(30.0)
  bearing_rad: float = 0.0

  def __post_init__(self) -> None:
    limits = {
      'radius_m': _DISTANCE_M,
      'half_span_rad': (0, math.pi),
      'bearing_rad': (-math.pi, math.pi),
    }
    checks.settle_numbers(self, limits, LayoutError)

  def poses(self, count: int) -> tuple[Pose, ...]:
    """The poses of `count` observers, see the class."""
    angles_rad = self.bearing_rad + self.half_span_rad * spread(count)
    return tuple(
      facing_performer(
        self.radius_m * math.sin(angle), -self.radius_m * math.cos(angle)
      )
      for angle in angles_rad
    )


@dataclasses.dataclass(frozen=True)
class Line:
  """Observers side by side on a line, each facing the performer.

  Attributes:
    separation_m: Distance from the performer to the line.
    spacing_m: Distance between neighbours; the paper gives none.
  """

  separation_m: float = 1.3
  spacing_m: float = 0.6

  def __post_init__(self) -> None:
    limits = {'separation_m': _DISTANCE_M, 'spacing_m': _DISTANCE_M}
    checks.settle_numbers(self, limits, LayoutError)

  def poses(self, count: int) -> tuple[Pose, ...]:
    """The poses of `count` observers, see the class."""
    half_length_m = self.spacing_m * (count - 1) / 2
    return tuple(
      facing_performer(x_m, -self.separation_m)
      for x_m in half_length_m * spread(count)
    )


def performer_pose() -> Pose:
  """The performer's hover, facing the front observer."""
  return _hovering(0.0, 0.0, -math.pi / 2)


def facing_performer(x_m: float, y_m: float) -> Pose:
  """The hover above a point of the floor, facing the performance area."""
  return _hovering(x_m, y_m, math.atan2(-y_m, -x_m))


def _hovering(x_m: float, y_m: float, yaw_rad: float) -> Pose:
  return Pose((x_m, y_m, _USUAL_M), yaw_rad, at_hover=True)


def spread(count: int) -> np.ndarray:
  """Even steps from one end of a layout to the other.

  Args:
    count: How many vehicles there are, at least 1.

  Returns:
    (count,) from -1 to 1; for a single vehicle the middle, 0.

  Raises:
    LayoutError: if there is no vehicle.
  """
  count = checks.integer('count', count, 1, sys.maxsize, LayoutError)
  return np.linspace(-1.0, 1.0, count) if count > 1 else np.zeros(1)


def jittered(
  poses: Sequence[Pose], bound_m: float, rng: np.random.RandomState
) -> tuple[Pose, ...]:
  """Moves poses by independent, uniform offsets in x and y; keeps headings.

  Args:
    poses: Where vehicles would start.
    bound_m: Largest offset along each axis; 0.01 in the paper's trials.
    rng: Gives two numbers for each pose, x before y.

  Returns:
    The moved poses, in the same order.

  Raises:
    LayoutError: if the bound is negative or not finite.
  """
  bound_m = checks.number('bound_m', bound_m, 0, _DISTANCE_M[1], LayoutError)
  offsets_m = np.zeros((len(poses), 3))  # (N, 3)
  offsets_m[:, :2] = rng.uniform(-bound_m, bound_m, (len(poses), 2))
  return tuple(
    Pose(tuple(pose.position_m + offset_m), pose.yaw_rad)
    for pose, offset_m in zip(poses, offsets_m, strict=True)
  )


def check_spacing(poses: Mapping[str, Pose], minimum_m: float) -> None:
  """Refuses a placement in which two vehicles are too close.

  Args:
    poses: Each vehicle's pose, by its name.
    minimum_m: Smallest distance allowed between two centres of mass.

  Raises:
    LayoutError: naming two vehicles, their distance and the rule.
  """
  for one, other in itertools.combinations(poses, 2):
    distance_m = math.dist(poses[one].position_m, poses[other].position_m)
    if distance_m < minimum_m:
      raise LayoutError(
        f'{one} and {other} must start at least {minimum_m:.3f} m apart:'
        f' got {distance_m:.3f} m'
      )
