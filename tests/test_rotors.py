"""Vehicles with rotors, beside closed forms of physics and within limits."""

from collections.abc import Callable, Iterator
import math

from dm_control import mjcf
import hypothesis
from hypothesis import strategies
from hypothesis.extra import numpy as arrays
import numpy as np
import pytest

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import (
  attitudes,
  autopilot,
  cascade,
  crazyflie,
  mixer,
  rotors,
  unknown,
)
from waggle_tasks.protocol import gestures, limits, minimum_jerk
from waggle_tasks.protocol.symbols import Symbol

PLACE_M = np.array([0.2, -0.3, 1.5])
YAW_RAD = 0.7
REST = np.zeros(3)
MASS_KG, GRAVITY_MPS2 = crazyflie.MASS_KG, 9.81
WEIGHT_N = MASS_KG * GRAVITY_MPS2
FRAME_S, STEP_S = 0.04, 0.004
Motion = Callable[[float], tuple[np.ndarray, np.ndarray, np.ndarray]]


class Rig:
  """One vehicle with rotors in a room."""

  def __init__(self, air: unknown.Air = unknown.Air()) -> None:
    room = flight_room.FlightRoom()
    vehicle = crazyflie.Crazyflie()
    room.add_vehicle(vehicle, layouts.Pose(tuple(PLACE_M), YAW_RAD))
    self.pilot = autopilot.Autopilot(
      room.mjcf_model, {'crazyflie': vehicle}, [YAW_RAD], FRAME_S
    )
    room.mjcf_model.option.timestep = STEP_S
    self.physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
    self.pilot.after_compile(self.physics)
    self.pilot.begin(self.physics, air)
    self.physics.forward()
    self.rotors, self.drags = slice(0, 4), slice(4, 7)

  @property
  def tilt_rad(self) -> float:
    return float(self.pilot.tilts_rad[0])

  def fly(
    self, motion: Motion, seconds: float, turn_rad: float = 0.0
  ) -> Iterator[float]:
    """Flies a motion, and yields the time at the end of each frame."""
    (seat,) = self.pilot.seats.values()
    begin_s = self.physics.time()
    while (now_s := self.physics.time() - begin_s) < seconds - 1e-6:
      seat.command(self.physics, *motion(now_s + FRAME_S / 2), turn_rad)
      for _ in range(round(FRAME_S / STEP_S)):
        self.pilot.before_substep(self.physics)
        self.physics.step()
      yield now_s + FRAME_S

  def let_go(self, gravity: bool = True) -> None:
    """Takes the rotors away, and with them the autopilot."""
    self.physics.model.actuator_gainprm[self.rotors, 0] = 0.0
    if not gravity:
      self.physics.model.opt.gravity[:] = 0.0
    self.physics.forward()


@pytest.fixture
def rig() -> Iterator[Callable[..., Rig]]:
  made = []

  def make(air: unknown.Air = unknown.Air()) -> Rig:
    made.append(Rig(air))
    return made[-1]

  yield make
  for each in made:
    each.physics.free()


def hover(place_m: np.ndarray = PLACE_M) -> Motion:
  return lambda time_s: (place_m, REST, REST)


def test_a_hover_takes_a_quarter_of_the_weight_of_each_rotor(
  rig: Callable[..., Rig],
) -> None:
  flight = rig()
  for _ in flight.fly(hover(), 3.0):
    np.testing.assert_allclose(
      flight.pilot.thrusts_n, WEIGHT_N / 4, rtol=0, atol=1e-9
    )
  np.testing.assert_allclose(flight.physics.data.qpos[:3], PLACE_M, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
  'offset_m', [(0.3, 0.0, 0.0), (0.0, 0.0, 0.5), (0.2, 0.2, -0.4)]
)
def test_a_step_is_flown_to_its_end_with_little_overshoot(
  offset_m: tuple[float, float, float], rig: Callable[..., Rig]
) -> None:
  flight, way_m = rig(), np.array(offset_m)
  share = [
    (flight.physics.data.qpos[:3] - PLACE_M) @ way_m / (way_m @ way_m)
    for _ in flight.fly(hover(PLACE_M + way_m), 5.0)
  ]
  assert max(share) < 1.1
  assert share[-1] == pytest.approx(1.0, abs=0.01)


