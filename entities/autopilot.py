"""Flies all vehicles that have rotors, between one physics step and the next.

The inner law of `cascade` runs before every physics step, 250 times a second,
the outer one about 50 times. What the laws remember is in MuJoCo's own
`userdata`, so that whoever sets the physics to an earlier state sees the same
flight again.
"""

from collections.abc import Mapping, Sequence
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import attitudes, cascade, crazyflie, rotors, unknown

_OUTER_S = 0.02
# Numbers that are remembered for each vehicle: its integral, and the
# acceleration of the reference before.
_MEMORY = 2, 3
_JERK_MPS3 = 30.0  # Of a reference that jumps there is no telling.


class Seat:
  """What commands one of the vehicles, as a `controller.Controller` does."""

  def __init__(self, autopilot: 'Autopilot', number: int) -> None:
    """Takes a place among the vehicles."""
    self._autopilot, self._number = autopilot, number

  def command(
    self,
    physics: mjcf.Physics,
    position_m: np.ndarray,  # (3,)
    velocity_mps: np.ndarray,  # (3,)
    acceleration_mps2: np.ndarray,  # (3,)
    turn_rad: float = 0.0,
    attitude_rad: np.ndarray | None = None,  # (3, 3)
  ) -> None:
    """Sets the reference of the coming control step; see `Controller`.

    Of an attitude, roll, pitch and yaw, only yaw can be asked for: the others
    follow from the flight.
    """
    if attitude_rad is not None:
      turn_rad += attitude_rad[0, 2]
    motion = position_m, velocity_mps, acceleration_mps2
    self._autopilot.take(physics, self._number, motion, turn_rad)


