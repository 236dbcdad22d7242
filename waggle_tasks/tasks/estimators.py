"""What vehicles know of themselves: estimates with the errors of real ones.

A vehicle flies where it takes itself to be, and so it wanders by itself, as far
as its estimate does. Presets are such that hover then has the figures below;
logs do not tell how much of it is the estimate and how much the flight.
"""

from collections.abc import Mapping
import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.entities import unknown
from waggle_tasks.protocol import checks, minimum_jerk
from waggle_tasks.tasks import coloured

# A vehicle begins at its place, and its errors grow from nothing.
_GROWTH_S = 2.0
_BIAS_S, _TILT_S, _YAW_S = 20.0, 0.05, 1.0  # Time in which they are forgotten.


class EstimatorError(errors.WaggleError):
  """An estimator that nobody knows."""


@dataclasses.dataclass(frozen=True)
class Errors:
  """Root mean squares of the errors of one kind of estimate.

  Attributes:
    place_m: Of place along each axis: what wanders within seconds.
    speed_mps: How fast that wanders.
    bias_m: Of place too: what wanders within half a minute.
    tilt_rad: Of roll and pitch.
    yaw_rad: Of the heading.
    yaw_drift_rad_s: How fast the heading is lost, where nothing shows it.
  """

  place_m: float
  speed_mps: float
  bias_m: float
  tilt_rad: float
  yaw_rad: float
  yaw_drift_rad_s: float = 0.0

  def draw(
    self,
    vehicles: int,
    duration_s: float,
    random_state: np.random.RandomState,
  ) -> 'Estimates':
    """The errors of so many vehicles in an episode."""
    count, size = coloured.rows(duration_s), 3 * vehicles
    shape = count, vehicles, 3
    place = np.zeros((2, *shape))
    for rms_m, rate_s in (
      (self.place_m, self.speed_mps / self.place_m),
      (self.bias_m, 2 / _BIAS_S),
    ):
      signals = coloured.second_order(rate_s, count, size, random_state)
      place += rms_m * np.reshape(signals, place.shape)
    attitude = np.empty(shape)
    tilts = coloured.first_order(1 / _TILT_S, count, 2 * vehicles, random_state)
    attitude[..., :2] = self.tilt_rad * tilts.reshape(count, vehicles, 2)
    turns, _ = coloured.second_order(1 / _YAW_S, count, vehicles, random_state)
    drifts = self.yaw_drift_rad_s * random_state.standard_normal(vehicles)
    times_s = coloured.STEP_S * np.arange(count)
    attitude[..., 2] = self.yaw_rad * turns + times_s[:, None] * drifts
    return Estimates(place[0], place[1], attitude)


class Estimates(unknown.Belief):
  """The errors of all vehicles in one episode."""

  def __init__(
    self, place_m: np.ndarray, speed_mps: np.ndarray, attitude_rad: np.ndarray
  ) -> None:
    """Takes tables (T, N, 3), see `coloured`."""
    self._place_m, self._speed_mps = place_m, speed_mps
    self._attitude_rad = attitude_rad

  def errors(self, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """See the base class."""
    grown, growth, _ = minimum_jerk.progress(time_s, _GROWTH_S)
    place_m = coloured.at(self._place_m, time_s)
    speed_mps = coloured.at(self._speed_mps, time_s)
    return (
      grown * place_m,
      grown * speed_mps + growth * place_m,
      grown * coloured.at(self._attitude_rad, time_s),
    )


_DEGREE = math.radians(1.0)
# Hover that was measured, rms of place along an axis, speed along it, roll and
# pitch, and yaw. 'mocap': 30 flights before motion-capture cameras, 6.5 mm,
# 12 mm/s, 1.0 and 1.2 degrees. The others: Bitcraze's positioning data set,
# with a Kalman filter: Lighthouse 4.2 to 5.1 mm, 12 to 17 mm/s, 0.5 to 1.0 and
# 0.24 degrees; flow deck 3.3 to 6.8 mm, 14 to 37 mm/s; its heading is that of
# its gyroscope alone, a BMI088, whose noise of 0.014 deg/s/sqrt(Hz) leaves
# 0.01 deg/s after the second for which it is averaged before the start.
PRESETS: Mapping[str, Errors] = {
  'mocap': Errors(0.0090, 0.0080, 0.005, 0.6 * _DEGREE, 1.5 * _DEGREE),
  'lighthouse': Errors(0.0040, 0.012, 0.005, 0.5 * _DEGREE, 0.3 * _DEGREE),
  'flow_deck': Errors(
    0.0045, 0.022, 0.005, 0.5 * _DEGREE, 0.3 * _DEGREE, 0.01 * _DEGREE
  ),
}
ESTIMATORS = ('none', *PRESETS)


def near_m(name: str) -> float:
  """How much nearer errors bring two vehicles, all but surely.

  Four times the root mean square for each of them.

  Args:
    name: One of `ESTIMATORS`.
  """
  if name == 'none':
    return 0.0
  return 8 * math.hypot(PRESETS[name].place_m, PRESETS[name].bias_m)


def draw(
  name: str,
  vehicles: int,
  duration_s: float,
  random_state: np.random.RandomState,
) -> unknown.Belief:
  """What vehicles take themselves to be in an episode; 'none' draws nothing.

  Args:
    name: One of `ESTIMATORS`.
    vehicles: How many there are.
    duration_s: How long the episode lasts at most.
    random_state: Of the episode.

  Raises:
    EstimatorError: if there is none of that name.
  """
  checks.choice('estimator', name, ESTIMATORS, EstimatorError)
  if name == 'none':
    return unknown.Belief()
  return PRESETS[name].draw(vehicles, duration_s, random_state)
