"""The rigid parts of a compiled scene, each with a box around it."""

import dataclasses

import mujoco
import numpy as np

# Corner k is on the positive side of axis i when bit i of k is set.
_SIGNS = np.array([[k >> i & 1 for i in range(3)] for k in range(8)]) * 2 - 1


@dataclasses.dataclass(frozen=True, eq=False)
class Part:
  """Geoms that keep their places relative to one another.

  Attributes:
    body: Index of the body that they move with; 0 for the world.
    geoms: (K,) their indices.
    corners_m: (8, 3) the corners of a box around them, in the body's frame;
      corner k is on the high side of axis i when bit i of k is set.
  """

  body: int
  geoms: np.ndarray
  corners_m: np.ndarray


def find(
  model: mujoco.MjModel, data: mujoco.MjData, drawn: np.ndarray
) -> list[Part]:
  """Finds the parts of a scene.

  Args:
    model: The compiled model.
    data: Its data, with positions computed.
    drawn: (ngeom,) bool, which geoms can be seen.

  Returns:
    A part for each rigid body and for each bounded geom of the world. Planes
    have no bounds and belong to no part.
  """
  weld = model.body_weldid[model.geom_bodyid]  # (ngeom,)
  bounded = drawn & (model.geom_type != mujoco.mjtGeom.mjGEOM_PLANE)
  groups = [
    np.flatnonzero(bounded & (weld == body))
    for body in np.unique(weld[bounded])
    if body
  ]
  groups += [np.array([geom]) for geom in np.flatnonzero(bounded & (weld == 0))]
  parts = []
  for geoms in groups:
    body = int(weld[geoms[0]])
    to_body = data.xmat[body].reshape(3, 3)
    points = np.concatenate([_points(model, data, int(geom)) for geom in geoms])
    local = (points - data.xpos[body]) @ to_body
    low, high = local.min(axis=0), local.max(axis=0)
    parts.append(Part(body, geoms, np.where(_SIGNS < 0, low, high)))
  return parts


def _points(
  model: mujoco.MjModel, data: mujoco.MjData, geom: int
) -> np.ndarray:  # (P, 3)
  """World points whose hull holds a geom."""
  if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
    mesh = model.geom_dataid[geom]
    first = model.mesh_vertadr[mesh]
    local = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
  else:
    centre, half = np.split(model.geom_aabb[geom], 2)
    local = centre + _SIGNS * half
  rotation = data.geom_xmat[geom].reshape(3, 3)
  return data.geom_xpos[geom] + local @ rotation.T
