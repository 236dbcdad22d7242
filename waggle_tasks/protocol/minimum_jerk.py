"""Minimum-jerk motion between two points at rest.

The quintic of Flash and Hogan (1985), doi:10.1523/JNEUROSCI.05-07-01688.1985,
equation 5: position, velocity and acceleration are zero-ended and smooth.
"""

from typing import TypeVar

import numpy as np

_Share = TypeVar('_Share', float, np.ndarray)


def fraction(s: _Share) -> _Share:
  """How far along the way at a share of the time, or at many, 0 to 1."""
  return s**3 * (10 - 15 * s + 6 * s**2)


def progress(elapsed_s: float, duration_s: float) -> tuple[float, float, float]:
  """How far along the way, and its two time derivatives.

  Args:
    elapsed_s: Seconds since the motion began; clamped to [0, duration_s].
    duration_s: Seconds that the motion takes, positive.

  Returns:
    Fraction of the way (0 to 1), its rate in 1/s and its second rate in
    1/s^2.
  """
  s = min(max(elapsed_s / duration_s, 0.0), 1.0)
  rate = 30 * s**2 * (1 - s) ** 2 / duration_s
  second_rate = 60 * s * (1 - s) * (1 - 2 * s) / duration_s**2
  return fraction(s), rate, second_rate


def between(
  begin: np.ndarray,  # (D,)
  end: np.ndarray,  # (D,)
  elapsed_s: float,
  duration_s: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
  """Position, velocity and acceleration on the straight way, each (D,)."""
  fraction, rate, second_rate = progress(elapsed_s, duration_s)
  way = end - begin
  return begin + fraction * way, rate * way, second_rate * way


def to_rest(
  position: np.ndarray,  # (D,)
  velocity: np.ndarray,  # (D,)
  acceleration: np.ndarray,  # (D,)
  elapsed_s: float,
  duration_s: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
  """Brakes from any state to rest, half of `velocity * duration_s` further on.

  The quintic with the given state at the beginning and no velocity and
  acceleration at the end.

  Args:
    position: Where braking begins.
    velocity: Its velocity there, per second.
    acceleration: Its acceleration there, per second squared.
    elapsed_s: Seconds since braking began; clamped to [0, duration_s].
    duration_s: Seconds until rest, positive.

  Returns:
    Position, velocity and acceleration, each (D,).
  """
  t = min(max(elapsed_s, 0.0), duration_s)
  # Coefficients of t^3, t^4, t^5 that meet the three conditions at the end.
  ends = duration_s ** np.array([[3, 4, 5], [2, 3, 4], [1, 2, 3]])
  ends = ends * [[1, 1, 1], [3, 4, 5], [6, 12, 20]]
  known = np.stack(
    [
      -velocity * duration_s / 2 - acceleration * duration_s**2 / 2,
      -velocity - acceleration * duration_s,
      -acceleration,
    ]
  )
  c3, c4, c5 = np.linalg.solve(ends, known)
  return (
    position + velocity * t + acceleration * t**2 / 2
    + c3 * t**3 + c4 * t**4 + c5 * t**5,
    velocity + acceleration * t + 3 * c3 * t**2 + 4 * c4 * t**3
    + 5 * c5 * t**4,
    acceleration + 6 * c3 * t + 12 * c4 * t**2 + 20 * c5 * t**3,
  )  # fmt: skip
