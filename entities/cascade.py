"""The laws that fly vehicles with four rotors: position, attitude, mixer.

A cascade: an outer law turns errors of position into the thrust that is wanted,
and so into an attitude; an inner one turns errors of attitude and body rates
into torques; a mixer shares them among the rotors. All vehicles are rows of the
same arrays. The inner law is linear in the quaternion and the rates as long as
the wanted attitude stays, so that it is one product of matrices each time.

Gains. Near hover, and within the limits, a vehicle is a chain of integrators
behind its rotors: thrust, rate, attitude, velocity, position. Its rotors lag by
`rotors.LAG_S`, which alone would leave no room for an attitude loop faster than
a third of 1 / lag. So they are given lead: a command beyond the wanted thrust,
from the thrust that they have by their own model, as the differential part of
the stock firmware's rate loop gives it. The gains then put the six poles of a
horizontal axis, integral included, at `_POLES`; the weaker yaw has `_YAW`.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks.entities import attitudes, crazyflie, mixer, rotors
from waggle_tasks.protocol import limits

# Of each axis: the integral, position, attitude and the rotors with their lead.
_POLES = (-1.2, -6 + 2j, -6 - 2j, -16 + 10j, -16 - 10j, -26.0)
_YAW = (-4.0, -6.0)
_YAW_ERROR_RAD = 0.3  # More is turned step by step: yaw has little torque.
# What the integral makes up for: wind, and thrust that is not as commanded.
# Errors beyond the one limit are those of a reference that jumped; within the
# other they are left, so that who hovers comes to rest.
_INTEGRAL_MPS2, _NEAR_M, _EXACT_M = 3.0, 0.03, 0.0005
# Of all rotors together; each has so much left for torques.
_LEFT_N = 0.01
_TOTAL_N = (
  4 * (limits.THRUST_N[0] + _LEFT_N),
  4 * (limits.THRUST_N[1] - _LEFT_N),
)
_UP = np.array([0.0, 0.0, 1.0])


def _gains(poles: tuple[complex, ...]) -> tuple[float, ...]:
  """Lead in 1/s, and gains: rate, attitude, velocity, position, integral."""
  lead, *rest = np.poly(poles)[1:].real
  rate, attitude = rest[0] / lead, rest[1] / lead
  return lead, rate, attitude, *(each / rest[1] for each in rest[2:])


_LEAD_S, _RATE_S, _ATTITUDE_S2, *_PLACE = _gains(_POLES)
_VELOCITY_S, _POSITION_S2, _INTEGRAL_S3 = _PLACE
_YAW_RATE_S, _YAW_S2 = np.poly(_YAW)[1:].real
_INERTIA = np.array(crazyflie.INERTIA_KG_M2)
_STIFFNESS = 2 * _INERTIA * (_ATTITUDE_S2, _ATTITUDE_S2, _YAW_S2)  # (3,)
_DAMPING = _INERTIA * (_RATE_S, _RATE_S, _YAW_RATE_S)  # (3,)
_GAINS = np.zeros((4, 7))  # But for those of the attitude.
_GAINS[1:, 4:] = np.diag(_DAMPING)
# To go sideways a body must turn first, and so it follows an acceleration as a
# second-order lag: on its way it is behind by so many s^2 of it. It is not
# pulled there, or it would be too far when the acceleration ends. With what the
# laws delay it is flown further behind, which is nothing to be made up for.
# Upwards only its rotors lag, and the outer law by half of its period.
_BEHIND_S2 = np.array([1 / _ATTITUDE_S2, 1 / _ATTITUDE_S2, 0.0])
_FLOWN_S2 = np.array([0.0042, 0.0042, 0.0])
_AHEAD_S = np.array([0.0, 0.0, 1 / _LEAD_S + 0.012])
_DRAG_S = rotors.DRAG_NS_M / crazyflie.MASS_KG


@dataclasses.dataclass(frozen=True, eq=False)
class Wanted:
  """Where N vehicles should be now, by their references.

  Attributes:
    position_m: (N, 3).
    velocity_mps: (N, 3).
    acceleration_mps2: (N, 3).
    jerk_mps3: (N, 3).
    yaw_rad: (N,).
  """

  position_m: np.ndarray
  velocity_mps: np.ndarray
  acceleration_mps2: np.ndarray
  jerk_mps3: np.ndarray
  yaw_rad: np.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class Law:
  """Thrust and torques until the outer law is asked again.

  Attributes:
    constant: (N, 4) thrust in N and torques in N m.
    gains: (N, 4, 7) what the quaternion and the body rates take from them.
  """

  constant: np.ndarray
  gains: np.ndarray

  def command(
    self,
    quaternion: np.ndarray,  # (N, 4)
    rate_rad_s: np.ndarray,  # (N, 3)
    thrust_n: np.ndarray,  # (N, 4)
  ) -> np.ndarray:
    """What rotors (N, 4) are told, in N, for the coming physics step.

    Args:
      quaternion: Attitudes.
      rate_rad_s: Body rates.
      thrust_n: Thrusts that rotors have.
    """
    state = np.concatenate([quaternion, rate_rad_s], axis=1)
    taken = (self.gains @ state[:, :, None])[:, :, 0]
    return mixer.lead(mixer.mix(self.constant - taken), thrust_n, _LEAD_S)


def accelerate(
  wanted: Wanted,
  position_m: np.ndarray,  # (N, 3)
  velocity_mps: np.ndarray,  # (N, 3)
  integral_mps2: np.ndarray,  # (N, 3)
  period_s: float,
) -> np.ndarray:  # (N, 3)
  """The outermost law: the acceleration that leads back to the reference.

  Args:
    wanted: The references.
    position_m: Where vehicles take themselves to be.
    velocity_mps: Their velocities, the same.
    integral_mps2: What errors have added up to; it is brought up to date.
    period_s: Time since it was asked last.

  Returns:
    World m/s^2; drag at the wanted velocity is made up for, as by Faessler and
    others, doi:10.1109/LRA.2017.2776353.
  """
  most_m = _VELOCITY_S / _POSITION_S2 * limits.MAX_SPEED_MPS
  acceleration = wanted.acceleration_mps2
  off_m = wanted.position_m - position_m
  error_m = _within(off_m - _BEHIND_S2 * acceleration, most_m)
  slow_m = _within(off_m - _FLOWN_S2 * acceleration, _NEAR_M)
  slow_m -= _within(slow_m, _EXACT_M)
  rate_mps = wanted.velocity_mps - _BEHIND_S2 * wanted.jerk_mps3 - velocity_mps
  integral_mps2 += _INTEGRAL_S3 * period_s * slow_m
  integral_mps2[:] = _within(integral_mps2, _INTEGRAL_MPS2)
  return (
    acceleration
    + _AHEAD_S * wanted.jerk_mps3
    + _DRAG_S * wanted.velocity_mps
    + _VELOCITY_S * rate_mps
    + _POSITION_S2 * error_m
    + integral_mps2
  )


def force(acceleration_mps2: np.ndarray) -> np.ndarray:
  """Thrust for each kilogram that gives an acceleration, within the limits.

  Args:
    acceleration_mps2: (N, 3) world m/s^2.

  Returns:
    (N, 3) world m/s^2, gravity made up for; tilted by 20 degrees at most.
  """
  out = acceleration_mps2 + limits.GRAVITY_MPS2 * _UP
  low, high = (each / crazyflie.MASS_KG for each in _TOTAL_N)
  up = np.minimum(np.maximum(out[:, 2], low), high * math.cos(limits.TILT_RAD))
  out[:, 2] = up
  aside = np.hypot(out[:, 0], out[:, 1])
  most = math.tan(limits.TILT_RAD) * up
  out[:, :2] *= (most / np.maximum(aside, most))[:, None]
  return out


def law(
  force_mps2: np.ndarray,  # (N, 3)
  wanted: Wanted,
  quaternion: np.ndarray,  # (N, 4)
  rotation: np.ndarray,  # (N, 3, 3)
  error_rad: np.ndarray | None = None,  # (N, 3)
) -> Law:
  """The inner law that turns vehicles towards forces and headings.

  Args:
    force_mps2: Thrust for each kilogram.
    wanted: The references.
    quaternion: The attitudes.
    rotation: The same, from body to world.
    error_rad: How far vehicles take themselves to be turned from there, about
      the body's axes.
  """
  if error_rad is not None:
    quaternion = attitudes.turned(quaternion, error_rad)
  yaw_rad = attitudes.heading(quaternion)
  turn_rad = np.remainder(wanted.yaw_rad - yaw_rad + math.pi, math.tau)
  turn_rad = _within(turn_rad - math.pi, _YAW_ERROR_RAD)
  goal = attitudes.thrusting(force_mps2, yaw_rad + turn_rad)
  if error_rad is not None:  # There, they take themselves to be at the goal.
    goal = attitudes.turned(goal, -error_rad)
  rate = _body_rate(force_mps2, wanted.jerk_mps3, rotation)
  gains = np.empty((len(goal), 4, 7))
  gains[:] = _GAINS
  gains[:, 1:, :4] = _STIFFNESS[:, None] * attitudes.error(goal)
  constant = np.empty((len(goal), 4))
  thrust_n = crazyflie.MASS_KG * (force_mps2 * rotation[:, :, 2]).sum(axis=1)
  constant[:, 0] = np.minimum(np.maximum(thrust_n, _TOTAL_N[0]), _TOTAL_N[1])
  constant[:, 1:] = _DAMPING * rate
  return Law(constant, gains)


def _body_rate(
  force_mps2: np.ndarray, jerk_mps3: np.ndarray, rotation: np.ndarray
) -> np.ndarray:
  """Rates (N, 3) at which a body turns to follow a force that changes."""
  if not jerk_mps3.any():
    return np.zeros_like(jerk_mps3)
  squared = (force_mps2**2).sum(axis=1)[:, None]
  turning = attitudes.cross(force_mps2, jerk_mps3) / squared
  return (turning[:, None] @ rotation)[:, 0]


def _within(values: np.ndarray, most: float) -> np.ndarray:
  """Values from -most to most; numpy's own `clip` takes three times as long."""
  return np.minimum(np.maximum(values, -most), most)
