"""The checks of `waggle doctor`: versions, rendering, disk."""

from collections.abc import Iterator
import dataclasses
from importlib import metadata
import os
import pathlib
import platform
import shutil
import sys

from packaging import requirements, specifiers
from packaging import version as version_lib

from waggle_tasks.experiments.machine import dependencies, gl

# Three observers' images of a broadcast, recorded without loss, are 0.3 GB:
# 42 KB a frame, 25 frames a second, 97 s. One GB leaves room for a few.
FREE_GB = 1.0


@dataclasses.dataclass(frozen=True)
class Check:
  """What one check found; `mend` is the line that mends it, empty when ok."""

  found: str
  mend: str = ''

  def __str__(self) -> str:
    if not self.mend:
      return f'ok    {self.found}'
    return f'FAIL  {self.found}\n      mend it: {self.mend}'


def check_python(version: str, pin: str) -> Check:
  """Checks the interpreter's version against `Requires-Python`."""
  found = f'python {version} (needs {pin})'
  if specifiers.SpecifierSet(pin).contains(version):
    return Check(found)
  return Check(found, 'make the virtual environment with another python')


def check_requirement(line: str, version: str | None) -> Check:
  """Checks an installed version against one line of requirements.

  Args:
    line: A requirement, such as `mujoco<4,>=3.17`.
    version: What is installed, None when nothing is.
  """
  need = requirements.Requirement(line)
  found = f'{need.name} {version or "is not installed"}'
  if need.specifier:
    found += f' (needs {need.specifier})'
  try:
    if version and need.specifier.contains(version, prereleases=True):
      return Check(found)
  except version_lib.InvalidVersion:
    pass  # A build of one's own, which nothing can be said about.
  return Check(found, f"pip install '{need.name}{need.specifier}'")


def check_dependency(need: requirements.Requirement) -> Check:
  """Checks what is installed for a dependency, and what its import brings."""
  module = dependencies.module(need.name)
  there = dependencies.providers(need.name)
  install = f"pip install '{need.name}{need.specifier}'"
  anew = f'pip uninstall -y {" ".join(there)} && {install}'
  if len(there) > 1:
    names = ' and '.join(f'{name} {version}' for name, version in there.items())
    return Check(f'{names} overwrite each other: both bring {module}', anew)
  for name, version in there.items():
    check = check_requirement(f'{name}{need.specifier}', version)
    if check.mend:
      return Check(check.found, install if name == need.name else anew)
  try:
    brought = dependencies.version(need.name)
  except dependencies.DependencyError as error:
    if there:
      return Check(f'{need.name}: {error}', anew)
    brought = None
  check = check_requirement(str(need), brought)
  if check.mend and there:
    place = sys.modules[module].__file__
    return Check(f'{check.found}, imported from {place}', anew)
  return check


def check_versions() -> Iterator[Check]:
  """Checks python and every dependency that the installed package declares."""
  try:
    declared = metadata.metadata(dependencies.DISTRIBUTION)
  except metadata.PackageNotFoundError:
    yield Check(
      f'{dependencies.DISTRIBUTION} is not installed', 'pip install -e .'
    )
    return
  yield Check(f'{dependencies.DISTRIBUTION} {declared["Version"]}')
  yield check_python(platform.python_version(), declared['Requires-Python'])
  for need in dependencies.declared():
    yield check_dependency(need)


def require() -> None:
  """Refuses to begin with other versions than those that are needed.

  Raises:
    DependencyError: naming the first that is not as it must be.
  """
  for check in check_versions():
    if check.mend:
      raise dependencies.DependencyError(
        f'{check.found}; mend it: {check.mend}'
      )


def check_rendering(timeout_s: float, versions_ok: bool) -> Iterator[Check]:
  """Checks the GL stack by the one frame that it renders.

  Args:
    timeout_s: Seconds to wait for the frame.
    versions_ok: Whether a failure can be blamed on the GL stack.
  """
  name = os.environ.get('MUJOCO_GL')
  setting = 'MUJOCO_GL is not set' if name is None else f'MUJOCO_GL={name}'
  result = gl.render_once(timeout_s)
  if result.error:
    mend = gl.mend(os.environ, result.error)
    yield Check(
      f'rendering, {setting}: {result.error}',
      mend if versions_ok else 'mend the versions above, then look again',
    )
    return
  yield Check(f'GL backend {result.backend} ({setting})')
  yield Check(f'GL renderer {result.renderer}')
  yield Check(
    f'a 640x480 frame in {1000 * result.frame_s:.0f} ms, '
    f'the first in {1000 * result.first_s:.0f} ms'
  )


def check_disk(folder: pathlib.Path) -> Check:
  """Checks that a folder, or where it would be made, has room for runs."""
  place = folder.absolute()
  while not os.path.exists(place):
    place = place.parent
  free_gb = shutil.disk_usage(place).free / 1e9
  found = f'{free_gb:.1f} GB free in {place}'
  if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
    return Check(
      f'{place} cannot be written to', 'choose another folder with --output'
    )
  if free_gb < FREE_GB:
    return Check(
      f'{found} (needs {FREE_GB:g})',
      'free some room, or choose another folder with --output',
    )
  return Check(found)


def checks(timeout_s: float, output: pathlib.Path) -> Iterator[Check]:
  """Makes the checks one after another.

  Args:
    timeout_s: Seconds to wait for the rendered frame.
    output: Folder that runs will be written under; it need not exist.
  """
  versions_ok = True
  for check in check_versions():
    versions_ok = versions_ok and not check.mend
    yield check
  yield from check_rendering(timeout_s, versions_ok)
  yield check_disk(output)
