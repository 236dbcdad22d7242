"""A slow way to and fro, as of a vehicle that is carried or does not hold on.

A sine of one period: so its speed is known, and it stays near its place.
"""

import math

import numpy as np

from waggle_tasks.protocol import minimum_jerk

PERIOD_S = 20.0  # Chosen, so that a way is longer than a dance is wide.
_GROWTH_S = 2.0  # It begins at its place, at rest.


def reach(rate: float) -> float:
  """How far from its place a way of a largest rate leads."""
  return rate * PERIOD_S / (2 * math.pi)


class Slide:
  """One vehicle's way in one episode: x, y, z in m and heading in rad."""

  def __init__(
    self,
    speed_mps: float,
    turn_radps: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Draws its direction and where it begins.

    Args:
      speed_mps: Its largest speed.
      turn_radps: The largest rate of its heading.
      random_state: Of the episode.
    """
    way = random_state.normal(size=3)
    way *= reach(speed_mps) / np.linalg.norm(way)
    self._far = np.append(way, reach(turn_radps))
    self._phase = random_state.uniform(0, 2 * math.pi, 4)
    self._phase[:3] = self._phase[0]  # One straight way.

  def at(self, time_s: float) -> np.ndarray:
    """The way, its velocity and its acceleration, (3, 4), at a time."""
    rate = 2 * math.pi / PERIOD_S
    turn = rate * time_s + self._phase
    # Counted from where it begins.
    place = self._far * (np.sin(turn) - np.sin(self._phase))
    first = self._far * np.cos(turn) * rate
    second = -self._far * np.sin(turn) * rate**2
    grown, growth, more = minimum_jerk.progress(time_s, _GROWTH_S)
    return np.array([
      grown * place,
      grown * first + growth * place,
      grown * second + 2 * growth * first + more * place,
    ])  # fmt: skip
