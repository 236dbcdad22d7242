"""Cells of braking paths: where each vehicle may go, whatever others choose.

Buffered Voronoi cells (Zhou, Wang, Bandyopadhyay and Schwager, Fast, on-line
collision avoidance for dynamic vehicles using buffered Voronoi cells, RA-L
2017, doi:10.1109/LRA.2017.2656241), drawn not between the places of two
vehicles but between the ways on which they could brake to rest: one plane
midway between these, at half of the spacing from each. Whoever keeps its next
braking way on its own side can always brake, and so nobody ever comes nearer.

All arrays have a row for each of N vehicles, and what a row says is that
vehicle's own knowledge: of its M neighbours, and of nobody else.
"""

import dataclasses

import numpy as np

_TINY = 1e-9
_SLACK_M = 1e-6  # Rounding.


@dataclasses.dataclass(frozen=True, eq=False)
class Cells:
  """For each of N vehicles K planes that it stays behind.

  Attributes:
    normals: (N, K, 3) of length 1; of zeros where there is no plane.
    offsets_m: (N, K).
  """

  normals: np.ndarray
  offsets_m: np.ndarray

  def hold(self, points_m: np.ndarray) -> np.ndarray:
    """Whether points (N, C, 3) are within them, (N, C)."""
    ahead_m = points_m @ self.normals.swapaxes(1, 2)  # (N, C, K)
    return (ahead_m <= self.offsets_m[:, None] + _SLACK_M).all(axis=2)


def stops_m(
  places_m: np.ndarray, velocities_mps: np.ndarray, brake_mps2: float
) -> np.ndarray:
  """Where vehicles (..., 3) come to rest if they brake straight ahead."""
  speeds_mps = length(velocities_mps)[..., None]
  return places_m + velocities_mps * speeds_mps / (2 * brake_mps2)


def between(
  ways_m: tuple[np.ndarray, np.ndarray],  # (N, 3) begin and end
  others_m: tuple[np.ndarray, np.ndarray],  # (N, M, 3)
  yields: np.ndarray,  # (N, M)
  spacing_m: float,
) -> Cells:
  """The cells between each vehicle's braking way and those of its neighbours.

  A neighbour that does not yield leaves all of the spacing to the vehicle. Who
  is nearer already is not pushed away, only kept from coming nearer.

  Args:
    ways_m: Where each vehicle is, and where it could come to rest.
    others_m: The same of its neighbours.
    yields: Whether a neighbour keeps its distance as well.
    spacing_m: Smallest distance allowed.
  """
  own_m, their_m = _nearest(
    ways_m[0][:, None], ways_m[1][:, None], others_m[0], others_m[1]
  )
  apart = their_m - own_m
  gaps_m = length(apart)
  normals = apart / np.maximum(gaps_m, _TINY)[..., None]
  shares = np.where(yields, 0.5, 1.0)
  room_m = np.maximum(shares * (gaps_m - spacing_m), 0.0)
  return Cells(normals, (normals * own_m).sum(axis=2) + room_m)


def box(low_m: np.ndarray, high_m: np.ndarray, ways_m: np.ndarray) -> Cells:
  """The planes of a box; who is outside is only kept from going further.

  Args:
    low_m: (3,) its lowest corner.
    high_m: (3,) its highest one.
    ways_m: (N, 2, 3) where vehicles are, and where they could come to rest.
  """
  normals = np.concatenate([-np.eye(3), np.eye(3)])
  offsets_m = np.concatenate([-low_m, high_m])
  reached_m = (ways_m @ normals.T).max(axis=1)  # (N, 6)
  return Cells(
    np.broadcast_to(normals, (len(ways_m), 6, 3)),
    np.maximum(offsets_m, reached_m),
  )


def joined(*several: Cells) -> Cells:
  """Cells within all of several."""
  return Cells(
    np.concatenate([each.normals for each in several], axis=1),
    np.concatenate([each.offsets_m for each in several], axis=1),
  )


def _nearest(
  a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
  """Where two segments, a to b and c to d, are nearest to each other.

  Ends of segments are tried on the other one, and the places where lines are
  nearest, if both are within.
  """
  u, v, w = b - a, d - c, a - c
  uu, vv, uv = (u * u).sum(-1), (v * v).sum(-1), (u * v).sum(-1)
  uw, vw = (u * w).sum(-1), (v * w).sum(-1)
  cross = uu * vv - uv * uv
  safe = np.where(cross > _TINY * np.maximum(uu * vv, _TINY), cross, np.inf)
  zeros, ones = np.zeros_like(cross), np.ones_like(cross)

  def on_own(t: np.ndarray) -> np.ndarray:
    """The nearest share of the way a to b for one of c to d."""
    return np.clip((t * uv - uw) / np.maximum(uu, _TINY**2), 0.0, 1.0)

  def on_other(s: np.ndarray) -> np.ndarray:
    return np.clip((s * uv + vw) / np.maximum(vv, _TINY**2), 0.0, 1.0)

  s = np.clip((uv * vw - vv * uw) / safe, 0.0, 1.0)
  pairs = [
    (s, on_other(s)),
    (zeros, on_other(zeros)), (ones, on_other(ones)),
    (on_own(zeros), zeros), (on_own(ones), ones),
  ]  # fmt: skip
  shares = np.array(pairs)  # (5, 2, N, M)
  own = a + shares[:, 0, ..., None] * u
  other = c + shares[:, 1, ..., None] * v
  best = length(other - own).argmin(axis=0)[None, ..., None]
  return (
    np.take_along_axis(own, best, axis=0)[0],
    np.take_along_axis(other, best, axis=0)[0],
  )


def length(vectors: np.ndarray) -> np.ndarray:
  """Of vectors (..., 3)."""
  return np.sqrt((vectors * vectors).sum(axis=-1))
