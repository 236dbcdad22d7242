"""Where vehicles start: layouts are values that return poses.

World axes: x right and y away as the front observer sees them, z up. The
performer hovers above the origin and observers stand on the -y side (paper,
section "Evaluation protocol": the distance parameter is the radius of an arc
and the longitudinal separation of a line).
"""

from collections.abc import Sequence
import dataclasses
import itertools
import math
from typing import Protocol

import numpy as np

from waggle_tasks import errors

HOVER_HEIGHT_M = 1.3  # Paper, "Scene, sensors, and information boundaries".


class LayoutError(errors.WaggleError):
  """A layout's parameter or the spacing it leads to breaks a rule."""


@dataclasses.dataclass(frozen=True)
class Pose:
  """A position and a heading; a heading of zero looks along world +x.

  Attributes:
    position_m: x, y and z.
    yaw_rad: rotation about world z.
  """

  position_m: tuple[float, float, float]
  yaw_rad: float

  def __post_init__(self) -> None:
    position_m = tuple(float(value) for value in self.position_m)
    object.__setattr__(self, 'position_m', position_m)
    object.__setattr__(self, 'yaw_rad', float(self.yaw_rad))
    if len(position_m) != 3 or not np.all(np.isfinite(position_m)):
      raise LayoutError(
        f'`position_m` must be three finite numbers: got {position_m}.'
      )
    if not math.isfinite(self.yaw_rad):
      raise LayoutError(f'`yaw_rad` must be finite: got {self.yaw_rad}.')


class Layout(Protocol):
  """Anything that places observers around the performer."""

  def poses(self, count: int) -> tuple[Pose, ...]:
    """Returns the poses of `observer_1` to `observer_{count}`."""
    ...


@dataclasses.dataclass(frozen=True)
class Arc:
  """Observers on an arc around the performer, each facing it.

  Attributes:
    radius_m: horizontal distance to the performer.
    half_span_rad: angle between the middle and either end of the arc.
  """

  radius_m: float = 1.3
  half_span_rad: float = math.radians(30.0)

  def __post_init__(self) -> None:
    _check_positive('radius_m', self.radius_m)
    if not 0.0 < self.half_span_rad <= math.pi:
      raise LayoutError(
        '`half_span_rad` must be in (0, pi], that is (0, 180] degrees: '
        f'got {self.half_span_rad}.'
      )

  def poses(self, count: int) -> tuple[Pose, ...]:
    """Returns `count` poses from -x to +x, evenly spaced in angle."""
    return tuple(
      facing_performer(
        self.radius_m * math.sin(angle), -self.radius_m * math.cos(angle)
      )
      for angle in self.half_span_rad * _spread(count)
    )


@dataclasses.dataclass(frozen=True)
class Line:
  """Observers side by side on a line, each facing the performer.

  Attributes:
    separation_m: distance from the performer to the line.
    spacing_m: distance between neighbours; the paper gives none.
  """

  separation_m: float = 1.3
  spacing_m: float = 0.6

  def __post_init__(self) -> None:
    _check_positive('separation_m', self.separation_m)
    _check_positive('spacing_m', self.spacing_m)

  def poses(self, count: int) -> tuple[Pose, ...]:
    """Returns `count` poses from -x to +x, centred on the performer."""
    half_length_m = self.spacing_m * (count - 1) / 2.0
    return tuple(
      facing_performer(x_m, -self.separation_m)
      for x_m in half_length_m * _spread(count)
    )


def performer_pose() -> Pose:
  """Returns the performer's hover: above the origin, facing the observers."""
  return Pose((0.0, 0.0, HOVER_HEIGHT_M), -math.pi / 2.0)


def facing_performer(x_m: float, y_m: float) -> Pose:
  """Returns a hover above (x, y) that looks at the performance area."""
  return Pose((x_m, y_m, HOVER_HEIGHT_M), math.atan2(-y_m, -x_m))


def jittered(
  poses: Sequence[Pose], bound_m: float, rng: np.random.RandomState
) -> tuple[Pose, ...]:
  """Moves poses by independent uniform offsets in x and y, yaw unchanged.

  Args:
    poses: where the vehicles would start.
    bound_m: largest offset along each axis; the paper's runs use 0.01.
    rng: the environment's random state; draws two numbers a pose, in order.

  Returns:
    As many poses, in the same order.

  Raises:
    LayoutError: if the bound is negative or not finite.
  """
  if not (math.isfinite(bound_m) and bound_m >= 0.0):
    raise LayoutError(
      f'`bound_m` must be finite and not negative: got {bound_m}.'
    )
  offsets_m = rng.uniform(-bound_m, bound_m, size=(len(poses), 2))  # (N, 2)
  return tuple(
    Pose((x + dx, y + dy, z), pose.yaw_rad)
    for pose, (dx, dy) in zip(poses, offsets_m, strict=True)
    for x, y, z in [pose.position_m]
  )


def check_spacing(poses: dict[str, Pose], minimum_m: float) -> None:
  """Refuses a placement in which two vehicles are too close.

  Args:
    poses: vehicle name to pose.
    minimum_m: smallest distance allowed between two centres of mass.

  Raises:
    LayoutError: naming the two vehicles, their distance and the rule.
  """
  for (one, pose), (other, other_pose) in itertools.combinations(
    poses.items(), 2
  ):
    distance_m = math.dist(pose.position_m, other_pose.position_m)
    if distance_m < minimum_m:
      raise LayoutError(
        f'vehicles must start at least {minimum_m:.3f} m apart: '
        f'{one} and {other} are {distance_m:.3f} m apart.'
      )


def _spread(count: int) -> np.ndarray:  # (count,)
  """Returns even steps from -1 to 1, and 0 for a single vehicle."""
  if count < 1:
    raise LayoutError(f'`count` must be at least 1: got {count}.')
  return np.linspace(-1.0, 1.0, count) if count > 1 else np.zeros(1)


def _check_positive(field: str, value: float) -> None:
  if not (math.isfinite(value) and value > 0.0):
    raise LayoutError(f'`{field}` must be positive and finite: got {value}.')
