"""What must hold before MuJoCo is imported: versions that fit, a GL backend.

Pure standard library: nothing here imports mujoco or dm_control, so a broken
pair is named in one sentence instead of failing deep inside a simulation.
"""

from collections.abc import Mapping
import importlib
from importlib import metadata
import re
import types

# dm-control 1.0.50 declares mujoco>=3.17 with no upper end, but every Physics
# of it fails on mujoco 4.0, where `MjModel.flex_vertedge` is gone.
MUJOCO_FIRST = (3, 17)
MUJOCO_BEYOND = (4, 0)
MUJOCO_PIN = 'mujoco>=3.17,<4'


class VersionError(ImportError):
  """The installed dm-control and mujoco cannot run together."""


def default_gl(environ: Mapping[str, str], platform: str) -> str | None:
  """Returns the GL backend to set, or None to leave things as they are.

  Left alone, dm_control picks glfw and dies at the first render when there is
  no display; EGL renders there, on a GPU or in software.

  Args:
    environ: The process environment.
    platform: `sys.platform`.
  """
  if platform != 'linux' or 'MUJOCO_GL' in environ:
    return None
  if environ.get('DISPLAY') or environ.get('WAYLAND_DISPLAY'):
    return None
  return 'egl'


def choose_again(modules: Mapping[str, types.ModuleType]) -> None:
  """Lets dm_control choose its GL backend anew, if it has chosen already.

  It chooses when it is imported, which may be before this package.

  Args:
    modules: `sys.modules`, with MUJOCO_GL set in the environment.
  """
  if 'dm_control._render' in modules:
    importlib.reload(modules['dm_control._render'])


def installed(name: str) -> str | None:
  """Returns the installed version of a distribution, None if there is none."""
  try:
    return metadata.version(name)
  except metadata.PackageNotFoundError:
    return None


def version_problem(mujoco: str | None, dm_control: str | None) -> str | None:
  """Returns the one sentence that names and mends a broken pair, else None.

  Args:
    mujoco: Installed version of mujoco, None when unknown.
    dm_control: Installed version of dm-control, None when unknown.
  """
  number = re.match(r'(\d+)\.(\d+)', mujoco or '')
  if number is None:  # Nothing to judge: the import itself will tell.
    return None
  if MUJOCO_FIRST <= (int(number[1]), int(number[2])) < MUJOCO_BEYOND:
    return None
  return (
    f'dm-control {dm_control or "(not installed)"} cannot run on the installed '
    f"mujoco {mujoco}: mend it with `pip install '{MUJOCO_PIN}'`."
  )


def require_versions(mujoco: str | None = None) -> None:
  """Checks the pair of dm-control and mujoco.

  Args:
    mujoco: Version of the mujoco that was imported, which may not be the one
      that was installed; None before it is imported.

  Raises:
    VersionError: dm-control cannot run on the installed mujoco.
  """
  problem = version_problem(
    mujoco or installed('mujoco'), installed('dm-control')
  )
  if problem:
    raise VersionError(problem, name='mujoco')
