"""Where the members of a conversation hover, and whom each of them sees.

The seats are a part of what all agree on, so that each member knows in which
strip of its picture another one dances.
"""

from collections.abc import Sequence
import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import checks

# Of a strip about a member: narrower ones hold no dancer with what is around
# it, and wider ones nothing more of it.
LEAST_PX, MOST_PX = 32, 100
# As far as `swift` was read (docs/link.md).
FAR_M = 3.0


class SeatError(errors.WaggleError):
  """A seat that is none."""


@dataclasses.dataclass(frozen=True)
class Seat:
  """Where a member hovers.

  Attributes:
    x_m: World metres...
    y_m: ...and along the other axis.
    yaw_rad: Where its nose, and so its eye, points.
  """

  x_m: float
  y_m: float
  yaw_rad: float

  def __post_init__(self) -> None:
    bounds = {'x_m': (-100.0, 100.0), 'y_m': (-100.0, 100.0)}
    bounds['yaw_rad'] = (-math.inf, math.inf)
    checks.settle_numbers(self, bounds, SeatError)


@dataclasses.dataclass(frozen=True)
class View:
  """A member as another one sees it.

  Attributes:
    member: Its number.
    column_px: Where it is in the picture, from the left.
    half_px: Half the width of the strip in which nobody else is.
    distance_m: How far away it is.
  """

  member: int
  column_px: int
  half_px: int
  distance_m: float


def views(
  seats: Sequence[Seat], own: int, camera: camera_lib.Camera
) -> tuple[View, ...]:
  """Whom a member sees well enough to read, from left to right.

  Not who is out of the picture, farther than 3 m, or too near to another one
  in the picture.

  Args:
    seats: Those of all members.
    own: The number of the one who looks.
    camera: What it looks with.
  """
  found = {}
  for member, seat in enumerate(seats):
    column_px = math.nan if member == own else _column(seats[own], seat, camera)
    if 0 < column_px < camera.columns:
      found[member] = column_px
  out = []
  for member, column_px in sorted(found.items(), key=lambda pair: pair[1]):
    others = [abs(column_px - x) for m, x in found.items() if m != member]
    room_px = [column_px, camera.columns - column_px, MOST_PX * camera.zoom]
    half_px = int(min(*room_px, *(gap / 2 for gap in others)))
    distance_m = math.dist(*(_place(seats[k]) for k in (own, member)))
    if half_px >= LEAST_PX * camera.zoom and distance_m <= FAR_M:
      out.append(View(member, round(column_px), half_px, distance_m))
  return tuple(out)


def _place(seat: Seat) -> tuple[float, float]:
  return seat.x_m, seat.y_m


def _column(own: Seat, other: Seat, camera: camera_lib.Camera) -> float:
  """Where another one is in the picture; not a number behind the camera."""
  x_m, y_m = other.x_m - own.x_m, other.y_m - own.y_m
  c, s = math.cos(own.yaw_rad), math.sin(own.yaw_rad)
  ahead_m, left_m = c * x_m + s * y_m, c * y_m - s * x_m
  if ahead_m <= 0:
    return math.nan
  return camera.columns / 2 - camera.focal_px * left_m / ahead_m
