"""A vehicle that can dance a schedule of symbols by itself."""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.entities import crazyflie
from waggle_tasks.protocol import limits, minimum_jerk
from waggle_tasks.protocol import schedule as schedule_lib

BRAKE_S = 0.8  # To rest from anywhere in a gesture; under 2 m/s^2.


class Performer(crazyflie.Crazyflie):
  """Flies gestures in its frontal plane, smoothly, until it is stopped."""

  def _build(  # type: ignore[override]
    self,
    name: str = 'performer',
    dynamics: str = 'ideal',
    accent_rgba: Sequence[float] = crazyflie.AMBER,
  ) -> None:
    """Builds the model.

    Args:
      name: Model name, the prefix of everything inside it.
      dynamics: One of `limits.DYNAMICS`.
      accent_rgba: See `crazyflie.Crazyflie`.
    """
    super()._build(name, accent_rgba, dynamics == 'rotors')
    self._limits = limits.LIMITS[dynamics]
    self._schedule = schedule_lib.Schedule(())
    self._stop_s = math.inf

  @property
  def schedule(self) -> schedule_lib.Schedule:
    """What is being danced."""
    return self._schedule

  def perform(self, schedule: schedule_lib.Schedule) -> None:
    """Takes a new schedule, from simulation time zero.

    Raises:
      limits.LimitError: if it cannot be flown.
    """
    limits.check_schedule(schedule, self._limits)
    self._schedule = schedule
    self._stop_s = math.inf

  def stop(self, time_s: float) -> None:
    """Ends the dance at a simulation time; hovering where it comes to rest."""
    self._stop_s = min(self._stop_s, time_s)

  @property
  def end_s(self) -> float:
    """When the dance ends, by itself or stopped."""
    return min(self._schedule.end_s, self._stop_s)

  @property
  def is_whole(self) -> bool:
    """Whether there is a dance and nothing cuts it short."""
    return 0 < self._schedule.end_s <= self._stop_s

  def motion(
    self, home_m: np.ndarray, yaw_rad: float, time_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The reference at a time.

    Args:
      home_m: (3,) the hover point in world metres.
      yaw_rad: The performer's heading: it faces its audience, so that their
        right is its left.
      time_s: Simulation time in seconds.

    Returns:
      World position in m, velocity in m/s, acceleration in m/s^2, each (3,).
    """
    offset, velocity, acceleration = self._schedule.motion(
      min(time_s, self._stop_s)
    )
    if time_s > self._stop_s:
      offset, velocity, acceleration = minimum_jerk.to_rest(
        offset, velocity, acceleration, time_s - self._stop_s, BRAKE_S
      )
    axes = schedule_lib.axes(yaw_rad)[: len(offset)]  # (D, 3)
    return home_m + offset @ axes, velocity @ axes, acceleration @ axes
