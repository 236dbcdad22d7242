"""The room: what it holds in, how it is lit, whom it refuses."""

from collections.abc import Sequence
import math

from dm_control import mjcf
import numpy as np
import pytest

from waggle_tasks import appearance
from waggle_tasks.arenas import bounds, flight_room, layouts
from waggle_tasks.entities import crazyflie

Appearance = appearance.Appearance
HOVER = layouts.performer_pose()


def furnish(
  look: Appearance | None = None, poses: Sequence[layouts.Pose] = ()
) -> tuple[flight_room.FlightRoom, mjcf.Element]:
  """A room with the performer and observers, and the performer's joint."""
  room = flight_room.FlightRoom(look)
  frame = room.add_vehicle(crazyflie.Crazyflie('performer'), HOVER)
  for i, pose in enumerate(poses, 1):
    room.add_vehicle(crazyflie.Crazyflie(f'observer_{i}'), pose)
  return room, frame.freejoint


def compiled(room: flight_room.FlightRoom) -> mjcf.Physics:
  return mjcf.Physics.from_mjcf_model(room.mjcf_model)


@pytest.fixture(scope='module')
def physics() -> mjcf.Physics:
  """To be looked at, not moved."""
  return compiled(furnish(poses=layouts.Arc().poses(3))[0])


def test_vehicles_keep_their_names_poses_and_weight(
  physics: mjcf.Physics,
) -> None:
  poses = {'performer': HOVER}
  for i, pose in enumerate(layouts.Arc().poses(3), 1):
    poses[f'observer_{i}'] = pose
  for name, pose in poses.items():
    body = physics.named.data
    np.testing.assert_allclose(
      body.xpos[f'{name}/airframe'], pose.position_m, atol=1e-12
    )
    nose = body.xmat[f'{name}/airframe'].reshape(3, 3)[:, 0]
    yaw_rad = math.atan2(nose[1], nose[0])
    assert yaw_rad == pytest.approx(pose.yaw_rad)
  assert physics.model.body_mass.sum() == pytest.approx(4 * 0.027, abs=1e-12)


def test_every_vehicle_starts_above_a_pad_of_its_own(
  physics: mjcf.Physics,
) -> None:
  data = physics.named.data
  for name in ('performer', 'observer_1', 'observer_2', 'observer_3'):
    np.testing.assert_allclose(
      data.geom_xpos[f'pad_{name}'][:2], data.xpos[f'{name}/'][:2], atol=1e-9
    )


@pytest.mark.parametrize(
  ('velocity_mps', 'axis', 'limit_m'),
  [
    ((6, 0, 0), 0, bounds.HALF_WIDTH_M),
    ((-6, 0, 0), 0, bounds.HALF_WIDTH_M),
    ((0, 6, 0), 1, bounds.HALF_DEPTH_M),
    ((0, -6, 0), 1, bounds.HALF_DEPTH_M),
    ((0, 0, 6), 2, bounds.HEIGHT_M),
    ((0, 0, -6), 2, 0.0),
  ],
)
def test_nothing_flies_out_of_the_room(
  velocity_mps: tuple[float, float, float], axis: int, limit_m: float
) -> None:
  room, joint = furnish()
  physics = compiled(room)
  physics.model.opt.gravity[:] = 0
  with physics.reset_context():
    physics.bind(joint).qvel[:3] = velocity_mps
  contacts, farthest_m = 0, 0.0
  for _ in range(1000):  # 2 s, time for 12 m.
    physics.step()
    contacts += physics.data.ncon
    position_m = physics.bind(joint).qpos[axis]
    farthest_m = max(farthest_m, position_m * np.sign(velocity_mps[axis]))
  assert contacts
  assert farthest_m < limit_m + 0.05


def test_gravity_is_the_earths(physics: mjcf.Physics) -> None:
  np.testing.assert_allclose(physics.model.opt.gravity, (0, 0, -9.81))


def test_the_buffer_holds_an_image_at_twice_its_size(
  physics: mjcf.Physics,
) -> None:
  image = physics.render(height=960, width=1280, camera_id='top')
  assert image.shape == (960, 1280, 3)
  assert physics.model.vis.quality.offsamples == 0


def without_performer(
  room: flight_room.FlightRoom, joint: mjcf.Element
) -> tuple[np.ndarray, np.ndarray]:
  """The view from the top with the performer, and without."""
  physics = compiled(room)
  present = physics.render(height=480, width=640, camera_id='top')
  with physics.reset_context():
    physics.bind(joint).qpos[:3] = (0, 0, -5)
  return present, physics.render(height=480, width=640, camera_id='top')


