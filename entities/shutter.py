"""Rows that are exposed one after another, for a while each.

A picture is made of sub-frames: what the eye would see at moments a few
milliseconds apart, by where everything was then. Between two of them light is
taken to change evenly, so that a row's share of each follows from when the row
was exposed. What moves by a straight way is smeared and slanted as it should
be; between two moments it is blended. Where the eye itself moves, all of the
picture is drawn anew: then only the first and the last moment are taken.
"""

from collections import deque
from collections.abc import Callable
import dataclasses
import math

from dm_control import mjcf
import mujoco
import numpy as np

from waggle_tasks import eyes
from waggle_tasks.entities import windows
from waggle_tasks.protocol import camera as camera_lib

# Longest from one sub-frame to the next: the fastest vehicle, of 1 m/s, goes a
# sixth of its own width meanwhile.
_STEP_S = 0.016
_STILL = 1e-6  # What moves by less, in m or parts of a quaternion, rests.


@dataclasses.dataclass(frozen=True, eq=False)
class Drawn:
  """The scene as it is.

  Attributes:
    picture: (H, W, 3) uint8, used again by the next one.
    room: (H, W, 3) uint8, the same without what can move.
    window: What of the picture may differ from that.
    version: Another number where the room was drawn anew.
  """

  picture: np.ndarray
  room: np.ndarray
  window: windows.Window
  version: int


Draw = Callable[[], Drawn]


@dataclasses.dataclass(frozen=True, eq=False)
class _State:
  """Where everything was at a time."""

  time_s: float
  numbers: np.ndarray


