"""A dance in MuJoCo's own viewer, at a pace."""

from collections.abc import Mapping
import time
from typing import Any

from waggle_tasks import errors
from waggle_tasks.experiments.record import episode

_DISPLAYS = 'DISPLAY', 'WAYLAND_DISPLAY'
# Where it looks from, first: the dancer from behind the observers.
_DISTANCE_M, _AZIMUTH_DEG, _ELEVATION_DEG = 4.5, 90.0, -15.0


class DisplayError(errors.WaggleError):
  """No window can be opened."""


class ClosedError(Exception):
  """The window was closed."""


def check_display(environ: Mapping[str, str], platform: str) -> None:
  """Checks that a window may be opened.

  Raises:
    DisplayError: There is no display, by the environment of this process.
  """
  if platform == 'linux' and not any(environ.get(name) for name in _DISPLAYS):
    raise DisplayError(
      f'`waggle view` must have a display: neither {" nor ".join(_DISPLAYS)} is'
      ' set. `waggle broadcast --video` films without one'
    )


class Window:
  """MuJoCo's passive viewer, which follows an episode at a pace."""

  def __init__(self, speed: float, height_m: float) -> None:
    """Makes one that opens with the first step.

    Args:
      speed: Simulated seconds in a second.
      height_m: The height that it looks at first.
    """
    self._speed, self._height_m = speed, height_m
    self._viewer: Any = None  # A handle of `mujoco.viewer`.
    self._begun_s = 0.0

  def __call__(self, step: episode.Step) -> None:
    """Shows the state after a step, not before its time.

    Raises:
      ClosedError: if the window was closed.
    """
    physics = step.environment.physics
    if self._viewer is None:
      self._open(physics.model.ptr, physics.data.ptr)
    if not self._viewer.is_running():
      raise ClosedError
    self._viewer.sync()
    due_s = self._begun_s + physics.time() / self._speed
    time.sleep(max(0.0, due_s - time.monotonic()))

  def _open(self, model: object, data: object) -> None:
    from mujoco import viewer

    self._viewer = viewer.launch_passive(
      model, data, show_left_ui=False, show_right_ui=False
    )
    camera = self._viewer.cam
    camera.lookat[:] = 0.0, 0.0, self._height_m
    camera.distance = _DISTANCE_M
    camera.azimuth, camera.elevation = _AZIMUTH_DEG, _ELEVATION_DEG
    self._begun_s = time.monotonic()

  def close(self) -> None:
    """Closes the window."""
    if self._viewer is not None:
      self._viewer.close()
