"""What produced a result: versions, renderer, sources and the command."""

from collections.abc import Mapping, Sequence
import dataclasses
import datetime
import functools
import hashlib
import pathlib
import platform
import shlex
import types
from typing import TYPE_CHECKING

import waggle_tasks
from waggle_tasks import agents, arenas, entities, errors, experiments
from waggle_tasks.experiments.machine import dependencies
from waggle_tasks.experiments.record import source_files

if TYPE_CHECKING:
  from dm_control import mjcf


_DECIDING = 'record', 'episodes', 'studies'  # Rooms of `experiments`.


class SourceError(errors.WaggleError):
  """Sources that changed while something ran."""


def source_hashes() -> dict[str, str]:
  """SHA-256 of every source file, by the name that it is imported under.

  So they are the same from a checkout and from what was built of it.
  """
  return {
    name: hashlib.sha256(path.read_bytes()).hexdigest()
    for name, path in source_paths().items()
  }


def source_paths() -> dict[str, pathlib.Path]:
  """Every source file, by the name that it is imported under."""
  out = {}
  for package in (waggle_tasks, agents, arenas, entities, experiments):
    (place,) = package.__path__
    folder = pathlib.Path(place)
    for path in sorted(folder.rglob('*.py')):
      parts = path.relative_to(folder).with_suffix('').parts
      name = '.'.join((package.__name__, *parts)).removesuffix('.__init__')
      out[name] = path
  return out


def deciding_hashes() -> dict[str, str]:
  """Those of `source_hashes` that decide what comes out of an episode.

  Launchers, pages, tables and films do not.
  """
  return {
    name: value for name, value in source_hashes().items() if _decides(name)
  }


def perception_hashes() -> dict[str, str]:
  """Those of `source_hashes` that decide what is seen and read."""
  return {
    name: value
    for name, value in source_hashes().items()
    if not name.startswith(experiments.__name__)
  }


def _decides(name: str) -> bool:
  room = name.removeprefix(f'{experiments.__name__}.').partition('.')[0]
  return not name.startswith(experiments.__name__) or room in _DECIDING


def check_unchanged(
  hashes: Mapping[str, str],
  what: str,
  foreign: Mapping[str, pathlib.Path] = types.MappingProxyType({}),
) -> None:
  """Refuses results when the sources are not those that they began with.

  Args:
    hashes: `deciding_hashes`, and those of `foreign`, as they were.
    what: What ran, for people.
    foreign: What else was used, see `outside.paths`.

  Raises:
    SourceError: if they changed.
  """
  if deciding_hashes() | source_files.hashes(foreign) != hashes:
    raise SourceError(
      f'sources must not change while a {what} runs: run it again, cases of'
      ' other sources are run anew'
    )


def source_digest(hashes: dict[str, str]) -> str:
  """One SHA-256 over `source_hashes`."""
  text = ''.join(f'{name} {value}\n' for name, value in sorted(hashes.items()))
  return hashlib.sha256(text.encode()).hexdigest()


@functools.cache
def versions() -> dict[str, str]:
  """Version of this package, of Python and of every dependency's module."""
  out = {
    'waggle-tasks': waggle_tasks.__version__,
    'python': platform.python_version(),
  }
  for need in dependencies.declared():
    out[need.name] = dependencies.version(need.name) or 'unknown'
  return out


def renderer_name(physics: 'mjcf.Physics') -> str:
  """The GL renderer that draws a simulation, such as 'llvmpipe'."""
  from OpenGL import GL

  # Its context may be current in a thread of its own, and only there.
  with physics.contexts.gl.make_current() as executor:
    name = executor.call(GL.glGetString, GL.GL_RENDERER)
  return name.decode() if name else 'unknown'


def command_line(command: str, argv: Sequence[str]) -> str:
  """The shell line that runs a `waggle` command again."""
  return shlex.join(['waggle', command, *argv])


@dataclasses.dataclass(frozen=True)
class Provenance:
  """Where a result comes from.

  Attributes:
    command: The shell line that reproduces it.
    renderer: The GL renderer.
    versions: See `versions`.
    source_digest: See `source_digest`.
    sources: See `source_hashes`; and code from outside of the project.
    began: When, in UTC.
    ended: When, in UTC.
  """

  command: str
  renderer: str
  versions: dict[str, str]
  source_digest: str
  sources: dict[str, str]
  began: str
  ended: str


@dataclasses.dataclass(frozen=True)
class Start:
  """What is known of a result before the work for it.

  Attributes:
    command: The shell line that reproduces the result.
    sources: See `source_hashes`; and code from outside of the project.
    began: When, in UTC.
  """

  command: str
  sources: dict[str, str]
  began: str

  @classmethod
  def now(
    cls,
    command: str,
    foreign: Mapping[str, pathlib.Path] = types.MappingProxyType({}),
  ) -> 'Start':
    """What is known now.

    Args:
      command: See above.
      foreign: Code from outside that is used, see `outside.paths`.
    """
    sources = source_hashes() | source_files.hashes(foreign)
    return cls(command, sources, _now())

  def end(self, renderer: str) -> Provenance:
    """The provenance of a result that was just made with a GL renderer."""
    return Provenance(
      self.command, renderer, versions(), source_digest(self.sources),
      self.sources, self.began, _now(),
    )  # fmt: skip


def _now() -> str:
  return datetime.datetime.now(datetime.UTC).isoformat(timespec='seconds')
