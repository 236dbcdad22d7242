"""The law by which vehicles keep away from each other, each by itself.

Three parts, each a published method with the reason for it:

- `detours`: the way round those who stay, so that nobody is caught by them.
- `headings`: reciprocal velocities with passing on the right, so that those who
  meet make way for each other early, and nobody waits for ever.
- `cells`: buffered Voronoi cells of braking ways, so that nobody comes too near
  whatever the others choose. They alone would leave vehicles before each other.

Arrays have a row for each vehicle, and a row is made only of what it itself
knows: its own place and velocity, its goal, and its neighbours' places and
velocities and whether they avoid as well.
"""

import dataclasses

import numpy as np

from waggle_tasks import errors
from waggle_tasks.arenas import bounds
from waggle_tasks.protocol import checks, limits
from waggle_tasks.tasks import cells, detours, headings

# Within what vehicles of all dynamics can fly, with strength left for wind.
SPEED_MPS = 0.6 * limits.MAX_SPEED_MPS
ACCELERATION_MPS2 = 0.5 * min(
  each.sideways_mps2 for each in limits.LIMITS.values()
)
_CLOSING_S = 0.3  # The last of a way is flown ever slower.
_MARGIN_M = 0.02  # Beyond the spacing, from those who fly.
_ROUND_M = 0.04  # The same, of ways round those who stay.
_SAME_M = 0.001
# Later meetings are not minded yet. Who comes to rest by a stayer meets nobody.
_HORIZON_S, _STAYERS_S = 3.0, 0.9 * _CLOSING_S
_STAYS_MPS = 0.5  # Who hovers wanders at less, in any drift.
_ANGLES = np.radians(np.arange(0, 360, 30))
_SHARES = np.array([1.0, 0.5])
_TINY = 1e-9


class AvoidanceError(errors.WaggleError):
  """Places or velocities that are none."""


@dataclasses.dataclass(frozen=True)
class Law:
  """What is kept.

  Attributes:
    spacing_m: Smallest distance allowed between two vehicles.
    speed_mps: Greatest speed.
    acceleration_mps2: Greatest acceleration.
    low_m: (3,) lowest corner of the space that is flown in.
    high_m: (3,) its highest one.
  """

  spacing_m: float
  speed_mps: float = SPEED_MPS
  acceleration_mps2: float = ACCELERATION_MPS2
  low_m: tuple[float, float, float] = (
    0.2 - bounds.HALF_WIDTH_M, 0.2 - bounds.HALF_DEPTH_M, 0.2
  )  # fmt: skip
  high_m: tuple[float, float, float] = (
    bounds.HALF_WIDTH_M - 0.2, bounds.HALF_DEPTH_M - 0.2, bounds.HEIGHT_M - 0.2
  )  # fmt: skip

  def __post_init__(self) -> None:
    ranges = {
      'spacing_m': (0.01, 2.0),
      'speed_mps': (0.01, 10.0),
      'acceleration_mps2': (0.01, 100.0),
    }
    checks.settle_numbers(self, ranges, AvoidanceError)
    if not (np.array(self.low_m) < self.high_m).all():
      raise AvoidanceError(
        f'`low_m` must be below `high_m` {self.high_m}: got {self.low_m}'
      )


@dataclasses.dataclass(frozen=True, eq=False)
class Known:
  """What each of N vehicles knows.

  Attributes:
    places_m: (N, 3) its own place.
    velocities_mps: (N, 3) its own velocity.
    goals_m: (N, 3) where it should come to rest.
    others_m: (N, M, 3) its neighbours' places.
    others_mps: (N, M, 3) their velocities.
    yields: (N, M) whether a neighbour avoids as well.
    asked_mps: (N, 3) the velocity that it should have next if nobody were in
      the way; NaN where that is its own choice.
  """

  places_m: np.ndarray
  velocities_mps: np.ndarray
  goals_m: np.ndarray
  others_m: np.ndarray
  others_mps: np.ndarray
  yields: np.ndarray
  asked_mps: np.ndarray | None = None

  def __post_init__(self) -> None:
    if np.ndim(self.yields) != 2:
      raise AvoidanceError(
        f'`yields` must be booleans (N, M): got {self.yields!r}'
      )
    count, near = np.shape(self.yields)
    for field, shape in (
      ('places_m', (count, 3)), ('velocities_mps', (count, 3)),
      ('goals_m', (count, 3)), ('others_m', (count, near, 3)),
      ('others_mps', (count, near, 3)),
    ):  # fmt: skip
      value = np.asarray(getattr(self, field))
      if value.shape != shape or not np.isfinite(value).all():
        raise AvoidanceError(
          f'`{field}` must be finite numbers {shape}: got {value}'
        )

  @property
  def stays(self) -> np.ndarray:
    """(N, M) whether a neighbour neither avoids nor moves."""
    still = cells.length(self.others_mps) < _STAYS_MPS
    return ~np.asarray(self.yields) & still


