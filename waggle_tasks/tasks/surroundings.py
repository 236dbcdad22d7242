"""What else moves in the room: other vehicles, and a board that passes."""

from collections.abc import Mapping
import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import checks
from waggle_tasks.tasks import safety

MAX_BYSTANDERS = 4
# Bystanders fly on circles of this radius, the middles of which may be this far
# from their places along each axis.
CIRCLE_M, SPREAD_M = 0.3, 0.04
# Those places, as the middle of the audience sees them: right, away from the
# performer, and up, from where it hovers. Two beside and two above it,
# all behind it, so far apart that they cannot meet wherever they are on their
# circles.
PLACES_M = (
  (-0.85, 1.3, -0.1), (0.85, 1.3, -0.1), (-0.8, 1.3, 0.75), (0.8, 1.3, 0.75)
)  # fmt: skip
# No other vehicle may come further back than this.
_BACK_M = 1.3 - SPREAD_M - CIRCLE_M - safety.MINIMUM_SPACING_M
# The nearest that the board passes the performer: outside of the dance.
BOARD_M = 0.45
_CLEAR_M = 0.1  # From an observer's centre to the board.
_WIDEST_RAD = math.radians(90)


class SurroundingsError(errors.WaggleError):
  """Surroundings for which there is no room."""


@dataclasses.dataclass(frozen=True)
class Surroundings:
  """What moves beside the performer and the observers.

  Attributes:
    bystanders: How many other Crazyflies fly behind the performer, 0 to 4.
    occluder_every_s: Mean time between two passes of a board before the
      performer, 5 to 600 s; 0 for no board. The seed sets when it passes.
    occluder_width_m: Width of the board, 0.02 to 1 m.
    occluder_mps: Speed of the board, 0.1 to 2 m/s.
  """

  bystanders: int = 0
  occluder_every_s: float = 0.0
  occluder_width_m: float = 0.15
  occluder_mps: float = 0.5

  def __post_init__(self) -> None:
    limits = {
      'bystanders': (0, MAX_BYSTANDERS),
      'occluder_every_s': (0 if self.occluder_every_s == 0 else 5, 600),
      'occluder_width_m': (0.02, 1),
      'occluder_mps': (0.1, 2),
    }
    checks.settle_numbers(self, limits, SurroundingsError)

  def check(self, poses: Mapping[str, layouts.Pose], reach_m: float) -> None:
    """Refuses vehicles in the way.

    Args:
      poses: Where the vehicles start, the performer first.
      reach_m: How far a message can lead an observer.

    Raises:
      SurroundingsError: naming the vehicle, the rule and the value.
    """
    audience = Audience.of(poses)
    if self.bystanders:
      for name, depth_m in audience.depths_m.items():
        if depth_m + reach_m > _BACK_M:
          raise SurroundingsError(
            f'`bystanders` must have the room behind the performer: {name} can'
            f' come {depth_m + reach_m:.2f} m behind it, over {_BACK_M:.2f} m'
          )
    if not self.occluder_every_s:
      return
    if audience.half_span_rad > _WIDEST_RAD:
      raise SurroundingsError(
        '`occluder_every_s` must be 0 for observers more than'
        f' {math.degrees(_WIDEST_RAD):g} degrees from their middle: got'
        f' {math.degrees(audience.half_span_rad):.1f} degrees'
      )
    if audience.nearest_m < BOARD_M + _CLEAR_M:
      raise SurroundingsError(
        '`occluder_every_s` must be 0 for observers nearer than'
        f' {BOARD_M + _CLEAR_M:g} m: got {audience.nearest_m:.2f} m'
      )


@dataclasses.dataclass(frozen=True)
class Audience:
  """How the observers stand around the performer.

  Attributes:
    bearing_rad: Their middle as the performer sees it: zero straight ahead,
      positive towards +x.
    half_span_rad: How far from there the outermost one is.
    nearest_m: Horizontal distance of the nearest one.
    depths_m: By name, how far behind the performer each is; negative in front.
  """

  bearing_rad: float
  half_span_rad: float
  nearest_m: float
  depths_m: Mapping[str, float]

  @classmethod
  def of(cls, poses: Mapping[str, layouts.Pose]) -> 'Audience':
    """Of the poses of all vehicles, the performer first."""
    (performer, *names) = poses
    centre_m = np.array(poses[performer].position_m[:2])
    places_m = np.array([poses[name].position_m[:2] for name in names])
    places_m = places_m - centre_m  # (N, 2)
    angles = np.arctan2(places_m[:, 0], -places_m[:, 1])
    # The middle of whole circles is straight ahead, whatever rounding says.
    mean = np.round(np.exp(1j * angles).mean(), 9)
    bearing_rad = float(np.angle(mean))
    away = np.array([-math.sin(bearing_rad), math.cos(bearing_rad)])
    off = np.angle(np.exp(1j * (angles - bearing_rad)))
    return cls(
      bearing_rad,
      float(np.abs(off).max()),
      float(np.linalg.norm(places_m, axis=1).min()),
      dict(zip(names, (places_m @ away).tolist(), strict=True)),
    )

  def place_m(self, right_m: float, away_m: float, up_m: float) -> np.ndarray:
    """(3,) world place of what the middle of the audience sees somewhere."""
    c, s = math.cos(self.bearing_rad), math.sin(self.bearing_rad)
    return np.array([right_m * c - away_m * s, right_m * s + away_m * c, up_m])
