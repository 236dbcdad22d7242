"""Whether this machine can render, and the line that mends it when it cannot.

The frame is rendered in a process of its own with a time limit: a broken GL
stack may abort or hang, and must not take the launcher with it.
"""

from collections.abc import Mapping
import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import sys
import traceback

RENDER_ONCE = pathlib.Path(__file__).with_name('render_once.py')
TIMEOUT_S = 60.0
PACKAGES = 'libegl1 libgl1 libgl1-mesa-dri'  # Debian's names.

# Variables that lead the GL stack astray: those its error names, and those
# that point EGL away from the system's own drivers without a word.
_NAMED_VARIABLES = ('PYOPENGL_PLATFORM', 'MUJOCO_EGL_DEVICE_ID')
_DRIVER_VARIABLES = ('__EGL_VENDOR_LIBRARY_FILENAMES', 'LIBGL_DRIVERS_PATH')
# Modules that draw, with all below them.
_DRAWING = (
  'OpenGL', 'glfw', 'dm_control._render', 'mujoco.egl', 'mujoco.glfw',
  'mujoco.osmesa', 'mujoco.rendering',
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Rendering:
  """One frame as it was rendered; `error` is empty when it was."""

  error: str = ''
  backend: str = ''
  renderer: str = ''
  first_s: float = 0.0
  frame_s: float = 0.0


def render_once(
  timeout_s: float = TIMEOUT_S, script: pathlib.Path = RENDER_ONCE
) -> Rendering:
  """Renders one 640x480 frame in a process of its own.

  Args:
    timeout_s: Wall-clock seconds after which the process is ended.
    script: A Python file that prints the fields of a `Rendering` as JSON.
  """
  # -P: the script's own folder must not hide modules of the same names.
  command = [sys.executable, '-P', str(script)]
  try:
    child = subprocess.run(
      command, capture_output=True, text=True, timeout=timeout_s
    )
  except subprocess.TimeoutExpired:
    return Rendering(error=f'no frame within {timeout_s:g} s')
  if child.returncode < 0:
    name = signal.Signals(-child.returncode).name
    return Rendering(error=f'the rendering process was ended by {name}')
  try:
    return Rendering(**json.loads(child.stdout.splitlines()[-1]))
  except (IndexError, TypeError, ValueError):
    said = (child.stderr.strip() or 'nothing').splitlines()[-1]
    return Rendering(error=f'the rendering process said: {said}')


def mend(
  environ: Mapping[str, str], error: str, platform: str = sys.platform
) -> str:
  """Returns the shell line that most likely mends a failed rendering.

  Args:
    environ: The environment that the frame was rendered in.
    error: `Rendering.error`.
    platform: `sys.platform`.
  """
  for name in _NAMED_VARIABLES:
    if name in error:
      return f'unset {name}'
  if platform != 'linux':  # There is no EGL; GLFW draws on the screen.
    named = environ.get('MUJOCO_GL') not in (None, 'glfw')
    return 'unset MUJOCO_GL' if named else 'pip install --force-reinstall glfw'
  if environ.get('MUJOCO_GL') != 'egl':
    return 'export MUJOCO_GL=egl'
  for name in _DRIVER_VARIABLES:
    if name in environ:
      return f'unset {name}'
  return f'apt-get install {PACKAGES}'


def may_cause(error: BaseException) -> bool:
  """Whether an error came from what draws, and so may be the GL stack's.

  A failing GL stack raises anything, but from its own modules, or as they are
  imported.
  """
  frames = traceback.walk_tb(error.__traceback__)
  places = [frame.f_globals.get('__name__', '') for frame, _ in frames]
  if isinstance(error, ImportError):
    places.append(error.name or '')
  return any(
    place == module or place.startswith(f'{module}.')
    for place in places
    for module in _DRAWING
  )


def problem(timeout_s: float = TIMEOUT_S) -> str | None:
  """Returns one line about why nothing renders here, None when it does."""
  error = render_once(timeout_s).error
  if not error:
    return None
  backend = os.environ.get('MUJOCO_GL', '(unset)')
  line = mend(os.environ, error)
  return f'cannot render with MUJOCO_GL={backend} ({error}); mend it: {line}'
