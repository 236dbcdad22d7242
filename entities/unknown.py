"""What vehicles do not know: the air around them, and their own errors."""

import numpy as np


class Air:
  """What the air does; here it rests."""

  def velocity_mps(
    self, time_s: float, positions_m: np.ndarray
  ) -> np.ndarray | None:
    """World velocities (N, 3) of the air at places (N, 3); None at rest."""
    del time_s, positions_m
    return None


class Belief:
  """How far what vehicles know of themselves is from the truth; here never."""

  def errors(
    self, time_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Errors (N, 3) each: of place, m, velocity, m/s, and attitude, rad.

    That of attitude is a turn about the body's axes. None without any.
    """
    del time_s
    return None
