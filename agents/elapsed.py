"""How long something has lasted."""

import math


def lasted(since_s: float, now_s: float, duration_s: float) -> bool:
  """Whether a duration is over, to a microsecond.

  Times of images are multiples of a frame in floating point: exact comparison
  would be decided by rounding.
  """
  return now_s - since_s > duration_s - 1e-6 and math.isfinite(since_s)
