"""What the air does in an episode: wind, gusts and what vehicles blow down."""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.entities import autopilot, jet
from waggle_tasks.protocol import checks
from waggle_tasks.tasks import coloured

# MIL-F-8785C, section 3.7.3.4, and MIL-HDBK-1797, low altitude: heights and
# lengths in feet, from 10 feet up; lower down they are taken as there.
_FOOT_M = 0.3048
_LOWEST_FEET = 10.0


class AirError(errors.WaggleError):
  """Air that nobody could fly in, or that would do nothing."""


@dataclasses.dataclass(frozen=True)
class Air:
  """Wind and downwash; by default the air rests.

  Attributes:
    wind_mps: Speed of the mean wind, 0 to 4 m/s.
    wind_deg: Where it blows to, -180 to 180 degrees, as the heading of a
      message: at 0 away from the front observer (+y), at 90 to its left (-x).
    gusts: Whether it gusts, as by the Dryden spectra of MIL-F-8785C near the
      ground: by a fifth of the wind along and across it, a tenth upwards.
    downwash: Whether vehicles are in the jets of those above them.
  """

  wind_mps: float = 0.0
  wind_deg: float = 0.0
  gusts: bool = False
  downwash: bool = False

  def __post_init__(self) -> None:
    limits = {'wind_mps': (0.0, 4.0), 'wind_deg': (-180.0, 180.0)}
    checks.settle_numbers(self, limits, AirError)
    for field in ('gusts', 'downwash'):
      checks.settle(
        self, field, checks.switch(field, getattr(self, field), AirError)
      )
    if self.gusts and not self.wind_mps:
      raise AirError(
        '`gusts` must be False without wind: they are a part of it'
      )

  @property
  def rests(self) -> bool:
    """Whether it does nothing."""
    return not (self.wind_mps or self.downwash)

  def weather(
    self,
    height_m: float,
    duration_s: float,
    random_state: np.random.RandomState,
  ) -> autopilot.Air:
    """What happens in an episode; nothing is drawn without gusts.

    Args:
      height_m: Where vehicles hover.
      duration_s: How long it lasts at most.
      random_state: Of the episode.
    """
    if self.rests:
      return autopilot.Air()
    angle = math.radians(self.wind_deg)
    along = np.array([-math.sin(angle), math.cos(angle), 0.0])
    across = np.array([-along[1], along[0], 0.0])
    winds_mps = self.wind_mps * along[None]
    if self.gusts:
      parts = gusts_mps(self.wind_mps, height_m, duration_s, random_state)
      winds_mps = winds_mps + parts @ np.stack([along, across, [0, 0, 1]])
    return Weather(winds_mps, self.downwash)


class Weather(autopilot.Air):
  """Wind that is the same everywhere in the room, and downwash."""

  def __init__(self, winds_mps: np.ndarray, downwash: bool) -> None:
    """Takes the winds (T, 3) of an episode, see `coloured`."""
    self._winds_mps, self._downwash = winds_mps, downwash

  def velocity_mps(self, time_s: float, positions_m: np.ndarray) -> np.ndarray:
    """World velocities (N, 3) of the air where vehicles are."""
    wind_mps = np.tile(self.wind_mps(time_s), (len(positions_m), 1))
    if self._downwash:
      wind_mps[:, 2] -= jet.downwash_mps(positions_m)
    return wind_mps

  def wind_mps(self, time_s: float) -> np.ndarray:
    """(3,) the wind alone."""
    return coloured.at(self._winds_mps, time_s)


def gusts_mps(
  wind_mps: float,
  height_m: float,
  duration_s: float,
  random_state: np.random.RandomState,
) -> np.ndarray:  # (T, 3)
  """Dryden gusts along the wind, across it and up.

  Gusts are carried past by the wind itself, and are longer than the room is
  wide: all vehicles feel the same ones.

  Args:
    wind_mps: The mean wind, taken as that at 20 feet.
    height_m: Above the ground.
    duration_s: How long they last.
    random_state: What they are drawn from.
  """
  feet = max(height_m / _FOOT_M, _LOWEST_FEET)
  ground = 0.177 + 0.000823 * feet
  rms_up_mps = 0.1 * wind_mps
  rms_mps = rms_up_mps / ground**0.4
  length_m, length_up_m = feet / ground**1.2 * _FOOT_M, feet * _FOOT_M
  count = coloured.rows(duration_s)
  along = coloured.first_order(wind_mps / length_m, count, 1, random_state)
  sides = []
  for scale_m in (length_m, length_up_m):
    rate_s = wind_mps / scale_m
    value, slope = coloured.second_order(rate_s, count, 1, random_state)
    # (1 + sqrt(3) L s / V) / (1 + L s / V)^2 of white noise.
    sides.append((value + math.sqrt(3) / rate_s * slope) / 2)
  return np.hstack([along, *sides]) * (rms_mps, rms_mps, rms_up_mps)
