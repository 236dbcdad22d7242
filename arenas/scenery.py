"""Floor tiles and the studio wall, as triangle meshes in plain numpy.

Nothing here has texture, and what lies behind a dancing vehicle has no corner
either: floor and wall are one surface that curves up without a seam, so that a
feature tracker finds nothing but the vehicle.
"""

import math

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]  # Corners (V, 3) and triangles (F, 3).

_STEPS = 8  # Facets of a quarter turn.


def studio_wall(
  half_width_m: float,
  half_depth_m: float,
  height_m: float,
  curve_m: float,
  corner_m: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
  """Builds the inside of a room with a rounded foot and rounded corners.

  Args:
    half_width_m: half extent along x, at the wall.
    half_depth_m: half extent along y, at the wall.
    height_m: height of the wall.
    curve_m: radius of the curve between floor and wall.
    corner_m: radius of the vertical corners, at least `curve_m`.

  Returns:
    Corners in metres and triangles, facing inwards.
  """
  angle = _quarter_turn()
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
  lean = np.append(angle, math.pi / 2.0)[:, np.newaxis, np.newaxis]
  normals = np.cos(lean) * (0.0, 0.0, 1.0) - np.sin(lean) * outward
  corner = np.arange(rings.shape[0] * rings.shape[1]).reshape(rings.shape[:2])
  following = np.roll(corner, -1, axis=1)
  a, b, c, d = corner[:-1], corner[1:], following[1:], following[:-1]
  faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
  return rings.reshape(-1, 3), faces.reshape(-1, 3), normals.reshape(-1, 3)


def honeycomb(pitch_m: float, gap_m: float, rings: int, z_m: float) -> Mesh:
  """Builds a hexagon of hexagonal tiles around the origin, facing up.

  Args:
    pitch_m: distance between the middles of neighbouring tiles, of which two
      lie along the y axis.
    gap_m: width of the joints.
    rings: rings of tiles around the middle one.
    z_m: height above the floor.

  Returns:
    Corners in metres and triangles, the middle tile's first.
  """
  angle = np.arange(6) * math.pi / 3.0
  outline = np.stack([np.cos(angle), np.sin(angle), np.zeros(6)], axis=1)
  outline *= (pitch_m - gap_m) / math.sqrt(3.0)
  middles = sorted(
    (
      (pitch_m * math.sqrt(0.75) * q, pitch_m * (r + q / 2.0), z_m)
      for q in range(-rings, rings + 1)
      for r in range(-rings, rings + 1)
      if abs(q + r) <= rings
    ),
    key=lambda middle: math.hypot(*middle[:2]),
  )
  fan = np.array([(0, i, i + 1) for i in range(1, 5)])  # (4, 3)
  return (
    np.concatenate([outline + middle for middle in middles]),
    np.concatenate([fan + 6 * i for i in range(len(middles))]),
  )


def _quarter_turn() -> np.ndarray:  # (_STEPS + 1,)
  return np.linspace(0.0, math.pi / 2.0, _STEPS + 1)


def _rounded_rectangle(
  middle_m: tuple[float, float], radius_m: float
) -> np.ndarray:  # (N, 2)
  """Rounds a rectangle's corners about `middle_m`; counter-clockwise."""
  quarters = []
  for i, signs in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
    angle = _quarter_turn() + i * math.pi / 2.0
    arc = radius_m * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    quarters.append(np.array(signs) * middle_m + arc)
  return np.concatenate(quarters)


def ring(inner_m: float, outer_m: float, sides: int) -> Mesh:
  """Builds a flat ring around the origin, facing up."""
  angle = 2.0 * math.pi * np.arange(sides) / sides
  circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
  i = np.arange(sides)
  j = np.roll(i, -1)
  faces = [(i, i + sides, j + sides), (i, j + sides, j)]
  return (
    np.concatenate([inner_m * circle, outer_m * circle]),
    np.concatenate([np.stack(face, axis=-1) for face in faces]),
  )
