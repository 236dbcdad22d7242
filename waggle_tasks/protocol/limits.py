"""What a vehicle can fly, and whether a dance asks for more.

A controller without strength left flies beside the path, and what observers
then see is another gesture. So a dance that asks for more is refused before it
is flown.
"""

from collections.abc import Iterable, Mapping
import dataclasses
import functools
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import gestures, levels
from waggle_tasks.protocol import schedule as schedule_lib

GRAVITY_MPS2 = 9.81
# Along each world axis. Speed and tilt of the stock firmware: 20 degrees of
# tilt give 3.57 m/s^2 sideways. Upwards is what 0.35 N of thrust leave a
# vehicle of 27 g; downwards it can fall.
MAX_SPEED_MPS = 1.0
MAX_SIDEWAYS_MPS2 = 3.57
MAX_UP_MPS2 = 3.15
MAX_DOWN_MPS2 = GRAVITY_MPS2


@dataclasses.dataclass(frozen=True)
class Limits:
  """The most that a vehicle can fly, along each axis.

  Attributes:
    speed_mps: Speed.
    sideways_mps2: Acceleration sideways.
    up_mps2: Acceleration upwards.
    down_mps2: Acceleration downwards.
    sideways_mps3: How fast an acceleration sideways may change.
  """

  speed_mps: float = MAX_SPEED_MPS
  sideways_mps2: float = MAX_SIDEWAYS_MPS2
  up_mps2: float = MAX_UP_MPS2
  down_mps2: float = MAX_DOWN_MPS2
  sideways_mps3: float = math.inf


# Rotors must turn the body before it goes sideways. Within these limits it is
# tilted by less than 20 degrees, and flies paths within 30 mm.
LIMITS: Mapping[str, Limits] = {
  'ideal': Limits(),
  'rotors': Limits(
    sideways_mps2=2.0, down_mps2=MAX_UP_MPS2, sideways_mps3=30.0
  ),
}
DYNAMICS = tuple(LIMITS)
# Of one rotor, as identified on Crazyflies, and of what is asked of all.
THRUST_N = (0.0128, 0.12)
TILT_RAD = math.radians(20.0)
# How far apart two paths may end and begin, and how fast.
_JUMP_M, _REST_MPS = 0.005, 0.025
# The most of minimum jerk over 1 m in 1 s: of its speed, its acceleration and
# the change of that.
_MOST_1, _MOST_2, _MOST_3 = 15 / 8, 10 / math.sqrt(3), 60.0
_SPARE = 1.01  # Of a shortest time.
# Peaks are sought this finely, and in no fewer moments.
_STEP_S, _MOMENTS = 0.01, 400


class LimitError(errors.WaggleError):
  """A dance that the vehicle cannot fly."""


def check_motions(
  motions: Iterable[schedule_lib.Path], limits: Limits = Limits()
) -> None:
  """Refuses motions that the vehicle cannot fly.

  Args:
    motions: What a language is made of.
    limits: What the vehicle can fly.

  Raises:
    LimitError: naming the motion, the rule and what it asks for.
  """
  for path in motions:
    _check_path(f'gesture {path.symbol}', path, limits)


def check_schedule(
  schedule: schedule_lib.Schedule, limits: Limits = Limits()
) -> None:
  """Refuses a dance that the vehicle cannot fly.

  Args:
    schedule: The dance.
    limits: What it can fly.

  Raises:
    LimitError: naming the path, the rule and what it asks for.
  """
  free_s, place_m = 0.0, np.zeros(3)
  for number, slot in enumerate(schedule.slots, 1):
    name = f'path {number} ({slot.gesture.symbol})'
    if not slot.begin_s >= free_s - 1e-6:
      raise LimitError(
        f'`{name}` must begin when the one before is over, at {free_s:g} s:'
        f' got {slot.begin_s:g} s'
      )
    _check_path(name, slot.gesture, limits)
    jump_m = math.dist(place_m, _whole(slot.gesture.motion(0.0)[0]))
    if jump_m > _JUMP_M:
      raise LimitError(
        f'`{name}` must begin where the one before ended: got'
        f' {jump_m:.3f} m from there'
      )
    free_s, place_m = slot.end_s, _whole(slot.gesture.end_m)


