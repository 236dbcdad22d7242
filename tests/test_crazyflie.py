"""The vehicle: what it weighs, how it moves, how it looks."""

import dataclasses
import math

import cv2
from dm_control import mjcf
import mujoco
import numpy as np
import pytest

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import crazyflie

GRAVITY_MPS2 = 9.81
HOVER = layouts.performer_pose()


@dataclasses.dataclass(frozen=True)
class Flown:
  """A compiled room with one vehicle in it."""

  physics: mjcf.Physics
  vehicle: crazyflie.Crazyflie
  joint: mjcf.Element

  @property
  def state(self) -> tuple[np.ndarray, np.ndarray]:
    bound = self.physics.bind(self.joint)
    return np.array(bound.qpos), np.array(bound.qvel)

  def step(self, count: int) -> None:
    for _ in range(count):
      self.physics.step()


def fly(pose: layouts.Pose = HOVER) -> Flown:
  room, vehicle = flight_room.FlightRoom(), crazyflie.Crazyflie('performer')
  joint = room.add_vehicle(vehicle, pose).freejoint
  return Flown(mjcf.Physics.from_mjcf_model(room.mjcf_model), vehicle, joint)


@pytest.fixture
def flown() -> Flown:
  return fly()


@pytest.fixture(scope='module')
def hovering() -> Flown:
  """To be looked at, not moved."""
  return fly()


def test_the_vehicle_weighs_27_grams_with_its_frame(hovering: Flown) -> None:
  model = hovering.physics.model
  assert model.body_mass.sum() == pytest.approx(0.027, abs=1e-12)
  assert crazyflie.MASS_KG == 0.027


def test_its_inertia_is_menageries_about_the_centre_of_mass(
  hovering: Flown,
) -> None:
  body = hovering.physics.bind(hovering.vehicle.airframe)
  np.testing.assert_allclose(
    body.inertia, (23.951e-6, 23.951e-6, 32.347e-6), rtol=1e-12
  )
  np.testing.assert_array_equal(body.ipos, 0)
  np.testing.assert_allclose(body.iquat, (1, 0, 0, 0))
  assert hovering.physics.model.body_inertia.sum() == pytest.approx(80.249e-6)


def test_it_falls_freely_when_nothing_holds_it(flown: Flown) -> None:
  time_s = 100 * flown.physics.timestep()
  flown.step(100)
  qpos, qvel = flown.state
  assert qpos[2] - 1.3 == pytest.approx(-GRAVITY_MPS2 * time_s**2 / 2, rel=0.02)
  assert qvel[2] == pytest.approx(-GRAVITY_MPS2 * time_s)
  np.testing.assert_allclose(qvel[[0, 1, 3, 4, 5]], 0, atol=1e-12)


def test_its_weight_in_lift_holds_it(flown: Flown) -> None:
  airframe = flown.physics.bind(flown.vehicle.airframe)
  airframe.xfrc_applied[2] = 0.027 * GRAVITY_MPS2
  before, _ = flown.state
  flown.step(500)
  np.testing.assert_allclose(flown.state[0], before, atol=1e-9)


@pytest.mark.parametrize(
  ('axis', 'inertia_kg_m2'), [(0, 23.951e-6), (1, 23.951e-6), (2, 32.347e-6)]
)
def test_a_torque_turns_it_as_fast_as_its_inertia_says(
  flown: Flown, axis: int, inertia_kg_m2: float
) -> None:
  flown.physics.model.opt.gravity[:] = 0
  with flown.physics.reset_context():
    flown.physics.bind(flown.joint).qpos[3:] = (1, 0, 0, 0)
  airframe = flown.physics.bind(flown.vehicle.airframe)
  airframe.xfrc_applied[3 + axis] = 1e-6
  flown.step(50)
  expected_rad_s = 1e-6 / inertia_kg_m2 * 50 * flown.physics.timestep()
  turn_rad_s = np.array(flown.state[1][3:])
  assert turn_rad_s[axis] == pytest.approx(expected_rad_s, rel=1e-3)
  np.testing.assert_allclose(np.delete(turn_rad_s, axis), 0, atol=1e-9)


def test_it_lands_on_its_feet() -> None:
  flown = fly(layouts.Pose((0, 0, 0.06), 0.0))
  flown.step(1000)
  qpos, qvel = flown.state
  assert qpos[2] == pytest.approx(0.0145, abs=5e-4)
  np.testing.assert_allclose(qvel, 0, atol=1e-3)


@pytest.mark.parametrize(
  ('offset_m', 'touch'),
  [
    ((0.136, 0, 0), True),
    ((0.138, 0, 0), False),
    ((0, 0.136, 0), True),
    ((0.0971, 0.0971, 0), False),
    ((0, 0, 0.028), True),
    ((0, 0, 0.030), False),
  ],
)
def test_two_vehicles_touch_when_their_hulls_do(
  offset_m: tuple[float, float, float], touch: bool
) -> None:
  room = flight_room.FlightRoom()
  for name, shift in (('performer', 0.0), ('observer_1', 1.0)):
    position_m = np.array(HOVER.position_m) + shift * np.array(offset_m)
    room.add_vehicle(
      crazyflie.Crazyflie(name), layouts.Pose(tuple(position_m), 0.0)
    )
  physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
  assert bool(physics.data.ncon) == touch


