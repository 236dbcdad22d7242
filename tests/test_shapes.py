"""Solids are closed, face outwards and have the size that was asked for."""

import math

import numpy as np
import pytest

from waggle_tasks.entities import airframe, shapes

SQUARE = [(0, 0), (2, 0), (2, 1), (0, 1)]
SOLIDS = {
  'prism': (shapes.prism(SQUARE, -1, 2), 6.0, 12),
  'box': (shapes.box((0, 1), (-1, 1), (0, 3)), 6.0, 12),
  'turned': (
    shapes.turned([(1, 0), (1, 2)], 48),
    2 * 24 * math.sin(2 * math.pi / 48),
    188,
  ),
  'hoop': (
    shapes.hoop(1, 2, 0, 1, 48),
    3 * 24 * math.sin(2 * math.pi / 48),
    384,
  ),
}


def volume(solid: shapes.Solid) -> float:
  """Volume inside a closed surface; negative if it faces inwards."""
  a, b, c = solid.vertices_m[solid.faces].swapaxes(0, 1)
  return np.einsum('ni,ni->', a, np.cross(b, c)) / 6


def open_edges(solid: shapes.Solid) -> set[tuple[int, int]]:
  """Edges that do not have one triangle on either side."""
  edges = [tuple(edge) for i in range(3) for edge in
           np.roll(solid.faces, i, axis=1)[:, :2].tolist()]  # fmt: skip
  assert len(set(edges)) == len(edges)
  return {edge for edge in edges if edge[::-1] not in edges}


@pytest.mark.parametrize('name', SOLIDS)
def test_a_solid_is_closed_and_has_its_volume_and_triangles(name: str) -> None:
  solid, expected, triangles = SOLIDS[name]
  assert open_edges(solid) == set()
  assert volume(solid) == pytest.approx(expected)
  assert len(solid.faces) == triangles


@pytest.mark.parametrize('name', SOLIDS)
def test_moving_and_mirroring_keep_a_solid_whole(name: str) -> None:
  solid, expected, _ = SOLIDS[name]
  moved = solid.at(3.0, -2.0, 0.7).mirrored()
  assert open_edges(moved) == set()
  assert volume(moved) == pytest.approx(expected)


def test_at_turns_about_z_and_then_moves() -> None:
  point = shapes.Solid(np.array([[1.0, 0.0, 5.0]]), np.empty((0, 3), int))
  got = point.at(10.0, 20.0, math.pi / 2).vertices_m
  np.testing.assert_allclose(got, [[10, 21, 5]])


def test_joined_solids_keep_their_own_corners() -> None:
  one, other = SOLIDS['box'][0], SOLIDS['prism'][0]
  both = shapes.joined([one, other])
  assert volume(both) == pytest.approx(volume(one) + volume(other))
  assert open_edges(both) == set()


@pytest.mark.parametrize(
  'part', tuple(airframe.parts((1, 1, 1, 1))), ids=lambda part: part.name
)
def test_every_part_of_the_airframe_is_closed_and_faces_outwards(
  part: airframe.Part,
) -> None:
  for solid in part.solids:
    assert open_edges(solid) == set()
    assert volume(solid) > 0
