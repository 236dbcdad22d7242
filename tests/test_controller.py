"""The ideal controller: it holds, turns, recovers, and has its limits."""

from collections.abc import Callable, Iterator
import math

from dm_control import mjcf
import mujoco
import numpy as np
import pytest

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import controller, crazyflie

PLACE_M = np.array([0.5, -0.5, 1.3])
YAW_RAD = 0.7
REST = np.zeros(3)
Hold = Callable[..., None]
Scene = tuple[mjcf.Physics, controller.Controller]


@pytest.fixture
def scene() -> Iterator[Scene]:
  """A vehicle in a room, at rest at its place."""
  room = flight_room.FlightRoom()
  vehicle = crazyflie.Crazyflie()
  room.add_vehicle(vehicle, layouts.Pose(tuple(PLACE_M), YAW_RAD))
  pilot = controller.Controller(room.mjcf_model, vehicle, YAW_RAD)
  room.mjcf_model.option.timestep = 0.004
  physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
  pilot.after_compile(physics)
  yield physics, pilot
  physics.free()


@pytest.fixture
def hold(scene: Scene) -> Hold:
  """Flies a reference at rest for some time."""
  physics, pilot = scene

  def run(
    duration_s: float, position_m: np.ndarray, turn_rad: float = 0.0
  ) -> None:
    for _ in range(round(duration_s / 0.04)):
      pilot.command(physics, position_m, REST, REST, turn_rad)
      physics.step(10)

  return run


def yaw_rad(physics: mjcf.Physics) -> float:
  w, x, y, z = physics.data.qpos[3:7]
  return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def test_a_hover_holds_its_place(scene: Scene, hold: Hold) -> None:
  physics, _ = scene
  hold(5.0, PLACE_M)
  np.testing.assert_allclose(physics.data.qpos[:3], PLACE_M, atol=5e-5)
  assert yaw_rad(physics) == pytest.approx(YAW_RAD, abs=1e-6)


@pytest.mark.parametrize(
  'offset_m', [(0.3, 0, 0), (0, -0.3, 0), (0, 0, 0.5), (0.2, 0.2, -0.4)]
)
def test_a_step_is_flown_to_its_end_with_little_overshoot(
  scene: Scene, hold: Hold, offset_m: tuple[float, float, float]
) -> None:
  physics, _ = scene
  way_m = np.array(offset_m)
  hold(3.0, PLACE_M + way_m)
  flown_m = physics.data.qpos[:3] - PLACE_M
  np.testing.assert_allclose(flown_m, way_m, atol=1e-3)
  np.testing.assert_allclose(physics.data.qvel[:6], 0, atol=1e-2)


@pytest.mark.parametrize('turn_rad', [0.5, -1.5, 3.0])
def test_a_turn_is_counted_from_the_vehicles_own_heading(
  scene: Scene, hold: Hold, turn_rad: float
) -> None:
  physics, _ = scene
  hold(3.0, PLACE_M, turn_rad)
  apart_rad = yaw_rad(physics) - YAW_RAD - turn_rad
  assert math.remainder(apart_rad, math.tau) == pytest.approx(0, abs=1e-2)
  np.testing.assert_allclose(physics.data.qpos[:3], PLACE_M, atol=1e-3)


@pytest.mark.parametrize('turn_rad', [0.0, 1.5, -2.8, 3.1])
def test_a_small_attitude_is_flown_beside_any_turn(
  scene: Scene, turn_rad: float
) -> None:
  """Roll to the right, pitch with the nose down, yaw to the left."""
  physics, pilot = scene
  wanted_rad = np.radians([2.0, -3.0, 1.5])
  lean = np.stack([wanted_rad, REST, REST])
  for step in range(150):
    grown = min(step / 75, 1.0)
    pilot.command(physics, PLACE_M, REST, REST, grown * turn_rad, lean)
    physics.step(10)
  half = (YAW_RAD + turn_rad + wanted_rad[2]) / 2
  back = np.array([math.cos(half), 0.0, 0.0, -math.sin(half)])
  level = np.zeros(4)
  mujoco.mju_mulQuat(level, back, physics.data.qpos[3:7])
  sign = math.copysign(1.0, level[0])
  np.testing.assert_allclose(
    2 * sign * level[1:], (*wanted_rad[:2], 0.0), atol=2e-3
  )
  np.testing.assert_allclose(physics.data.qpos[:3], PLACE_M, atol=1e-3)


def test_a_level_reference_is_what_it_has_always_been(
  scene: Scene, hold: Hold
) -> None:
  """To the last bit: results of before are made again."""
  physics, _ = scene
  before = physics.model.site_quat.copy(), physics.model.site_sameframe.copy()
  hold(1.0, PLACE_M, 0.7)
  assert physics.data.ctrl[3:].tolist() == [0.0, 0.0, 0.7]
  np.testing.assert_array_equal(before[0], physics.model.site_quat)
  np.testing.assert_array_equal(before[1], physics.model.site_sameframe)


def test_a_push_is_recovered_from(scene: Scene, hold: Hold) -> None:
  physics, _ = scene
  hold(0.4, PLACE_M)
  physics.data.qvel[:6] = (0.5, -0.5, 0.5, 3.0, -3.0, 3.0)
  hold(0.08, PLACE_M)
  assert np.linalg.norm(physics.data.qpos[:3] - PLACE_M) > 0.02
  hold(3.0, PLACE_M)
  np.testing.assert_allclose(physics.data.qpos[:3], PLACE_M, atol=1e-3)
  assert yaw_rad(physics) == pytest.approx(YAW_RAD, abs=1e-2)


def test_no_reference_asks_for_more_than_the_vehicle_can(
  scene: Scene, hold: Hold
) -> None:
  physics, _ = scene
  hold(0.04, PLACE_M + np.array([5.0, -5.0, 5.0]))
  force_n = physics.data.qfrc_actuator[:3]
  # Menagerie's thrust; sideways the stock firmware's 20 degrees of tilt.
  side_n = crazyflie.MASS_KG * 9.81 * math.tan(math.radians(20.0))
  np.testing.assert_allclose(force_n, (side_n, -side_n, 0.35), rtol=2e-3)
  hold(0.04, PLACE_M - np.array([0.0, 0.0, 5.0]))
  assert physics.data.qfrc_actuator[2] == 0  # Rotors cannot pull down.
