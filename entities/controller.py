"""An ideal six-degree-of-freedom controller that runs inside MuJoCo's step.

Forces and torques act on the centre of mass and feed the true state back
(paper, section 'Per-observer navigation'). Each is a MuJoCo actuator on the
vehicle's site with a law of the form k (c - x) - d x', so that a control step
sets six numbers and no Python runs between two physics steps
(https://mujoco.readthedocs.io/en/stable/XMLreference.html#actuator-general).
"""

import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import crazyflie

# Bandwidths of the critically damped loops; the vehicle's own attitude loop
# was identified at 15.7 rad/s, and position is a third slower here.
_POSITION_RAD_S = 10.0
_ATTITUDE_RAD_S = 25.0
# Menagerie's thrust range; sideways, the force of the stock firmware's 20
# degree tilt limit (3.57 m/s^2).
THRUST_N = (0.0, 0.35)
SIDEWAYS_N = (-0.0964, 0.0964)
_TORQUE_NM = (-5e-3, 5e-3)
_LIFT_MPS2 = np.array([0.0, 0.0, 9.81])

_STIFFNESS_N_M = crazyflie.MASS_KG * _POSITION_RAD_S**2
_DAMPING_NS_M = 2 * crazyflie.MASS_KG * _POSITION_RAD_S
# What the attitude loop is told of an angle and of its two derivatives, so that
# it follows at once.
_LEAD = np.array([1.0, 2 / _ATTITUDE_RAD_S, 1 / _ATTITUDE_RAD_S**2])


class Controller:
  """Flies one vehicle along a reference."""

  def __init__(
    self,
    root: mjcf.RootElement,
    vehicle: crazyflie.Crazyflie,
    yaw_rad: float,
  ) -> None:
    """Adds the vehicle's actuators to the arena's model.

    Args:
      root: The model that the vehicle is attached to.
      vehicle: The attached vehicle.
      yaw_rad: The heading from which turns are counted.
    """
    self._yaw_rad = yaw_rad
    name = vehicle.mjcf_model.model
    self._heading = root.worldbody.add(
      'site', name=f'{name}_heading', group=3, quat=_about_z(yaw_rad)
    )
    world = root.find('site', 'world') or root.worldbody.add(
      'site', name='world', group=3
    )
    self._actuators: list[mjcf.Element] = []
    forces = (SIDEWAYS_N, SIDEWAYS_N, THRUST_N)
    for axis, limits in enumerate(forces):
      self._add(
        root,
        vehicle,
        world,
        f'{name}_force_{"xyz"[axis]}',
        axis,
        _STIFFNESS_N_M,
        _DAMPING_NS_M,
        limits,
      )
    for axis, inertia in enumerate(crazyflie.INERTIA_KG_M2):
      self._add(
        root,
        vehicle,
        self._heading,
        f'{name}_torque_{"xyz"[axis]}',
        axis + 3,
        inertia * _ATTITUDE_RAD_S**2,
        2 * inertia * _ATTITUDE_RAD_S,
        _TORQUE_NM,
      )

  def _add(
    self,
    root: mjcf.RootElement,
    vehicle: crazyflie.Crazyflie,
    frame: mjcf.Element,
    name: str,
    axis: int,
    stiffness: float,
    damping: float,
    limits: tuple[float, float],
  ) -> None:
    gear = np.zeros(6)
    gear[axis] = 1.0
    self._actuators.append(
      root.actuator.add(
        'general',
        name=name,
        site=vehicle.centre,
        refsite=frame,
        gear=gear,
        gainprm=[stiffness],
        biastype='affine',
        biasprm=[0, -stiffness, -damping],
        forcelimited=True,
        forcerange=limits,
      )
    )

  def after_compile(self, physics: mjcf.Physics) -> None:
    """Finds the actuators in a compiled model."""
    self._indices = physics.bind(self._actuators).element_id
    self._frame = physics.bind(self._heading).element_id

  def command(
    self,
    physics: mjcf.Physics,
    position_m: np.ndarray,  # (3,)
    velocity_mps: np.ndarray,  # (3,)
    acceleration_mps2: np.ndarray,  # (3,)
    turn_rad: float = 0.0,
    attitude_rad: np.ndarray | None = None,  # (3, 3)
  ) -> None:
    """Sets the reference for the coming control step.

    The feedforward of velocity, acceleration and weight is folded into the
    position that the actuators pull towards, that of an attitude into theirs.

    Args:
      physics: The compiled model.
      position_m: World position.
      velocity_mps: World velocity.
      acceleration_mps2: World acceleration.
      turn_rad: Heading, counted from the vehicle's own, within pi.
      attitude_rad: Roll, pitch and yaw beside that, a few degrees each, their
        rates and their second rates; without it the body stays level. Either
        all commands of an episode have one, or none.
    """
    force_n = crazyflie.MASS_KG * (acceleration_mps2 + _LIFT_MPS2)
    pull_m = (
      position_m + (_DAMPING_NS_M * velocity_mps + force_n) / _STIFFNESS_N_M
    )
    aim_rad = 0.0, 0.0, turn_rad
    if attitude_rad is not None:
      # Small angles beside a turn are the actuators' own only if they start
      # from there.
      physics.model.site_quat[self._frame] = _about_z(self._yaw_rad + turn_rad)
      physics.model.site_sameframe[self._frame] = 0
      aim_rad = _LEAD @ attitude_rad
    physics.data.ctrl[self._indices] = [*pull_m, *aim_rad]


def _about_z(angle_rad: float) -> tuple[float, float, float, float]:
  """The quaternion of a heading."""
  return math.cos(angle_rad / 2), 0.0, 0.0, math.sin(angle_rad / 2)
