"""Where the members of a conversation hover, by its mission."""

from collections.abc import Sequence
import math

from waggle_tasks.arenas import layouts

# Two rows face each other, and each member stands between two of the other
# row: it sees them 25 degrees to either side, and nobody else, as those next to
# them are out of its picture.
_ROW_RAD = math.radians(25)
# Dancers beside each other behind their audience, in units of the distance:
# from each place others and audience are within a wide picture.
_DANCERS = {
  2: ((-0.45, 0.0), (0.45, 0.0)),
  3: ((-0.68, 0.0), (0.0, 0.41), (0.68, 0.0)),
  4: ((-0.73, -0.09), (-0.27, 0.41), (0.27, 0.41), (0.73, -0.09)),
}
MOST_DANCERS = max(_DANCERS)


def audience(count: int, layout: layouts.Layout) -> list[layouts.Pose]:
  """One who says something, and those about it."""
  return [layouts.performer_pose(), *layout.poses(count)]


def chain(hops: int, distance_m: float) -> list[layouts.Pose]:
  """A chain in which each sees its two neighbours alone.

  Args:
    hops: How often a letter is passed on; one member more.
    distance_m: From each to the next.
  """
  across_m = distance_m * math.cos(_ROW_RAD)
  along_m = distance_m * math.sin(_ROW_RAD)
  out = []
  for number in range(hops + 1):
    side = -1 if number % 2 else 1
    x_m = along_m * (number - hops / 2)
    out.append(_seat(x_m, side * across_m / 2, -side * math.pi / 2))
  return out


def dancers(
  count: int, listeners: int, distance_m: float, half_span_rad: float
) -> list[layouts.Pose]:
  """Several dancers and their audience.

  Args:
    count: How many dancers there are, 2 to 4.
    listeners: How many are in the audience.
    distance_m: Of the audience from the middle of the dancers.
    half_span_rad: How wide it stands.
  """
  stage = [(distance_m * x, distance_m * y) for x, y in _DANCERS[count]]
  arc = layouts.Arc(distance_m, half_span_rad).poses(listeners)
  watching = [(p.position_m[0], p.position_m[1]) for p in arc]
  everybody = [*stage, *watching]
  out = []
  for number, place in enumerate(everybody):
    seen = everybody if number < count else stage
    yaw_rad = _towards(place, [each for each in seen if each != place])
    out.append(_seat(*place, yaw_rad))
  return out


def _towards(
  own: tuple[float, float], others: Sequence[tuple[float, float]]
) -> float:
  """The middle of the narrowest view that holds all others."""
  angles = sorted(math.atan2(y - own[1], x - own[0]) for x, y in others)
  turn = 2 * math.pi
  nexts = [*angles[1:], angles[0] + turn]
  gaps = [after - before for before, after in zip(angles, nexts, strict=True)]
  widest = gaps.index(max(gaps))
  return (nexts[widest] + (turn - gaps[widest]) / 2 + math.pi) % turn - math.pi


def _seat(x_m: float, y_m: float, yaw_rad: float) -> layouts.Pose:
  z_m = layouts.performer_pose().position_m[2]
  return layouts.Pose((x_m, y_m, z_m), yaw_rad, at_hover=True)