def _check_path(name: str, path: schedule_lib.Path, limits: Limits) -> None:
  most = peaks(path)
  if not most.ends_mps <= _REST_MPS:
    raise LimitError(
      f'`{name}` must begin and end at rest: got {most.ends_mps:.2f} m/s there'
    )
  rules = (
    ('accelerate upwards by at most', most.up_mps2, limits.up_mps2, 'm/s^2', 2),
    (
      'accelerate sideways by at most', most.sideways_mps2,
      limits.sideways_mps2, 'm/s^2', 2,
    ),
    (
      'accelerate downwards by at most', most.down_mps2, limits.down_mps2,
      'm/s^2', 2,
    ),
    (
      'fly along an axis at no more than', most.speed_mps, limits.speed_mps,
      'm/s', 1,
    ),
    (
      'change its acceleration sideways by at most', most.sideways_mps3,
      limits.sideways_mps3, 'm/s^3', 3,
    ),
  )  # fmt: skip
  slower = max(
    (asked / limit) ** (1 / power) for _, asked, limit, _, power in rules
  )
  for rule, asked, limit, unit, _ in rules:
    if not asked <= limit:
      raise LimitError(
        f'`{name}` must {rule} {limit:g} {unit}, which the vehicle'
        f' has: got {asked:.2f} {unit} in {path.duration_s:g} s; in'
        f' {path.duration_s * slower + 0.005:.2f} s it can be flown'
      )


def least_s(right_m: float, up_m: float, dynamics: str) -> float:
  """The shortest time for a straight leg of minimum jerk, to 0.01 s.

  A little is left to spare.

  Args:
    right_m: How far it leads sideways.
    up_m: How far it leads up, or down again.
    dynamics: One of `DYNAMICS`.
  """
  most = LIMITS[dynamics]
  times_s = (
    math.sqrt(_MOST_2 * right_m / most.sideways_mps2),
    math.sqrt(_MOST_2 * up_m / min(most.up_mps2, most.down_mps2)),
    math.cbrt(_MOST_3 * right_m / most.sideways_mps3),
    _MOST_1 * max(right_m, up_m) / most.speed_mps,
  )
  return math.ceil(100 * _SPARE * max(times_s)) / 100


@dataclasses.dataclass(frozen=True)
class Peaks:
  """The most that a path asks for, along each axis.

  Attributes:
    speed_mps: Speed.
    sideways_mps2: Acceleration sideways.
    up_mps2: Acceleration upwards.
    down_mps2: Acceleration downwards.
    sideways_mps3: How fast the acceleration sideways changes.
    ends_mps: Speed where it begins and ends.
  """

  speed_mps: float
  sideways_mps2: float
  up_mps2: float
  down_mps2: float
  sideways_mps3: float
  ends_mps: float


def peaks(path: schedule_lib.Path) -> Peaks:
  """The most that a path asks for."""
  if isinstance(path, gestures.Gesture | levels.Stroke):  # To be looked up.
    return _known_peaks(path)
  return _peaks(path)


def _peaks(path: schedule_lib.Path) -> Peaks:
  count = max(_MOMENTS, math.ceil(path.duration_s / _STEP_S))
  times_s = np.linspace(0.0, path.duration_s, count + 1)
  moments = [[*map(_whole, path.motion(time_s))] for time_s in times_s]
  places, rates, seconds = np.moveaxis(np.array(moments), 1, 0)  # (T, 3) each
  # What it says of its speed, and what it does.
  steps = np.abs(np.diff(places, axis=0)).max() / times_s[1]
  return Peaks(
    float(max(np.abs(rates).max(), steps)),
    float(np.abs(seconds[:, ::2]).max()),
    float(seconds[:, 1].max()),
    float(-seconds[:, 1].min()),
    float(np.abs(np.diff(seconds[:, ::2], axis=0)).max() / times_s[1]),
    float(np.abs(rates[[0, -1]]).max()),
  )


_known_peaks = functools.lru_cache(_peaks)


def _whole(vector: np.ndarray) -> np.ndarray:
  """(3,) right, up and away of a (2,) or (3,) vector."""
  whole = np.zeros(3)
  whole[: len(vector)] = vector
  return whole