@pytest.mark.slow
@pytest.mark.parametrize('shadows', [False, True])
def test_a_vehicle_changes_the_floor_only_by_a_shadow(shadows: bool) -> None:
  poses = layouts.Arc().poses(3)
  room, joint = furnish(Appearance(shadows=shadows), poses)
  present, absent = without_performer(room, joint)
  changed = np.argwhere((present != absent).any(-1))
  pad = room.mjcf_model.find('camera', 'top')
  pixels_per_m = 480 / pad.fovy
  centre = 240 - (0 - pad.pos[1]) * pixels_per_m, 320 - pad.pos[0]
  radius_px = crazyflie.DIAMETER_M / 2 * pixels_per_m + 1
  beside = np.linalg.norm(changed - centre, axis=1) > radius_px
  assert len(changed) > 200
  assert bool(beside.any()) == shadows


def test_no_light_casts_a_shadow_by_default(physics: mjcf.Physics) -> None:
  assert physics.model.nlight > 0
  assert not physics.model.light_castshadow.any()


@pytest.mark.slow
def test_an_empty_floor_has_no_tiles() -> None:
  pictures = {
    floor: compiled(flight_room.FlightRoom(Appearance(floor=floor))).render(
      height=120, width=160, camera_id='top'
    )
    for floor in appearance.FLOORS
  }
  assert np.ptp(pictures['plain'], axis=(0, 1)).max() <= 1
  assert np.ptp(pictures['honeycomb'], axis=(0, 1)).max() > 20


def test_brightness_scales_the_picture() -> None:
  means = [
    compiled(flight_room.FlightRoom(Appearance(brightness=brightness)))
    .render(height=120, width=160, camera_id='overview')
    .mean()
    for brightness in (0.5, 1.0)
  ]
  assert means[0] / means[1] == pytest.approx(0.5, abs=0.02)


def test_the_room_has_no_holes_and_no_edges_behind_the_dance() -> None:
  room = flight_room.FlightRoom()
  names = []
  for i, pose in enumerate(layouts.Arc(1.3, math.pi * 0.9).poses(7)):
    names.append(f'eye_{i}')
    c, s = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
    room.mjcf_model.worldbody.add(
      'camera', name=names[-1], pos=pose.position_m,
      xyaxes=(s, -c, 0, 0, 0, 1), fovy=60,
    )  # fmt: skip
  physics = compiled(room)
  for name in names:
    image = physics.render(height=480, width=640, camera_id=name).astype(int)
    assert image.max(-1).min() > 40
    # START's top to the lowest point of a V at 1.3 m.
    behind = image[30:350]
    for axis in (0, 1):
      assert np.abs(np.diff(behind, axis=axis)).max() <= 8


def test_a_vehicle_close_to_an_eye_is_not_cut_away() -> None:
  room, joint = furnish()
  room.mjcf_model.worldbody.add(
    'camera', name='close', pos=(0, -0.15, 1.3), xyaxes=(1, 0, 0, 0, 0, 1),
    fovy=60,
  )  # fmt: skip
  physics = compiled(room)
  present = physics.render(height=120, width=160, camera_id='close')
  with physics.reset_context():
    physics.bind(joint).qpos[:3] = (0, 0, -5)
  absent = physics.render(height=120, width=160, camera_id='close')
  # The front legs stand 0.12 m from the camera, 0.03 m on either side.
  columns = np.flatnonzero((present != absent).any(-1).any(0))
  assert np.ptp(columns) > 2 * 0.033 / 0.12 * 104


def test_a_name_is_taken_only_once() -> None:
  room, _ = furnish()
  with pytest.raises(layouts.LayoutError) as caught:
    room.add_vehicle(crazyflie.Crazyflie('performer'), HOVER)
  assert str(caught.value) == (
    '`name` of a vehicle must be new to the room, which holds'
    " ['performer']: got 'performer'"
  )


@pytest.mark.parametrize(
  'position_m', [(9, 0, 1.3), (0, -7, 1.3), (0, 0, 0), (0, 0, 7.5)]
)
def test_nobody_starts_outside(
  position_m: tuple[float, float, float],
) -> None:
  room = flight_room.FlightRoom()
  error = r'`pose` of observer_1 must lie in the room, \|x\| < 8.7'
  with pytest.raises(layouts.LayoutError, match=error):
    room.add_vehicle(
      crazyflie.Crazyflie('observer_1'), layouts.Pose(position_m, 0.0)
    )
