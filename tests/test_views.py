"""The shared views show everybody."""

import math

from dm_control import mjcf
import numpy as np
import pytest

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import crazyflie

LAYOUTS = [
  pytest.param(layouts.Arc(), 1, id='one'),
  pytest.param(layouts.Arc(), 3, id='default'),
  pytest.param(layouts.Arc(1.3, math.radians(45)), 5, id='wide'),
  pytest.param(layouts.Arc(3.0, math.radians(60)), 20, id='twenty'),
  pytest.param(layouts.Line(), 20, id='long line'),
]


def project(
  physics: mjcf.Physics, camera: str, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
  """Points (N, 3) in units of half the picture, right and up, (N,) each."""
  model, data = physics.named.model, physics.named.data
  axes = data.cam_xmat[camera].reshape(3, 3)
  x, y, z = (points - data.cam_xpos[camera]).dot(axes).T
  if camera == 'top':
    half = model.cam_fovy[camera] / 2
  else:
    half = -z * math.tan(math.radians(model.cam_fovy[camera]) / 2)
    assert (z < 0).all(), 'behind the camera'
  return x / half / (4 / 3), y / half


def compiled(
  layout: layouts.Layout, count: int
) -> tuple[mjcf.Physics, np.ndarray]:
  room = flight_room.FlightRoom()
  poses = (layouts.performer_pose(), *layout.poses(count))
  for i, pose in enumerate(poses):
    room.add_vehicle(crazyflie.Crazyflie(f'vehicle_{i}'), pose)
  physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
  return physics, np.array([pose.position_m for pose in poses])


@pytest.mark.slow
@pytest.mark.parametrize(('layout', 'count'), LAYOUTS)
def test_top_and_overview_show_everybody_and_the_whole_dance(
  layout: layouts.Layout, count: int
) -> None:
  physics, positions_m = compiled(layout, count)
  dance_m = positions_m[0] + [(0, 0, 0.62), (-0.3, 0, -0.3), (0.3, 0, 0.3)]
  pads_m = positions_m * (1, 1, 0)
  shown_m = np.concatenate([positions_m, dance_m, pads_m])
  for camera in ('top', 'overview'):
    assert np.abs(project(physics, camera, shown_m)).max() < 1


@pytest.mark.slow
@pytest.mark.parametrize(('layout', 'count'), LAYOUTS)
def test_vehicles_fill_the_view_from_the_top(
  layout: layouts.Layout, count: int
) -> None:
  physics, positions_m = compiled(layout, count)
  x, y = project(physics, 'top', positions_m)
  assert max(np.ptp(x), np.ptp(y)) > 1


def test_the_top_looks_straight_down_with_y_up() -> None:
  physics, _ = compiled(layouts.Arc(), 3)
  axes = physics.named.data.cam_xmat['top'].reshape(3, 3)
  np.testing.assert_allclose(axes, np.eye(3), atol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(('layout', 'count'), LAYOUTS[:4])
def test_the_performer_sees_all_of_its_audience(
  layout: layouts.Layout, count: int
) -> None:
  physics, positions_m = compiled(layout, count)
  x, y = project(physics, 'performer_view', positions_m[1:])
  assert np.abs([x, y]).max() < 1
  # It faces them, so the first, on their left, is on its right.
  assert (np.diff(x) < 0).all()


def test_the_performer_does_not_hide_its_audience() -> None:
  physics, positions_m = compiled(layouts.Arc(), 3)
  _, y = project(physics, 'performer_view', positions_m)
  assert y[0] < y[1:].min() - 0.2


@pytest.mark.slow
@pytest.mark.parametrize('camera', ['top', 'overview', 'performer_view'])
def test_every_view_renders(camera: str) -> None:
  physics, _ = compiled(layouts.Arc(), 3)
  image = physics.render(height=240, width=320, camera_id=camera)
  assert image.std() > 5