def drawn_geoms(flown: Flown) -> list[int]:
  """Geoms of the vehicle that the default view draws."""
  model, data = flown.physics.model.ptr, flown.physics.data.ptr
  scene = mujoco.MjvScene(model, 200)
  mujoco.mjv_updateScene(
    model, data, mujoco.MjvOption(), None, mujoco.MjvCamera(),
    mujoco.mjtCatBit.mjCAT_DYNAMIC, scene,
  )  # fmt: skip
  return [geom.objid for geom in scene.geoms[: scene.ngeom]]


def test_it_is_drawn_with_at_most_3000_triangles(hovering: Flown) -> None:
  model = hovering.physics.model
  geoms = drawn_geoms(hovering)
  # Meshes only: the count needs no knowledge of the tessellation.
  assert {*model.geom_type[geoms]} == {int(mujoco.mjtGeom.mjGEOM_MESH)}
  triangles = sum(model.mesh_facenum[model.geom_dataid[g]] for g in geoms)
  assert 1000 < triangles <= 3000


def test_every_part_is_drawn_opaque_weightless_and_out_of_the_way(
  hovering: Flown,
) -> None:
  model = hovering.physics.model
  geoms = drawn_geoms(hovering)
  names = {model.id2name(geom, 'geom').split('/')[1] for geom in geoms}
  assert names == {
    'board', 'battery', 'label', 'deck', 'pins', 'mounts', 'motors', 'lights',
    'front_rotors', 'rear_rotors', 'propellers',
  }  # fmt: skip
  np.testing.assert_array_equal(model.geom_rgba[geoms, 3], 1)
  np.testing.assert_array_equal(model.geom_contype[geoms], 0)
  np.testing.assert_array_equal(model.geom_conaffinity[geoms], 0)


def corners_m(flown: Flown, *names: str) -> np.ndarray:
  """Corners (V, 3) of the vehicle's meshes, or some of them, in its frame."""
  model, data = flown.physics.model, flown.physics.data
  centre = flown.physics.bind(flown.vehicle.centre)
  corners = []
  for geom in drawn_geoms(flown):
    if names and model.id2name(geom, 'geom').split('/')[1] not in names:
      continue
    mesh = model.geom_dataid[geom]
    first = model.mesh_vertadr[mesh]
    vertices = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
    world = (
      data.geom_xpos[geom] + vertices @ data.geom_xmat[geom].reshape(3, 3).T
    )
    corners.append((world - centre.xpos) @ centre.xmat.reshape(3, 3))
  return np.concatenate(corners)


def test_it_has_the_size_of_a_crazyflie(hovering: Flown) -> None:
  corners = corners_m(hovering)
  assert np.ptp(corners[:, 2]) == pytest.approx(0.029, abs=1e-4)
  radius_m = np.linalg.norm(corners[:, :2], axis=1).max()
  assert 2 * radius_m == pytest.approx(crazyflie.DIAMETER_M, abs=1e-4)
  assert pytest.approx(0.137) == crazyflie.DIAMETER_M


def test_motors_stand_on_diagonals_and_the_front_rotors_are_in_front(
  hovering: Flown,
) -> None:
  legs = corners_m(hovering, 'mounts')
  feet = legs[legs[:, 2] < -0.0144]
  for x in (-1, 1):
    for y in (-1, 1):
      foot = feet[(np.sign(feet[:, 0]) == x) & (np.sign(feet[:, 1]) == y)]
      np.testing.assert_allclose(
        np.abs(foot[:, :2].mean(0)), 0.046 * math.sqrt(0.5), atol=5e-4
      )
  assert corners_m(hovering, 'front_rotors')[:, 0].min() > 0
  assert corners_m(hovering, 'rear_rotors')[:, 0].max() < 0


def test_the_accent_tells_vehicles_apart() -> None:
  rgba = (0.1, 0.2, 0.3, 1.0)
  plain, marked = crazyflie.Crazyflie(), crazyflie.Crazyflie(accent_rgba=rgba)
  differing = [
    geom.name
    for geom, other in zip(
      plain.airframe.geom, marked.airframe.geom, strict=True
    )
    if geom.rgba is not None and tuple(geom.rgba) != tuple(other.rgba)
  ]
  assert differing == ['label', 'front_rotors']


