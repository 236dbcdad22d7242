"""Figures of about the size, the duration and the pauses of gestures."""

from collections.abc import Sequence
import dataclasses
import math

import numpy as np

from waggle_tasks.protocol import flight, minimum_jerk, schedule
from waggle_tasks.protocol.symbols import Symbol

# Figures take about as long as a gesture of the paper, 7.5 s, and with the
# pauses of the paper eight take 60 to 100 s, like its broadcast.
_DURATION_S = (5.0, 9.0)
_FIGURES = 7
_SIZE_M = (0.2, 0.6)
# Under 60 % of what the controller has sideways, 3.57 m/s^2.
_ACCELERATION_MPS2 = 2.0
# Where figures stay: right, up and away from the hover point. Nowhere nearer
# than 0.16 m to an observer at 0.6 m, even one behind the performer.
_LOW_M = np.array([-0.28, -0.3, 0.0])
_HIGH_M = np.array([0.28, 0.5, 0.32])


@dataclasses.dataclass(frozen=True, eq=False)
class Figure:
  """A way from corner to corner, minimum jerk and at rest in each.

  Attributes:
    corners_m: (N, D) offsets from the hover point, D of 2 or 3: right, up and
      away from the audience. Two equal ones in a row are a hold.
    leg_s: Seconds from one corner to the next.
    symbol: UNKNOWN, as it stands for nothing.
  """

  corners_m: np.ndarray
  leg_s: float
  symbol: Symbol = Symbol.UNKNOWN

  @property
  def duration_s(self) -> float:
    """Seconds for the whole way."""
    return self.leg_s * (len(self.corners_m) - 1)

  @property
  def end_m(self) -> np.ndarray:
    """(D,) the last corner."""
    return self.corners_m[-1]

  def motion(
    self, elapsed_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """See `schedule.Path`; each is (D,)."""
    leg = min(int(elapsed_s / self.leg_s), len(self.corners_m) - 2)
    begin_m, end_m = self.corners_m[leg : leg + 2]
    return minimum_jerk.between(
      begin_m, end_m, elapsed_s - leg * self.leg_s, self.leg_s
    )


@dataclasses.dataclass(frozen=True, eq=False)
class Circle:
  """Turns of a circle through the hover point, from rest to rest.

  Attributes:
    middle_m: (2,) its middle: right of and above the hover point.
    turn_rad: How far it goes, positive from right to up: whole turns.
    duration_s: Seconds for all of it.
    symbol: UNKNOWN, as it stands for nothing.
  """

  middle_m: np.ndarray
  turn_rad: float
  duration_s: float
  symbol: Symbol = Symbol.UNKNOWN

  @property
  def end_m(self) -> np.ndarray:
    """(2,) the hover point."""
    return np.zeros(2)

  def motion(
    self, elapsed_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """See `schedule.Path`; each is (2,)."""
    progress = minimum_jerk.progress(elapsed_s, self.duration_s)
    angle, rate, second_rate = self.turn_rad * np.array(progress)
    c, s = math.cos(angle), math.sin(angle)
    begin = -self.middle_m
    out = begin @ np.array([[c, s], [-s, c]])  # From the middle.
    along = begin @ np.array([[-s, c], [-c, -s]])  # Its slope by the angle.
    return (
      self.middle_m + out,
      rate * along,
      second_rate * along - rate**2 * out,
    )


def _circles(rng: np.random.RandomState) -> list[schedule.Path]:
  """Circles beside, above and below the hover point, both ways round."""
  paths: list[schedule.Path] = []
  for _ in range(_FIGURES):
    radius_m = rng.uniform(0.10, 0.15)
    toward_rad = rng.uniform(0, 2 * math.pi)
    middle_m = radius_m * np.array([math.cos(toward_rad), math.sin(toward_rad)])
    turns = rng.choice([-2, -1, 1, 2])
    duration_s = rng.uniform(*_DURATION_S) if abs(turns) == 1 else 9.0
    paths.append(Circle(middle_m, 2 * math.pi * turns, duration_s))
  return paths


def _diagonals(rng: np.random.RandomState) -> list[schedule.Path]:
  """Straight lines out and back; some go on to the other side."""
  paths: list[schedule.Path] = []
  for _ in range(_FIGURES):
    slope_rad = rng.choice([-1, 1]) * math.radians(rng.uniform(25, 65))
    reach_m = rng.choice([-1, 1]) * rng.uniform(0.2, 0.33)
    out = reach_m * np.array([math.cos(slope_rad), math.sin(slope_rad)])
    hover = np.zeros(2)
    ways = ([hover, out, hover], [hover, out, hover, -out, hover])
    paths.append(_timed(ways[rng.randint(2)], rng))
  return paths


def _random_walk(rng: np.random.RandomState) -> list[schedule.Path]:
  """Two to four random corners, and back to the hover point."""
  paths: list[schedule.Path] = []
  for _ in range(_FIGURES):
    corners = [
      rng.uniform(_LOW_M[:2], _HIGH_M[:2]) for _ in range(rng.randint(2, 5))
    ]
    paths.append(_timed([np.zeros(2), *corners, np.zeros(2)], rng))
  return paths


def _navigation(rng: np.random.RandomState) -> list[schedule.Path]:
  """Flights as a navigator makes them, one place after another, and holds."""
  paths: list[schedule.Path] = []
  place = np.zeros(3)
  for _ in range(_FIGURES + 2):
    goal = place
    while not _SIZE_M[0] <= np.linalg.norm(goal - place) <= _SIZE_M[1]:
      goal = rng.uniform(_LOW_M, _HIGH_M)
      goal[1] = place[1] if rng.rand() < 0.7 else goal[1]  # Mostly level.
    hold_s = rng.randint(0, 2) * flight.DURATION_S
    corners = [place, goal] + ([goal] if hold_s else [])
    paths.append(Figure(np.array(corners), flight.DURATION_S))
    place = goal
  return paths


def _timed(corners: Sequence[np.ndarray], rng: np.random.RandomState) -> Figure:
  """A figure that takes about as long as a gesture."""
  leg_s = rng.uniform(*_DURATION_S) / (len(corners) - 1)
  longest_m = np.linalg.norm(np.diff(corners, axis=0), axis=1).max()
  # Minimum jerk accelerates by 5.77 times the length over the time squared
  # (`minimum_jerk.progress`).
  slowest_s = math.sqrt(5.77 * longest_m / _ACCELERATION_MPS2)
  return Figure(np.array(corners), max(leg_s, slowest_s))


MAKERS = {
  'circles': _circles,
  'diagonals': _diagonals,
  'random_walk': _random_walk,
  'navigation': _navigation,
}
