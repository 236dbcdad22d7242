"""The air of an episode: wind, gusts and downwash, as they are drawn."""

import math

import numpy as np

from waggle_tasks.entities import jet, unknown
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import coloured

# MIL-F-8785C, section 3.7.3, low altitude: heights and lengths in feet, from 10
# feet up; lower down they are taken as there.
_FOOT_M = 0.3048
_LOWEST_FEET = 10.0


def draw(
  air: air_lib.Air,
  height_m: float,
  duration_s: float,
  random_state: np.random.RandomState,
) -> unknown.Air:
  """What happens in an episode; nothing is drawn without gusts.

  Args:
    air: What is asked for.
    height_m: Where vehicles hover.
    duration_s: How long the episode lasts at most.
    random_state: Of the episode.
  """
  if air.rests:
    return unknown.Air()
  angle = math.radians(air.wind_deg)
  along = np.array([-math.sin(angle), math.cos(angle), 0.0])
  across = np.array([-along[1], along[0], 0.0])
  winds_mps = air.wind_mps * along[None]
  if air.gusts:
    parts = gusts_mps(air.wind_mps, height_m, duration_s, random_state)
    winds_mps = winds_mps + parts @ np.stack([along, across, [0, 0, 1]])
  return Weather(winds_mps, air.downwash)


class Weather(unknown.Air):
  """Wind that is the same everywhere in the room, and downwash."""

  def __init__(self, winds_mps: np.ndarray, downwash: bool) -> None:
    """Takes the winds (T, 3) of an episode, see `coloured`."""
    self._winds_mps, self._downwash = winds_mps, downwash

  def velocity_mps(self, time_s: float, positions_m: np.ndarray) -> np.ndarray:
    """World velocities (N, 3) of the air where vehicles are."""
    wind_mps = coloured.at(self._winds_mps, time_s)
    wind_mps = np.tile(wind_mps, (len(positions_m), 1))
    if self._downwash:
      wind_mps[:, 2] -= jet.downwash_mps(positions_m)
    return wind_mps


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
