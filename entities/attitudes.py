"""Attitudes of many vehicles: quaternions from body to world, (N, 4).

A heading is the turn about the body's z axis that remains when the tilt is
undone the shortest way.
"""

import numpy as np

_AXES = (0, 1, 2), (1, 2, 0), (2, 0, 1)


def thrusting(force: np.ndarray, yaw_rad: np.ndarray) -> np.ndarray:
  """Attitudes (N, 4) whose z axes point along forces (N, 3).

  Args:
    force: World axes, above the horizon; any unit.
    yaw_rad: (N,) headings; of those of one attitude, from `heading`, come
      quaternions of its own sign.
  """
  x, y, z = force.T
  length = np.sqrt(x * x + y * y + z * z)
  cosine = np.sqrt((1 + z / length) / 2)  # Of half the tilt.
  aside = 2 * cosine * length
  x, y = -y / aside, x / aside
  half_rad = yaw_rad / 2
  c, s = np.cos(half_rad), np.sin(half_rad)
  out = np.empty((len(force), 4))
  out[:, 0], out[:, 3] = cosine * c, cosine * s
  out[:, 1], out[:, 2] = x * c + y * s, y * c - x * s
  return out


def heading(quaternion: np.ndarray) -> np.ndarray:
  """Headings (N,) of attitudes (N, 4)."""
  return 2 * np.arctan2(quaternion[:, 3], quaternion[:, 0])


def turned(quaternion: np.ndarray, turn_rad: np.ndarray) -> np.ndarray:
  """Attitudes (N, 4) turned by small angles (N, 3) about the body's axes."""
  w, v = quaternion[:, :1], quaternion[:, 1:]
  half = turn_rad / 2
  scalar = w - (v * half).sum(axis=1)[:, None]
  out = np.concatenate([scalar, v + w * half + cross(v, half)], axis=1)
  return out / np.sqrt((out**2).sum(axis=1))[:, None]


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
  """Cross products of rows (N, 3); numpy's own takes three times as long."""
  out = np.empty_like(a)
  for i, j, k in _AXES:
    out[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
  return out


def error(goal: np.ndarray) -> np.ndarray:
  """Matrices (N, 3, 4) that make an error (N, 3) of an attitude.

  Args:
    goal: (N, 4) attitudes.

  Returns:
    What makes the vector of conj(goal) q of a quaternion q: half of the small
    turn, about the body's axes, that leads from the goal to it.
  """
  return (goal @ _VECTOR).reshape(-1, 3, 4)


def _vector() -> np.ndarray:  # (4, 12)
  out = np.zeros((4, 3, 4))
  for i, j, k in _AXES:
    out[0, i, i + 1], out[i + 1, i, 0] = 1, -1
    out[j + 1, i, k + 1], out[k + 1, i, j + 1] = -1, 1
  return out.reshape(4, 12)


_VECTOR = _vector()