def step(law: Law, known: Known, frame_s: float) -> np.ndarray:  # (N, 3)
  """The velocities at the end of the coming frame.

  Args:
    law: What is kept.
    known: What vehicles know.
    frame_s: How long the frame is; its acceleration is constant.
  """
  wanted_mps, left_m = _wishes(law, known)
  stays = known.stays
  ahead_s = np.minimum(_HORIZON_S, left_m / law.speed_mps + _CLOSING_S)
  chosen_mps = headings.choose(
    wanted_mps,
    known.velocities_mps,
    known.others_m - known.places_m[:, None],
    known.others_mps,
    known.yields,
    law.spacing_m + np.where(stays, 0.0, _MARGIN_M),
    np.where(stays, _STAYERS_S, ahead_s[:, None]),
    law.speed_mps,
  )
  return _nearest_safe(law, known, chosen_mps, frame_s)


def _wishes(law: Law, known: Known) -> tuple[np.ndarray, np.ndarray]:
  """What each would fly without movers (N, 3), and how far it has to (N,)."""
  velocities, left_m = np.zeros_like(known.places_m), []
  for row, (place_m, goal_m) in enumerate(
    zip(known.places_m, known.goals_m, strict=True)
  ):
    stayers_m = known.others_m[row][known.stays[row]]
    low_m, high_m = sorted((place_m[2], goal_m[2]))
    level = stayers_m[:, 2] > low_m - law.spacing_m
    level &= stayers_m[:, 2] < high_m + law.spacing_m
    stayers_m = stayers_m[level]
    free_m = detours.free_m(goal_m, place_m, stayers_m, law.spacing_m + _SAME_M)
    corners = detours.way(
      place_m[:2], free_m[:2], stayers_m[:, :2], law.spacing_m + _ROUND_M
    )
    legs_m = np.diff(np.stack([place_m[:2], *corners]), axis=0)
    lengths_m = np.hypot(*legs_m.T)
    # It climbs as evenly as it goes.
    share = lengths_m[0] / max(lengths_m.sum(), _TINY)
    climb_m = (free_m[2] - place_m[2]) * (share if len(corners) > 1 else 1.0)
    first = np.append(legs_m[0], climb_m)
    left_m.append(np.hypot(lengths_m.sum(), free_m[2] - place_m[2]))
    direct = len(corners) == 1 and free_m is goal_m
    if direct and known.asked_mps is not None:
      velocities[row] = known.asked_mps[row]
    if not direct or known.asked_mps is None or np.isnan(velocities[row, 0]):
      speed_mps = min(
        law.speed_mps,
        left_m[-1] / _CLOSING_S,
        float(np.sqrt(left_m[-1] * law.acceleration_mps2)),
      )
      velocities[row] = first * speed_mps / max(cells.length(first), _TINY)
  return velocities, np.array(left_m)


def _nearest_safe(
  law: Law, known: Known, chosen_mps: np.ndarray, frame_s: float
) -> np.ndarray:
  """Of what can be reached in a frame and is in its cell, the nearest."""
  places_m, brake = known.places_m, law.acceleration_mps2
  stops_m = cells.stops_m(places_m, known.velocities_mps, brake)
  theirs_m = cells.stops_m(known.others_m, known.others_mps, brake)
  walls = cells.joined(
    cells.between(
      (places_m, stops_m), (known.others_m, theirs_m), known.yields,
      law.spacing_m,
    ),
    cells.box(
      np.array(law.low_m), np.array(law.high_m),
      np.stack([places_m, stops_m], axis=1),
    ),
  )  # fmt: skip
  tried = _reachable(known.velocities_mps, chosen_mps, brake * frame_s)
  mean_mps = (known.velocities_mps[:, None] + tried) / 2
  ends_m = places_m[:, None] + mean_mps * frame_s
  fits = walls.hold(ends_m) & walls.hold(cells.stops_m(ends_m, tried, brake))
  fits &= cells.length(tried) <= law.speed_mps + _TINY
  fits[:, 0] = True  # To brake is always safe.
  off = np.where(fits, cells.length(tried - chosen_mps[:, None]), np.inf)
  return tried[np.arange(len(tried)), off.argmin(axis=1)]


def _reachable(
  velocities_mps: np.ndarray, chosen_mps: np.ndarray, most_mps: float
) -> np.ndarray:
  """Velocities (N, C, 3) within a change: braking first, then the chosen."""
  speeds = cells.length(velocities_mps)[:, None]
  braked = velocities_mps * np.maximum(
    1 - most_mps / np.maximum(speeds, _TINY), 0
  )
  change = chosen_mps - velocities_mps
  sizes = cells.length(change)[:, None]
  towards = velocities_mps + change * (most_mps / np.maximum(sizes, _TINY))
  towards = np.where(sizes <= most_mps, chosen_mps, towards)
  heading = np.arctan2(change[:, 1], change[:, 0])
  angles = heading[:, None, None] + _ANGLES[:, None]  # (N, A, 1)
  steps = most_mps * _SHARES * np.ones_like(angles)
  around = np.stack(
    [steps * np.cos(angles), steps * np.sin(angles), np.zeros_like(steps)], -1
  ).reshape(len(heading), -1, 3)
  several = [braked, towards, velocities_mps]
  around = velocities_mps[:, None] + around
  return np.concatenate([np.stack(several, axis=1), around], axis=1)
