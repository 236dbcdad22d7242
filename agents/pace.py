"""How fast a place moves, by the line that fits its last ones best."""

from collections import deque
import math

import numpy as np

_Row = tuple[float, ...]  # A time and numbers.


class Pace:
  """Keeps places of a short time."""

  def __init__(self, duration_s: float) -> None:
    """Begins without a place.

    Args:
      duration_s: Over how long speed is measured.
    """
    self._duration_s = duration_s
    self._rows: deque[_Row] = deque()

  def forget(self) -> None:
    """Begins anew: what came before is another way."""
    self._rows.clear()

  def step(self, row: _Row) -> float:
    """Takes a time with a place, and returns the speed, per second."""
    rows = self._rows
    rows.append(row)
    while row[0] - rows[0][0] > self._duration_s - 1e-6:
      rows.popleft()
    if len(rows) < 2:
      return 0.0
    table = np.array(rows)
    table -= table.mean(axis=0)
    slope = table[:, 0] @ table[:, 1:] / (table[:, 0] @ table[:, 0])
    return math.hypot(*slope)