class Autopilot:
  """Flies any number of vehicles; `seats` has one for each, by its name."""

  def __init__(
    self,
    root: mjcf.RootElement,
    vehicles: Mapping[str, crazyflie.Crazyflie],
    yaws_rad: Sequence[float],
    frame_s: float,
  ) -> None:
    """Gives vehicles their rotors, and makes room for what laws remember.

    Args:
      root: The model that the vehicles are attached to.
      vehicles: The attached vehicles, by name.
      yaws_rad: The heading from which each one's turns are counted.
      frame_s: How long a control step is.
    """
    self._vehicles, self._frame_s = tuple(vehicles.values()), frame_s
    self._mounted = [rotors.mount(each) for each in self._vehicles]
    self._yaws_rad = np.array(yaws_rad)
    self.seats = {name: Seat(self, i) for i, name in enumerate(vehicles)}
    root.size.nuserdata = len(vehicles) * int(np.prod(_MEMORY))
    count = len(vehicles)
    self._reference = np.zeros((3, count, 3))
    self._turns_rad = np.zeros(count)
    self._jerk = np.zeros((count, 3))
    self._air_mps = np.zeros((count, 3))

  def after_compile(self, physics: mjcf.Physics) -> None:
    """Finds joints and actuators in a compiled model."""
    model, data = physics.model.ptr, physics.data.ptr
    bodies = physics.bind([each.airframe for each in self._vehicles])
    roots = model.body_rootid[bodies.element_id]
    joints = model.body_jntadr[roots]
    places, rates = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
    thrusts, drags = (
      np.array([physics.bind(e).element_id for e in each])
      for each in zip(
        *((each.thrusts, each.drags) for each in self._mounted), strict=True
      )
    )
    self._bodies, self._rotors, self._drags = bodies.element_id, thrusts, drags
    self._acts = model.actuator_actadr[thrusts]
    self._places = places[:, None] + np.arange(3)
    self._attitudes = places[:, None] + np.arange(3, 7)
    self._speeds = rates[:, None] + np.arange(3)
    self._rates = rates[:, None] + np.arange(3, 6)
    # Views of the data's own memory.
    self._qpos, self._qvel, self._xmat = data.qpos, data.qvel, data.xmat
    self._act, self._ctrl = data.act, data.ctrl
    self._memory = data.userdata.reshape(-1, *_MEMORY)
    times = max(1, round(self._frame_s / _OUTER_S))  # In a control step.
    self._period_s = self._frame_s / times
    self._every = math.ceil(self._period_s / physics.timestep() - 1e-6)

  def begin(
    self,
    physics: mjcf.Physics,
    air: unknown.Air = unknown.Air(),
    belief: unknown.Belief = unknown.Belief(),
  ) -> None:
    """Begins an episode: as if vehicles had hovered where they are for long.

    Args:
      physics: The compiled model, with every vehicle at its place.
      air: What the air does.
      belief: What vehicles know of themselves.
    """
    self._air, self._belief = air, belief
    level = np.broadcast_to(np.eye(3), (len(self._yaws_rad), 3, 3))
    self._blow(physics.time(), level)
    self._memory[:] = 0.0
    self._memory[:, 0] = -self._air_mps * rotors.DRAG_NS_M / crazyflie.MASS_KG
    force = cascade.force(self._memory[:, 0])
    self._qpos[self._attitudes] = attitudes.thrusting(force, self._yaws_rad)
    thrust_n = crazyflie.MASS_KG * np.linalg.norm(force, axis=1)
    self._act[self._acts] = thrust_n[:, None] / 4
    self._ctrl[self._rotors] = thrust_n[:, None] / 4
    self._since = 0

  def take(
    self,
    physics: mjcf.Physics,
    number: int,
    motion: Sequence[np.ndarray],  # Position, velocity, acceleration, (3,) each
    turn_rad: float,
  ) -> None:
    """Takes a vehicle's reference for the middle of the coming control step."""
    self._reference[:, number] = motion
    self._turns_rad[number] = turn_rad
    self._middle_s = physics.time() + self._frame_s / 2
    self._since = 0

  def before_substep(self, physics: mjcf.Physics) -> None:
    """Commands all rotors for the coming physics step."""
    if self._since % self._every == 0:
      self._aim(physics.data.time, self._since == 0)
    self._since += 1
    self._ctrl[self._rotors] = self._law.command(
      self._qpos[self._attitudes],
      self._qvel[self._rates],
      self._act[self._acts],
    )

  @property
  def air_mps(self) -> np.ndarray:
    """(N, 3) world velocities of the air where vehicles are."""
    return self._air_mps

  @property
  def thrusts_n(self) -> np.ndarray:
    """(N, 4) thrusts of the rotors."""
    return self._act[self._acts]

  @property
  def tilts_rad(self) -> np.ndarray:
    """(N,) how far each vehicle is from level."""
    return np.arccos(np.clip(self._xmat[self._bodies, 8], -1.0, 1.0))

  def _aim(self, time_s: float, begins: bool) -> None:
    """Asks the outer law."""
    position, velocity, acceleration = self._reference
    if begins:  # Of a control step: its reference is new.
      changed = acceleration - self._memory[:, 1]
      self._jerk = np.clip(changed / self._frame_s, -_JERK_MPS3, _JERK_MPS3)
      self._memory[:, 1] = acceleration
    ahead_s = time_s - self._middle_s
    wanted = cascade.Wanted(
      position + velocity * ahead_s + acceleration * ahead_s**2 / 2,
      velocity + acceleration * ahead_s,
      acceleration + self._jerk * ahead_s,
      self._jerk,
      self._yaws_rad + self._turns_rad,
    )
    place, speed = self._qpos[self._places], self._qvel[self._speeds]
    attitude = self._qpos[self._attitudes]
    rotation = self._xmat[self._bodies].reshape(-1, 3, 3)
    self._blow(time_s, rotation)
    tilt_rad = None
    if (errors := self._belief.errors(time_s)) is not None:
      place, speed = place + errors[0], speed + errors[1]
      tilt_rad = errors[2]
    asked = cascade.accelerate(
      wanted, place, speed, self._memory[:, 0], self._period_s
    )
    self._law = cascade.law(
      cascade.force(asked), wanted, attitude, rotation, tilt_rad
    )

  def _blow(self, time_s: float, rotation: np.ndarray) -> None:
    """Lets the air move past vehicles, which are turned by (N, 3, 3)."""
    air_mps = self._air.velocity_mps(time_s, self._qpos[self._places])
    if air_mps is not None:
      self._air_mps = air_mps
      self._ctrl[self._drags] = (air_mps[:, None] @ rotation)[:, 0]
