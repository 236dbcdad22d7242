"""Triangle meshes of simple solids, in plain numpy.

A vehicle is drawn as one mesh a colour: fewer things to draw than primitives,
and a triangle count that does not depend on the renderer's tessellation.
Triangles are listed counter-clockwise as seen from outside.
"""

from collections.abc import Iterable, Sequence
import dataclasses
import math

import numpy as np


@dataclasses.dataclass(frozen=True)
class Solid:
  """A closed surface.

  Attributes:
    vertices_m: Corners, (V, 3) float64.
    faces: Three indices into the corners a triangle, (F, 3) int.
  """

  vertices_m: np.ndarray
  faces: np.ndarray

  def at(self, x_m: float, y_m: float, yaw_rad: float = 0.0) -> 'Solid':
    """Returns a copy turned about z, then moved in the plane."""
    c, s = math.cos(yaw_rad), math.sin(yaw_rad)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return Solid(self.vertices_m @ turn + (x_m, y_m, 0.0), self.faces)

  def mirrored(self) -> 'Solid':
    """Returns the mirror image in y."""
    return Solid(self.vertices_m * (1.0, -1.0, 1.0), self.faces[:, ::-1])


def joined(solids: Iterable[Solid]) -> Solid:
  """Returns all the surfaces as one; they may touch or overlap."""
  solids = tuple(solids)
  starts = np.cumsum([0, *(len(solid.vertices_m) for solid in solids)])
  return Solid(
    np.concatenate([solid.vertices_m for solid in solids]),
    np.concatenate(
      [s.faces + start for s, start in zip(solids, starts[:-1], strict=True)]
    ),
  )


def loft(rings: np.ndarray) -> Solid:
  """Skins rings of corners, one after another, and caps both ends.

  Args:
    rings: (R, N, 3); each ring is convex and counter-clockwise as seen from
      the side of the last one.

  Returns:
    A solid of 2 N (R - 1) + 2 (N - 2) triangles.
  """
  count, size = rings.shape[:2]
  sides = [
    face
    for low in range(0, (count - 1) * size, size)
    for i in range(size)
    for j in [(i + 1) % size]
    for face in (
      (low + i, low + j, low + size + j),
      (low + i, low + size + j, low + size + i),
    )
  ]
  top = (count - 1) * size
  caps = [
    face
    for i in range(1, size - 1)
    for face in ((0, i + 1, i), (top, top + i, top + i + 1))
  ]
  return Solid(rings.reshape(-1, 3), np.array(sides + caps))


def prism(
  outline_m: Sequence[tuple[float, float]], low_m: float, high_m: float
) -> Solid:
  """Extrudes a convex, counter-clockwise outline in x and y along z."""
  outline = np.asarray(outline_m, dtype=float)  # (N, 2)
  return loft(
    np.stack([np.insert(outline, 2, z, axis=1) for z in (low_m, high_m)])
  )


def box(
  x_m: tuple[float, float], y_m: tuple[float, float], z_m: tuple[float, float]
) -> Solid:
  """A box between the given ends, 12 triangles."""
  (x0, x1), (y0, y1) = x_m, y_m
  return prism([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], *z_m)


def turned(profile_m: Sequence[tuple[float, float]], sides: int) -> Solid:
  """Turns a profile of (radius, z), bottom to top, about z."""
  return loft(np.stack([_circle(r, z, sides) for r, z in profile_m]))


def hoop(
  inner_m: float, outer_m: float, low_m: float, high_m: float, sides: int
) -> Solid:
  """A ring of rectangular section about z, 8 triangles a side."""
  section = ((inner_m, low_m), (outer_m, low_m), (outer_m, high_m),
             (inner_m, high_m))  # fmt: skip
  circles = np.stack([_circle(r, z, sides) for r, z in section])
  corner = np.arange(4 * sides).reshape(4, sides)
  following, outer = np.roll(corner, -1, axis=1), np.roll(corner, -1, axis=0)
  far = np.roll(following, -1, axis=0)
  faces = [(corner, following, far), (corner, far, outer)]
  return Solid(
    circles.reshape(-1, 3),
    np.concatenate([np.stack(f, axis=-1).reshape(-1, 3) for f in faces]),
  )


def _circle(radius_m: float, z_m: float, sides: int) -> np.ndarray:
  """Returns corners of a regular polygon, (sides, 3)."""
  angle = 2.0 * math.pi * np.arange(sides) / sides
  return np.stack(
    [radius_m * np.cos(angle), radius_m * np.sin(angle), 0.0 * angle + z_m],
    axis=1,
  )
