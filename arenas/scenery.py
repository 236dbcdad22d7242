"""Floor tiles and the studio wall, as triangle meshes in plain numpy.

Nothing here has texture, and what lies behind a dancing vehicle has no corner
either: floor and wall are one surface that curves up without a seam, so that a
feature tracker finds nothing but the vehicle.
"""

import dataclasses
import math

import numpy as np

_STEPS = 8  # Facets of a quarter turn.
_UP, _DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)


@dataclasses.dataclass(frozen=True)
class Mesh:
  """A surface that is seen from one side.

  Attributes:
    vertices_m: Corners, (V, 3) float64.
    normals: Unit vectors out of the surface at the corners, (V, 3) float64.
    faces: Three corners a triangle, counter-clockwise as seen, (F, 3) int.
  """

  vertices_m: np.ndarray
  normals: np.ndarray
  faces: np.ndarray


def studio_wall(
  half_width_m: float,
  half_depth_m: float,
  height_m: float,
  curve_m: float,
  corner_m: float,
) -> Mesh:
  """Builds the inside of a room with a rounded foot and rounded corners.

  Args:
    half_width_m: Half extent along x, at the wall.
    half_depth_m: Half extent along y, at the wall.
    height_m: Height of the wall.
    curve_m: Radius of the curve between floor and wall.
    corner_m: Radius of the vertical corners, at least `curve_m`.

  Returns:
    The wall, its foot at z = 0 and tangent to the floor.
  """
  angle = _quarter_turn()
  lean = np.append(angle, math.pi / 2.0)[:, np.newaxis, np.newaxis]
  inset_m = np.append(curve_m * (1.0 - np.sin(angle)), 0.0)  # From the wall.
  z_m = np.append(curve_m * (1.0 - np.cos(angle)), height_m)
  middle_m = (half_width_m - corner_m, half_depth_m - corner_m)
  rings = np.stack(
    [
      np.insert(_rounded_rectangle(middle_m, corner_m - inset), 2, z, axis=1)
      for inset, z in zip(inset_m, z_m, strict=True)
    ]
  )  # (R, N, 3)
  outward = np.insert(_rounded_rectangle((0.0, 0.0), 1.0), 2, 0.0, axis=1)
  normals = np.cos(lean) * _UP - np.sin(lean) * outward  # (R, N, 3)
  corner = np.arange(rings[..., 0].size).reshape(rings.shape[:2])
  following = np.roll(corner, -1, axis=1)
  a, b, c, d = corner[:-1], corner[1:], following[1:], following[:-1]
  faces = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
  return Mesh(
    rings.reshape(-1, 3), normals.reshape(-1, 3), faces.reshape(-1, 3)
  )


def ceiling(half_width_m: float, half_depth_m: float) -> Mesh:
  """Builds a rectangle around the origin, facing down."""
  corners = np.array([(-1, -1, 0), (-1, 1, 0), (1, 1, 0), (1, -1, 0)])
  return Mesh(
    corners * (half_width_m, half_depth_m, 0.0),
    np.tile(_DOWN, (4, 1)),
    np.array([(0, 1, 2), (0, 2, 3)]),
  )


def honeycomb(pitch_m: float, gap_m: float, rings: int) -> Mesh:
  """Builds a hexagon of hexagonal tiles around the origin, facing up.

  Args:
    pitch_m: Distance between the middles of neighbouring tiles, of which two
      lie along the y axis.
    gap_m: Width of the joints.
    rings: Rings of tiles around the middle one.

  Returns:
    The tiles, at z = 0.
  """
  outline_m = (pitch_m - gap_m) / math.sqrt(3.0) * _circle(6)
  middles_m = [
    (pitch_m * math.sqrt(0.75) * q, pitch_m * (r + q / 2.0), 0.0)
    for q in range(-rings, rings + 1)
    for r in range(-rings, rings + 1)
    if abs(q + r) <= rings
  ]
  fan = np.array([(0, i, i + 1) for i in range(1, 5)])  # (4, 3)
  return _flat(
    np.concatenate([outline_m + middle for middle in middles_m]),
    np.concatenate([fan + 6 * i for i in range(len(middles_m))]),
  )


def ring(inner_m: float, outer_m: float, sides: int) -> Mesh:
  """Builds a flat ring around the origin, facing up."""
  i = np.arange(sides)
  j = np.roll(i, -1)
  return _flat(
    np.concatenate([inner_m * _circle(sides), outer_m * _circle(sides)]),
    np.concatenate(
      [
        np.stack([i, i + sides, j + sides], axis=-1),
        np.stack([i, j + sides, j], axis=-1),
      ]
    ),
  )


def crossed_discs(arm_m: float, radius_m: float) -> Mesh:
  """Builds four discs at the ends of a level cross, facing up.

  Args:
    arm_m: Distance of their middles from the origin, along the diagonals.
    radius_m: Of each disc.
  """
  sides, width_m = 12, radius_m / 3  # Half the width of the cross.
  fan = np.array([(0, i, i + 1) for i in range(1, sides - 1)])
  middles_m = (
    arm_m
    * math.sqrt(0.5)
    * np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)])
  )
  ways = middles_m / arm_m
  corners: list[np.ndarray] = []
  faces: list[np.ndarray] = []
  for middle, way in zip(middles_m, ways, strict=True):
    faces.append(fan + sum(map(len, corners)))
    corners.append(radius_m * _circle(sides) + middle)
    aside = width_m * np.array([-way[1], way[0], 0.0])
    faces.append(np.array([(0, 1, 2), (0, 2, 3)]) + sum(map(len, corners)))
    corners.append(np.array([-aside, middle - aside, middle + aside, aside]))
  return _flat(np.concatenate(corners), np.concatenate(faces))


def _flat(vertices_m: np.ndarray, faces: np.ndarray) -> Mesh:
  return Mesh(vertices_m, np.tile(_UP, (len(vertices_m), 1)), faces)


def _circle(sides: int) -> np.ndarray:  # (sides, 3)
  angle = 2.0 * math.pi * np.arange(sides) / sides
  return np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)


def _quarter_turn() -> np.ndarray:  # (_STEPS + 1,)
  return np.linspace(0.0, math.pi / 2.0, _STEPS + 1)


def _rounded_rectangle(
  middle_m: tuple[float, float], radius_m: float
) -> np.ndarray:  # (N, 2)
  """Rounds a rectangle's corners about `middle_m`; counter-clockwise."""
  quarters = []
  for i, signs in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
    angle = _quarter_turn() + i * math.pi / 2.0
    arc_m = radius_m * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    quarters.append(np.array(signs) * middle_m + arc_m)
  return np.concatenate(quarters)