def test_a_circle_is_flown_at_the_tilt_that_it_takes(
  rig: Callable[..., Rig],
) -> None:
  """tan(tilt) = v^2 / (r g) towards the middle, and drag along the way."""
  radius_m, rate_s = 0.3, 2.0
  middle_m = PLACE_M - (radius_m, 0.0, 0.0)

  def around(time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    angle = rate_s * time_s
    out = radius_m * np.array([math.cos(angle), math.sin(angle), 0.0])
    along = radius_m * np.array([-math.sin(angle), math.cos(angle), 0.0])
    return middle_m + out, rate_s * along, -(rate_s**2) * out

  flight, tilts, errors_m = rig(), [], []
  for time_s in flight.fly(around, 6.0):
    if time_s > 3.0:
      tilts.append(flight.tilt_rad)
      place_m = flight.physics.data.qpos[:3]
      errors_m.append(np.linalg.norm(place_m - around(time_s)[0]))
  speed_mps = radius_m * rate_s
  force_mps2 = np.hypot(
    speed_mps**2 / radius_m, speed_mps * rotors.DRAG_NS_M[0] / MASS_KG
  )
  wanted_rad = math.atan(force_mps2 / GRAVITY_MPS2)
  np.testing.assert_allclose(tilts, wanted_rad, rtol=0.03)
  assert max(errors_m) < 0.01


@pytest.mark.slow
def test_a_v_is_flown_at_the_tilt_that_its_pace_takes(
  rig: Callable[..., Rig],
) -> None:
  """A = g tan(tilt), less what drag takes; the default gesture of a bit."""
  gesture = gestures.v_codebook()[Symbol.ZERO]

  def dance(time_s: float) -> tuple[np.ndarray, ...]:
    offset, rate, second = (
      np.array([each[0], 0.0, each[1]])
      for each in gesture.motion(min(max(time_s, 0.0), gesture.duration_s))
    )
    return PLACE_M + offset, rate, second

  flight, errors_m, tilts, wanted = rig(), [], [], []
  for time_s in flight.fly(dance, gesture.duration_s):
    place_m, rate_mps, second_mps2 = dance(time_s)
    errors_m.append(np.linalg.norm(flight.physics.data.qpos[:3] - place_m))
    aside = second_mps2[0] + rate_mps[0] * rotors.DRAG_NS_M[0] / MASS_KG
    up = GRAVITY_MPS2 + second_mps2[2]
    wanted.append(math.degrees(math.atan(abs(aside) / up)))
    tilts.append(math.degrees(flight.tilt_rad))
  apart_deg = np.array(tilts) - wanted
  assert max(wanted) > 2.5
  assert np.sqrt((apart_deg**2).mean()) < 0.7
  assert np.abs(apart_deg.mean()) < 0.2
  assert max(errors_m) < 0.005


def test_a_rotor_follows_a_step_by_its_time_constant(
  rig: Callable[..., Rig],
) -> None:
  physics, begin_n, end_n = rig().physics, WEIGHT_N / 4, 0.1
  physics.data.ctrl[:4] = end_n
  for _ in range(60):
    physics.step()
    kept = math.exp(-physics.time() / rotors.LAG_S)
    wanted_n = end_n + (begin_n - end_n) * kept
    np.testing.assert_allclose(physics.data.act, wanted_n, rtol=1e-9)
  assert pytest.approx(0.0647, abs=1e-4) == rotors.LAG_S


def test_a_turned_body_thrusts_along_its_own_axis(
  rig: Callable[..., Rig],
) -> None:
  flight = rig()
  physics, tilt_rad = flight.physics, math.radians(10.0)
  physics.data.qpos[3:7] = [
    math.cos(tilt_rad / 2),
    0,
    math.sin(tilt_rad / 2),
    0,
  ]
  physics.data.ctrl[:4] = physics.data.act[:] = 0.08
  physics.forward()
  force = np.array([math.sin(tilt_rad), 0.0, math.cos(tilt_rad)]) * 4 * 0.08
  gravity = np.array([0.0, 0.0, GRAVITY_MPS2])
  np.testing.assert_allclose(
    physics.data.qacc[:3], force / MASS_KG - gravity, atol=1e-6
  )


@pytest.mark.parametrize('axis', range(3))
def test_a_difference_between_rotors_turns_the_body(
  axis: int, rig: Callable[..., Rig]
) -> None:
  """Arm times thrust about x and y, the torque of propellers about z."""
  arm_m = crazyflie.ARM_M / math.sqrt(2)  # Front left first, then around.
  turn = [
    arm_m * np.array([1, 1, -1, -1]),
    arm_m * np.array([-1, 1, 1, -1]),
    rotors.TORQUE_M * np.array([1, -1, 1, -1]),
  ][axis]
  physics = rig().physics
  more_n = 0.01 * np.sign(turn)
  physics.data.act[:] = WEIGHT_N / 4 + more_n
  physics.forward()
  wanted = np.zeros(3)
  wanted[axis] = turn @ more_n / crazyflie.INERTIA_KG_M2[axis]
  np.testing.assert_allclose(physics.data.qacc[3:6], wanted, atol=1e-6)
  np.testing.assert_allclose(physics.data.qacc[:3], 0, atol=1e-6)


@pytest.mark.parametrize('axis', range(3))
def test_the_wind_takes_a_vehicle_along_to_its_own_speed(
  axis: int, rig: Callable[..., Rig]
) -> None:
  """Without weight and thrust: v = w (1 - exp(-d t / m))."""
  flight = rig()
  flight.let_go(gravity=False)
  physics, wind_mps = flight.physics, 0.4
  physics.data.qpos[3:7] = [1, 0, 0, 0]
  physics.data.ctrl[4 + axis] = wind_mps
  rate_s = rotors.DRAG_NS_M[axis] / MASS_KG
  for _ in range(500):
    physics.step()
  wanted_mps = wind_mps * -math.expm1(-rate_s * physics.time())
  assert physics.data.qvel[axis] == pytest.approx(wanted_mps, rel=2e-3)


def test_a_body_falls_by_the_law_of_a_linear_drag(
  rig: Callable[..., Rig],
) -> None:
  """Its terminal speed would be m g / d = 20.7 m/s."""
  flight = rig()
  flight.let_go()
  physics = flight.physics
  while physics.time() < 0.4 - 1e-9:
    physics.step()
  drag = rotors.DRAG_NS_M[2]
  terminal_mps = WEIGHT_N / drag
  wanted_mps = terminal_mps * math.expm1(-drag / MASS_KG * physics.time())
  assert physics.data.qvel[2] == pytest.approx(wanted_mps, rel=2e-3)


def test_a_spinning_body_keeps_its_momentum_and_precesses(
  rig: Callable[..., Rig],
) -> None:
  """Rates of a symmetric top turn about its axis at (C - A) / A of its spin."""
  flight = rig()
  flight.let_go(gravity=False)
  physics = flight.physics
  across, _, along = crazyflie.INERTIA_KG_M2
  physics.data.qvel[3:6] = (2.0, 0.0, 5.0)
  inertia = np.array(crazyflie.INERTIA_KG_M2)

  def momentum() -> np.ndarray:
    rotation = physics.named.data.xmat['crazyflie/airframe'].reshape(3, 3)
    return rotation @ (inertia * physics.data.qvel[3:6])

  physics.forward()
  before = momentum()
  for _ in range(250):
    physics.step()
  np.testing.assert_allclose(momentum(), before, rtol=0.02, atol=2e-6)
  angle = (along - across) / across * 5.0 * physics.time()
  wanted = (2.0 * math.cos(angle), 2.0 * math.sin(angle), 5.0)
  np.testing.assert_allclose(physics.data.qvel[3:6], wanted, atol=0.03)


def test_no_reference_asks_for_more_than_rotors_can(
  rig: Callable[..., Rig],
) -> None:
  low_n, high_n = limits.THRUST_N
  flight = rig()
  for offset_m in ((2.0, 2.0, 2.0), (-2.0, 0.0, -1.0)):
    for _ in flight.fly(hover(PLACE_M + offset_m), 1.0, turn_rad=3.0):
      thrusts_n = flight.pilot.thrusts_n
      assert low_n <= thrusts_n.min() <= thrusts_n.max() <= high_n
      assert math.degrees(flight.tilt_rad) < 30  # Asked for: 20.
  for _ in flight.fly(hover(), 8.0):
    pass
  np.testing.assert_allclose(flight.physics.data.qpos[:3], PLACE_M, atol=0.01)


@pytest.mark.slow
@pytest.mark.parametrize('turn_rad', [0.5, -1.5, 3.0])
def test_a_turn_is_counted_from_the_vehicles_own_heading(
  turn_rad: float, rig: Callable[..., Rig]
) -> None:
  flight = rig()
  for _ in flight.fly(hover(), 7.0, turn_rad):
    pass
  (yaw_rad,) = attitudes.heading(flight.physics.data.qpos[None, 3:7])
  apart_rad = math.remainder(yaw_rad - YAW_RAD - turn_rad, math.tau)
  assert apart_rad == pytest.approx(0, abs=0.01)
  np.testing.assert_allclose(flight.physics.data.qpos[:3], PLACE_M, atol=2e-3)


def test_a_push_is_recovered_from(rig: Callable[..., Rig]) -> None:
  flight = rig()
  flight.physics.data.qvel[:6] = (0.5, -0.5, 0.5, 3.0, -3.0, 3.0)
  for _ in flight.fly(hover(), 5.0):
    pass
  np.testing.assert_allclose(flight.physics.data.qpos[:3], PLACE_M, atol=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize('size_m', [0.06, 0.2, 0.5])
@pytest.mark.parametrize('up', [False, True])
def test_what_the_limits_allow_is_flown_within_30_mm(
  size_m: float, up: bool, rig: Callable[..., Rig]
) -> None:
  """There and back, as fast as a dance may ask for."""
  most = limits.LIMITS['rotors']
  fastest_mps2 = most.up_mps2 if up else most.sideways_mps2
  leg_s = math.sqrt(5.774 * size_m / fastest_mps2)
  leg_s = max(leg_s, 1.875 * size_m / most.speed_mps)
  if not up:
    leg_s = max(leg_s, (60 * size_m / most.sideways_mps3) ** (1 / 3))
  way_m = size_m * np.array([0.0, 0.0, 1.0] if up else [1.0, 0.0, 0.0])

  def dance(time_s: float) -> tuple[np.ndarray, ...]:
    there = minimum_jerk.between(REST, way_m, time_s, leg_s)
    back = minimum_jerk.between(way_m, REST, time_s - leg_s, leg_s)
    place_m, rate, second = there if time_s < leg_s else back
    return PLACE_M + place_m, rate, second

  flight = rig()
  for time_s in flight.fly(dance, 2 * leg_s + 1.0):
    place_m = flight.physics.data.qpos[:3]
    assert np.linalg.norm(place_m - dance(time_s)[0]) < 0.03
    assert math.degrees(flight.tilt_rad) < 20


def numbers(*shape: int, most: float) -> strategies.SearchStrategy[np.ndarray]:
  return arrays.arrays(float, shape, elements=strategies.floats(-most, most))


@hypothesis.given(numbers(3, 3, most=50.0))
def test_the_thrust_that_is_asked_for_tilts_by_20_degrees_at_most(
  asked_mps2: np.ndarray,
) -> None:
  force = cascade.force(asked_mps2)
  tilts = np.arctan2(np.hypot(force[:, 0], force[:, 1]), force[:, 2])
  assert (tilts <= limits.TILT_RAD + 1e-9).all()
  total_n = MASS_KG * np.linalg.norm(force, axis=1)
  low_n, high_n = limits.THRUST_N
  assert (total_n > 4 * low_n).all()
  assert (total_n < 4 * high_n).all()


@hypothesis.given(numbers(2, 4, most=1.0))
# Of the first, yaw makes room for what would not fit without it.
@hypothesis.example(np.array([[0.25, 0.125, 0.125, 0.125], [0.125] * 4]))
def test_a_mix_stays_within_the_limits_and_keeps_what_fits(
  share: np.ndarray,
) -> None:
  demand = share * (0.3, 0.02, 0.02, 0.005) + (0.26, 0, 0, 0)
  thrusts_n = mixer.mix(demand)
  low_n, high_n = limits.THRUST_N
  assert low_n - 1e-12 <= thrusts_n.min() <= thrusts_n.max() <= high_n + 1e-12
  given = thrusts_n @ rotors.EFFECT.T
  plain = demand @ np.linalg.inv(rotors.EFFECT).T
  fits = (plain >= low_n).all(axis=1) & (plain <= high_n).all(axis=1)
  np.testing.assert_allclose(given[fits], demand[fits], atol=1e-12)
  # Roll and pitch go last: they keep their direction, and never grow.
  asked, got = demand[:, 1:3], given[:, 1:3]
  across = asked[:, 0] * got[:, 1] - asked[:, 1] * got[:, 0]
  np.testing.assert_allclose(across, 0, atol=1e-9)
  assert ((got**2).sum(1) <= (asked**2).sum(1) + 1e-12).all()


@hypothesis.given(numbers(4, 3, most=0.3), numbers(4, most=3.1))
def test_an_attitude_thrusts_where_it_should_with_its_heading(
  aside: np.ndarray, yaw_rad: np.ndarray
) -> None:
  force = aside + np.array([0.0, 0.0, 1.0])
  quaternion = attitudes.thrusting(force, yaw_rad)
  w, x, y, z = quaternion.T
  axis = np.stack(
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1
  )
  unit = force / np.linalg.norm(force, axis=1, keepdims=True)
  np.testing.assert_allclose(axis, unit, atol=1e-12)
  np.testing.assert_allclose(attitudes.heading(quaternion), yaw_rad, atol=1e-9)
  # Turned a little, and back by what the error says.
  turn_rad = 0.01 * aside
  other = attitudes.turned(quaternion, turn_rad)
  error = (attitudes.error(quaternion) @ other[:, :, None])[:, :, 0]
  np.testing.assert_allclose(2 * error, turn_rad, atol=1e-6)
