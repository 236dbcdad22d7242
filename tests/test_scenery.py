"""Scenery faces whoever looks at it and joins without a seam."""

import math

import numpy as np
import pytest

from waggle_tasks.arenas import scenery

MESHES = {
  'wall': scenery.studio_wall(8.0, 6.0, 7.0, 2.0, 2.5),
  'ceiling': scenery.ceiling(8.0, 6.0),
  'tiles': scenery.honeycomb(0.4, 0.02, 2),
  'ring': scenery.ring(0.1, 0.12, 16),
}


def facing(mesh: scenery.Mesh) -> tuple[np.ndarray, np.ndarray]:
  """Twice the area vectors (F, 3) and the middles (F, 3) of triangles."""
  a, b, c = mesh.vertices_m[mesh.faces].swapaxes(0, 1)
  return np.cross(b - a, c - a), (a + b + c) / 3


@pytest.mark.parametrize('name', MESHES)
def test_triangles_face_the_way_their_normals_point(name: str) -> None:
  mesh = MESHES[name]
  areas, _ = facing(mesh)
  assert (np.linalg.norm(areas, axis=1) > 0).all()
  normals = mesh.normals[mesh.faces]  # (F, 3, 3)
  assert (np.einsum('fi,fvi->fv', areas, normals) >= 0).all()
  np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1)


def test_the_wall_faces_the_middle_of_the_room() -> None:
  areas, middles = facing(MESHES['wall'])
  assert (np.einsum('fi,fi->f', areas, (0, 0, 3) - middles) > 0).all()


def test_the_wall_rises_from_the_floor_without_an_edge() -> None:
  mesh = MESHES['wall']
  foot = mesh.vertices_m[:, 2] < 1e-9
  np.testing.assert_allclose(mesh.normals[foot], [(0, 0, 1)] * foot.sum())
  np.testing.assert_allclose(np.abs(mesh.vertices_m[foot]).max(0), (6, 4, 0))
  np.testing.assert_allclose(np.abs(mesh.vertices_m).max(0), (8, 6, 7))


@pytest.mark.parametrize(('rings', 'tiles'), [(0, 1), (1, 7), (5, 91)])
def test_a_honeycomb_is_a_hexagon_of_tiles(rings: int, tiles: int) -> None:
  mesh = scenery.honeycomb(0.4, 0.0, rings)
  areas, _ = facing(mesh)
  area = np.linalg.norm(areas, axis=1).sum() / 2
  assert area == pytest.approx(tiles * math.sqrt(3) / 2 * 0.4**2)
  assert len(mesh.faces) == 4 * tiles


def test_a_tile_along_y_is_one_pitch_away() -> None:
  middles = scenery.honeycomb(0.4, 0.02, 1).vertices_m.reshape(-1, 6, 3).mean(1)
  distances = np.linalg.norm(middles - (0, 0.4, 0), axis=1)
  assert distances.min() == pytest.approx(0, abs=1e-12)


def test_joints_are_as_wide_as_asked() -> None:
  one = scenery.honeycomb(0.4, 0.02, 0).vertices_m
  assert np.ptp(one[:, 1]) == pytest.approx(0.38)
