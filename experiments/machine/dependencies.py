"""What the installed package says that it needs, and what is there."""

import importlib
from importlib import metadata
import sys

from packaging import requirements

from waggle_tasks import errors, runtime

DISTRIBUTION = 'waggle-tasks'

# Where a module is not called as its distribution.
_MODULES = {
  'absl-py': 'absl',
  'opencv-python-headless': 'cv2',
  'pyopengl': 'OpenGL',
}
# Each brings the module cv2: the one that pip unpacks last overwrites files of
# the others, and the metadata of all of them stay.
_RIVALS = {
  'opencv-python-headless': (
    'opencv-python', 'opencv-python-headless', 'opencv-contrib-python',
    'opencv-contrib-python-headless',
  ),
}  # fmt: skip
# Importing these may open GL, which may fail or hang: they are asked once they
# were imported.
_OPEN_GL = ('mujoco', 'OpenGL')


class DependencyError(errors.WaggleError):
  """A package that is needed, and is not as it must be."""


def declared() -> list[requirements.Requirement]:
  """Every dependency, without those of extras.

  Raises:
    PackageNotFoundError: if the package is not installed.
  """
  lines = metadata.metadata(DISTRIBUTION).get_all('Requires-Dist', [])
  needs = map(requirements.Requirement, lines)
  return [
    need
    for need in needs
    if need.marker is None or need.marker.evaluate({'extra': ''})
  ]


def module(name: str) -> str:
  """The module of a dependency."""
  return _MODULES.get(name, name.replace('-', '_'))


def providers(name: str) -> dict[str, str]:
  """The versions of all that is installed and brings a dependency's module."""
  found = {n: runtime.installed(n) for n in _RIVALS.get(name, (name,))}
  return {n: version for n, version in found.items() if version is not None}


def version(name: str) -> str | None:
  """The version of what an import of a dependency brings, None if unknown.

  The module is asked: metadata tell what was installed, which something else
  may have overwritten or may hide. They are asked for modules that do not say.

  Args:
    name: The dependency, such as 'numpy'.

  Raises:
    DependencyError: if it cannot be imported.
  """
  said = runtime.installed(name)
  home = module(name)
  if home in _OPEN_GL and home not in sys.modules:
    return said
  try:
    found = importlib.import_module(home)
  except Exception as error:  # A broken one may raise anything.
    line = ' '.join(f'{type(error).__name__}: {error}'.split())
    raise DependencyError(f'{home} cannot be imported: {line}') from None
  if getattr(found, '__file__', None) is None:
    raise DependencyError(f'{home} is a folder that holds no module')
  return getattr(found, '__version__', said)
