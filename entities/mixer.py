"""Shares thrust and torques among four rotors, within what they can."""

import numpy as np

from waggle_tasks.entities import rotors
from waggle_tasks.protocol import limits

_SHARE = np.linalg.inv(rotors.EFFECT)  # Of thrust and torques, for each rotor.


def mix(demand: np.ndarray) -> np.ndarray:
  """Thrusts (N, 4) in N that give thrusts and torques (N, 4).

  What does not fit is given up in this order: yaw, thrust, roll and pitch.
  """
  out = demand @ _SHARE.T
  low, high = limits.THRUST_N
  if low <= out.min() and out.max() <= high:  # The usual case.
    return out
  level, turning, yawing = (
    demand[:, part] @ _SHARE[:, part].T
    for part in (slice(0, 1), slice(1, 3), slice(3, 4))
  )
  spread = np.ptp(turning, axis=1, keepdims=True)
  turning = turning * np.minimum(1, (high - low) / np.maximum(spread, 1e-9))
  lowest, highest = (
    pick(axis=1, keepdims=True) for pick in (turning.min, turning.max)
  )
  so_far = np.clip(level, low - lowest, high - highest) + turning
  room = np.where(yawing > 0, high - so_far, so_far - low)
  share = (room / np.maximum(np.abs(yawing), 1e-9)).min(axis=1, keepdims=True)
  within = so_far + yawing * np.clip(share, 0, 1)
  fits = ((out >= low) & (out <= high)).all(axis=1, keepdims=True)
  return np.where(fits, out, within)


def lead(
  wanted_n: np.ndarray, thrust_n: np.ndarray, rate_s: float
) -> np.ndarray:
  """Commands (N, 4) that bring thrusts to wanted ones faster than by the lag.

  Args:
    wanted_n: (N, 4) thrusts that are wanted.
    thrust_n: (N, 4) thrusts that rotors have.
    rate_s: How fast they are to come nearer, in 1/s.
  """
  out = thrust_n + rotors.LAG_S * rate_s * (wanted_n - thrust_n)
  low, high = limits.THRUST_N
  return np.minimum(np.maximum(out, low), high)