class Shutter:
  """Notes where everything is, and exposes pictures."""

  def __init__(
    self, eye: eyes.Eye, camera: camera_lib.Camera, rows: np.ndarray
  ) -> None:
    """Prepares the shares.

    Args:
      eye: The camera.
      camera: Its calibration.
      rows: (H, W) or (H, 1) the eye's row of each pixel that is drawn.
    """
    count = math.ceil(eye.takes_s / _STEP_S - 1e-9) + 1
    self._ago_s = np.linspace(eye.takes_s, 0.0, count)  # (K,)
    self._shares, self._ends = (
      shares(moments_s, eye.shutter_s, eye.readout_s, camera.rows)
      for moments_s in (-self._ago_s, -self._ago_s[[0, -1]])
    )
    self._rows, self._takes_s = rows, eye.takes_s
    self._states: deque[_State] = deque()
    # The last picture, and what of it is not its room.
    self._picture = np.empty(0, np.uint8)
    self._changed, self._version = (0, 0, 0, 0), 0

  def begin(self, physics: mjcf.Physics) -> None:
    """Forgets what was before an episode."""
    self._states.clear()
    self.note(physics)

  def note(self, physics: mjcf.Physics) -> None:
    """Notes where everything is, after a physics step."""
    state = _State(float(physics.time()), _numbers(physics))
    while self._states and self._states[-1].time_s >= state.time_s - 1e-9:
      self._states.pop()  # Time was set back.
    self._states.append(state)
    oldest_s = state.time_s - self._takes_s - 1e-9
    while len(self._states) > 1 and self._states[1].time_s <= oldest_s:
      self._states.popleft()

  def expose(self, physics: mjcf.Physics, draw: Draw) -> np.ndarray:
    """The picture whose last row ends now.

    Args:
      physics: The compiled model; it is left as it was.
      draw: Draws it as it is.

    Returns:
      (H, W, 3) uint8, not to be written to, and used again by the next call.
    """
    self.note(physics)
    numbers = np.stack([each.numbers for each in self._states])
    if np.abs(numbers - numbers[-1]).max() <= _STILL:
      return draw().picture
    times_s = np.array([each.time_s for each in self._states])
    now = numbers[-1].copy()
    places = [_between(times_s, numbers, t) for t in times_s[-1] - self._ago_s]
    try:
      return self._blended(physics, places, draw)
    finally:
      _put(physics, now)

  def _blended(
    self, physics: mjcf.Physics, places: list[np.ndarray], draw: Draw
  ) -> np.ndarray:
    first = _at(physics, places[0], draw)
    version, parts = first.version, {0: _part(first)}
    # Where the room was drawn anew, it may be so for each moment.
    kept = first.picture.copy() if version != self._version else None
    for number in (len(places) - 1, *range(1, len(places) - 1)):
      drawn = _at(physics, places[number], draw)
      if drawn.version != version:
        self._version, last = drawn.version, drawn.picture.copy()
        if kept is None:
          kept = _at(physics, places[0], draw).picture.copy()
        return self._whole(kept, last)
      parts[number] = _part(drawn)
    around = windows.around_all(window for window, _ in parts.values())
    left, top, _, _ = around
    behind = drawn.room[windows.slices(around)].astype(np.float32)
    total = behind + np.float32(0.5)  # To round.
    for number, (window, part) in parts.items():
      inside = windows.slices(windows.shifted(window, -left, -top))
      share = self._share(self._shares, number, window)
      total[inside] += share * (part - behind[inside])
    if kept is not None or not self._picture.size:
      self._picture = drawn.room.copy()
    before = windows.slices(self._changed)
    self._picture[before] = drawn.room[before]
    self._picture[windows.slices(around)] = total
    self._version, self._changed = version, around
    return self._picture

  def _whole(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """The picture of an eye that moves, by its first and its last moment."""
    height, width = first.shape[:2]
    share = self._share(self._ends, 0, (0, 0, width, height))
    off = first.astype(np.float32) - last
    return (last + share * off + np.float32(0.5)).astype(np.uint8)

  def _share(
    self, of: np.ndarray, number: int, window: windows.Window
  ) -> np.ndarray:
    """(h, w, 1) or (h, 1, 1), what a window has of a moment."""
    rows, columns = windows.slices(window)
    wide = self._rows.shape[1] > 1
    return of[self._rows[rows, columns if wide else slice(None)], number][
      ..., None
    ]


def _at(physics: mjcf.Physics, place: np.ndarray, draw: Draw) -> Drawn:
  """The scene with everything at a place, see `_put`."""
  _put(physics, place)
  return draw()


def _part(drawn: Drawn) -> tuple[windows.Window, np.ndarray]:
  """What of a picture may differ from its room, a copy."""
  return drawn.window, drawn.picture[windows.slices(drawn.window)].copy()


def shares(
  moments_s: np.ndarray, shutter_s: float, readout_s: float, rows: int
) -> np.ndarray:
  """(rows, K) float32, what each row has of each moment.

  Row r is exposed until readout_s (1 - (r + 1/2) / rows) before the last
  moment, and light changes evenly from moment to moment.

  Args:
    moments_s: (K,) evenly spaced, the last one 0.
    shutter_s: How long a row is exposed.
    readout_s: From the first row to the last one.
    rows: How many there are.
  """
  if len(moments_s) == 1:
    return np.ones((rows, 1), np.float32)
  step_s = moments_s[1] - moments_s[0]
  until_s = -readout_s * (1 - (np.arange(rows) + 0.5) / rows)
  off = (until_s[:, None] - moments_s) / step_s  # (rows, K)
  if not shutter_s:
    return np.maximum(1 - np.abs(off), 0).astype(np.float32)
  before = off - shutter_s / step_s
  return ((_hat(off) - _hat(before)) * step_s / shutter_s).astype(np.float32)


def _hat(off: np.ndarray) -> np.ndarray:
  """Integral of the hat from -1 to 1 up to some places."""
  x = np.clip(off, -1.0, 1.0)
  return np.where(x < 0, (1 + x) ** 2 / 2, 1 - (1 - x) ** 2 / 2)


def _between(
  times_s: np.ndarray, numbers: np.ndarray, time_s: float
) -> np.ndarray:
  """Where everything was at a time: even from one step to the next."""
  after = int(np.searchsorted(times_s, time_s - 1e-9))
  if after == 0:
    return numbers[0]  # The episode had not begun.
  if after == len(times_s):
    return numbers[-1]
  before_s = times_s[after - 1]
  share = (time_s - before_s) / (times_s[after] - before_s)
  return (1 - share) * numbers[after - 1] + share * numbers[after]


def _numbers(physics: mjcf.Physics) -> np.ndarray:
  data = physics.data
  parts = data.qpos, data.mocap_pos.ravel(), data.mocap_quat.ravel()
  return np.concatenate(parts)


def _put(physics: mjcf.Physics, numbers: np.ndarray) -> None:
  """Puts everything where it was; places that follow are those of then."""
  data = physics.data
  own, guided = data.qpos.size, data.mocap_pos.size
  data.qpos[:] = numbers[:own]
  data.mocap_pos[:] = numbers[own : own + guided].reshape(-1, 3)
  data.mocap_quat[:] = numbers[own + guided :].reshape(-1, 4)
  mujoco.mj_kinematics(physics.model.ptr, data.ptr)
  mujoco.mj_camlight(physics.model.ptr, data.ptr)