@dataclasses.dataclass(frozen=True)
class View:
  """A camera on a sphere around the hovering vehicle."""

  distance_m: float
  azimuth_deg: float
  elevation_deg: float

  @property
  def name(self) -> str:
    return f'from_{self.distance_m}_{self.azimuth_deg}_{self.elevation_deg}'

  def add(self, room: flight_room.FlightRoom) -> None:
    azimuth, elevation = np.radians([self.azimuth_deg, self.elevation_deg])
    back = np.array((
      math.sin(azimuth) * math.cos(elevation),
      -math.cos(azimuth) * math.cos(elevation),
      math.sin(elevation),
    ))  # fmt: skip
    right = np.array((math.cos(azimuth), math.sin(azimuth), 0.0))
    room.mjcf_model.worldbody.add(
      'camera',
      name=self.name,
      pos=HOVER.position_m + self.distance_m * back,
      xyaxes=(*right, *np.cross(back, right)),
      fovy=60,
    )


# At the hover's height, from below as at START's top, and from above.
VIEWS = [
  View(distance_m, azimuth_deg, elevation_deg)
  for distance_m in (1.0, 1.3, 1.6)
  for azimuth_deg in (-40, 0, 30)
  for elevation_deg in (-30, 0, 15)
] + [View(1.3, azimuth_deg, 0) for azimuth_deg in (90, 180)]


@pytest.fixture(scope='module')
def pictures() -> dict[str, tuple[np.ndarray, np.ndarray]]:
  """For each view the grey picture with the vehicle, and without."""
  room = flight_room.FlightRoom()
  joint = room.add_vehicle(crazyflie.Crazyflie('performer'), HOVER).freejoint
  for view in VIEWS:
    view.add(room)
  physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)

  def grey(view: View) -> np.ndarray:
    samples = physics.render(960, 1280, camera_id=view.name)
    image = cv2.resize(samples, (640, 480), interpolation=cv2.INTER_AREA)
    return cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)

  present = {view.name: grey(view) for view in VIEWS}
  with physics.reset_context():
    physics.bind(joint).qpos[:3] = (0, 0, -5)
  return {view.name: (present[view.name], grey(view)) for view in VIEWS}


@pytest.mark.parametrize('view', VIEWS, ids=lambda view: view.name)
def test_it_stands_out_from_every_side(
  view: View, pictures: dict[str, tuple[np.ndarray, np.ndarray]]
) -> None:
  present, absent = pictures[view.name]
  changed = cv2.absdiff(present, absent) > 10
  rows, columns = (np.flatnonzero(changed.any(axis)) for axis in (1, 0))
  pixels_per_m = 415.7 / view.distance_m
  # Between the square's side and its diagonal, rotors included.
  assert 0.105 < np.ptp(columns) / pixels_per_m < 0.150
  assert np.ptp(rows) / pixels_per_m > 0.022
  assert present[changed].max() > 190
  assert present[changed].min() < 60


@pytest.mark.parametrize('view', VIEWS, ids=lambda view: view.name)
def test_a_tracker_finds_corners_on_it_and_nowhere_else(
  view: View, pictures: dict[str, tuple[np.ndarray, np.ndarray]]
) -> None:
  present, absent = pictures[view.name]
  centre = np.zeros_like(present)
  centre[204:276, 284:356] = 255
  corners = cv2.goodFeaturesToTrack(present, 60, 0.05, 3, mask=centre)
  assert len(corners) >= 7
  changed = (cv2.absdiff(present, absent) > 2).astype(np.uint8)
  near = cv2.dilate(changed, np.ones((5, 5)))
  columns, rows = corners.reshape(-1, 2).round().astype(int).T
  assert near[rows, columns].all()


def test_observables_are_off_by_default() -> None:
  vehicle = crazyflie.Crazyflie()
  observables = vehicle.observables.as_dict()
  assert set(observables) == {'position_m', 'velocity_mps', 'orientation'}
  assert not any(each.enabled for each in observables.values())


def test_observables_tell_the_true_state_in_world_axes(flown: Flown) -> None:
  yaw_rad = 0.5
  with flown.physics.reset_context():
    joint = flown.physics.bind(flown.joint)
    joint.qpos[:] = (
      0.1, -0.2, 1.4, math.cos(yaw_rad / 2), 0, 0, math.sin(yaw_rad / 2)
    )  # fmt: skip
    joint.qvel[:] = (0.3, 0.4, -0.5, 0, 0, 2.0)
  c, s = math.cos(yaw_rad), math.sin(yaw_rad)
  expected = {
    'position_m': (0.1, -0.2, 1.4),
    'velocity_mps': (0.3, 0.4, -0.5),
    'orientation': ((c, -s, 0), (s, c, 0), (0, 0, 1)),
  }
  for name, value in expected.items():
    observable = getattr(flown.vehicle.observables, name)
    got = np.array(observable.observation_callable(flown.physics)())
    assert got.dtype == np.float64
    np.testing.assert_allclose(got, value, atol=1e-12)


def test_velocity_is_as_fresh_as_position_after_a_step(flown: Flown) -> None:
  flown.step(1)
  observable = flown.vehicle.observables.velocity_mps
  velocity = observable.observation_callable(flown.physics)()
  np.testing.assert_allclose(velocity, flown.state[1][:3], atol=1e-12)
