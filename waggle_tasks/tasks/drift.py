"""Hover drift: vehicles that are never quite where they want to be.

A drift is a sum of cosines of random phases, so it is smooth, of zero mean and
known at any time, with its velocity and acceleration. Their frequencies lie
evenly in a band, so that it wanders as randomly as the band allows. It is
added to the reference, and the controller flies it.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, minimum_jerk

# Frequencies, times the drift's time: a correlation that is gone after about
# one time, and waves short enough for half a minute to show their rms.
_BAND = (0.3, 1.8)
_WAVES = 10
# A vehicle begins at its place, and its drift grows from nothing.
_GROWTH_S = 2.0


class DriftError(errors.WaggleError):
  """A drift that cannot be flown."""


@dataclasses.dataclass(frozen=True)
class Drift:
  """How far vehicles wander from where they should be.

  Attributes:
    performer_drift_m: Root mean square of the performer's drift along each
      axis, 0 to 0.03 m.
    observer_drift_m: Root mean square of each observer's drift along each axis,
      0 to 0.03 m.
    observer_yaw_drift_deg: Root mean square of each observer's drift in
      heading, 0 to 5 degrees.
    drift_time_s: Time in which a drift becomes another, 0.3 to 10 s; the
      attitude loop of a small vehicle corrects faster, and its position loop
      not much slower, than 1 s.
  """

  performer_drift_m: float = 0.0
  observer_drift_m: float = 0.0
  observer_yaw_drift_deg: float = 0.0
  drift_time_s: float = 1.0

  def __post_init__(self) -> None:
    limits = {
      'performer_drift_m': (0.0, 0.03),
      'observer_drift_m': (0.0, 0.03),
      'observer_yaw_drift_deg': (0.0, 5.0),
      'drift_time_s': (0.3, 10.0),
    }
    checks.settle_numbers(self, limits, DriftError)

  @property
  def near_m(self) -> float:
    """How much nearer it brings two vehicles, all but surely.

    Four times the root mean square for each of them.
    """
    return 4 * (
      self.observer_drift_m + max(self.performer_drift_m, self.observer_drift_m)
    )

  def performer(self, random_state: np.random.RandomState) -> 'Wander':
    """A performer's drift in one episode."""
    return self._wander(self.performer_drift_m, 0.0, random_state)

  def observer(self, random_state: np.random.RandomState) -> 'Wander':
    """An observer's drift in one episode."""
    yaw_rad = math.radians(self.observer_yaw_drift_deg)
    return self._wander(self.observer_drift_m, yaw_rad, random_state)

  def _wander(
    self, rms_m: float, rms_rad: float, random_state: np.random.RandomState
  ) -> 'Wander':
    rms = np.array([rms_m, rms_m, rms_m, rms_rad])
    return Wander(rms, self.drift_time_s, random_state)


class Wander:
  """One vehicle's drift in one episode: x, y, z in m and heading in rad."""

  def __init__(
    self,
    rms: np.ndarray,  # (4,)
    time_s: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Draws the drift; without any nothing is drawn.

    Args:
      rms: Root mean squares of x, y, z and heading.
      time_s: Time in which a drift becomes another.
      random_state: Of the episode.
    """
    self._amplitude = rms[:, None] * math.sqrt(2 / _WAVES)  # (4, 1)
    self._still = not rms.any()
    if self._still:
      return
    share = random_state.uniform(0.25, 0.75, (4, _WAVES))
    low, high = _BAND
    place = (np.arange(_WAVES) + share) / _WAVES  # One in each part, apart.
    self._rate = (low + (high - low) * place) / time_s  # (4, W) rad/s
    self._phase = random_state.uniform(0, 2 * math.pi, (4, _WAVES))

  def at(self, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The drift, its velocity and its acceleration, (4,) each, at a time."""
    if self._still:
      return np.zeros(4), np.zeros(4), np.zeros(4)
    angle = self._rate * time_s + self._phase
    wave = self._amplitude * np.cos(angle)
    slope = -self._amplitude * np.sin(angle)
    place = wave.sum(axis=1)
    rate = (slope * self._rate).sum(axis=1)
    second_rate = -(wave * self._rate**2).sum(axis=1)
    grown, growth, second = minimum_jerk.progress(time_s, _GROWTH_S)
    return (
      grown * place,
      grown * rate + growth * place,
      grown * second_rate + 2 * growth * rate + second * place,
    )
