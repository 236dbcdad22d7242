"""Rows that are exposed one after another, for a while each.

A picture is made of sub-frames: what the eye would see at moments a few
milliseconds apart, by where everything was then. Between two of them light is
taken to change evenly, so that a row's share of each follows from when the row
was exposed. What moves by a straight way is smeared and slanted as it should
be; between two moments it is blended.
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

_STEP_S = 0.008  # Longest from one sub-frame to the next.
_STILL = 1e-6  # What moves by less, in m or parts of a quaternion, rests.

# Draws the scene as it is: the picture, (H, W, 3) uint8, the window around all
# that moves in it, and a number that is another one where the rest was drawn
# anew.
Draw = Callable[[], tuple[np.ndarray, windows.Window, int]]


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
    self._shares = shares(
      -self._ago_s, eye.shutter_s, eye.readout_s, camera.rows
    )
    self._rows, self._takes_s = rows, eye.takes_s
    self._states: deque[_State] = deque()

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
      (H, W, 3) uint8, not to be written to.
    """
    self.note(physics)
    numbers = np.stack([each.numbers for each in self._states])
    if np.abs(numbers - numbers[-1]).max() <= _STILL:
      return draw()[0]
    times_s = np.array([each.time_s for each in self._states])
    now = numbers[-1].copy()
    pictures, around, versions = [], [], set()
    for time_s in times_s[-1] - self._ago_s:
      _put(physics, _between(times_s, numbers, time_s))
      picture, window, version = draw()
      pictures.append(picture.copy())
      around.append(window)
      versions.add(version)
    _put(physics, now)
    height, width = pictures[0].shape[:2]
    whole = 0, 0, width, height
    return self._blended(
      pictures, windows.around_all(around) if len(versions) == 1 else whole
    )

  def _blended(
    self, pictures: list[np.ndarray], window: windows.Window
  ) -> np.ndarray:
    out, part = pictures[-1], windows.slices(window)
    rows = self._rows[part if self._rows.shape[1] > 1 else part[:1]]
    shares_ = self._shares[rows][..., None, :]  # (h, w, 1, K)
    total = np.full(out[part].shape, 0.5, np.float32)  # To round.
    for number, picture in enumerate(pictures):
      total += picture[part] * shares_[..., number]
    out[part] = total
    return out


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
