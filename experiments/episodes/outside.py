"""Code from outside of this project that decides results, and its sources.

A receiver, a layout, a scenario or a task of one's own is code that neither
the version nor the sources of this project know. Here it is found, with all
that it imports, so that results of another version of it are not taken for
results of this one.

Of installed packages, the list of their files with a hash of each stands for
their sources; Python itself is known by its version. Data that such code reads
by itself, and imports whose names it computes, are not seen.
"""

from collections.abc import Iterable, Iterator, Mapping
import functools
import importlib.metadata
import pathlib
import types

from waggle_tasks import placement, registry, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.record import imports, source_files


def paths(
  receiver_name: str, scenes: Iterable[scenario.Scenario]
) -> dict[str, pathlib.Path]:
  """The files of all code from outside that decides what episodes give.

  Args:
    receiver_name: The receiver, see `receivers.make`.
    scenes: The scenarios.

  Returns:
    Each file by a name that does not tell where it lies.

  Raises:
    ReceiverError: if the receiver is not known.
    UnknownSourceError: if something was made in a prompt, or by `exec`.
  """
  made, config = receivers.configured(receiver_name)
  roots = [made, config, registry.build, registry.environment]
  for scene in scenes:  # All else in one is of this project.
    roots += type(scene), placement.layout(scene), scene.codebook.gestures
  seen: set[int] = set()
  out: dict[str, pathlib.Path] = {}
  for value in roots:
    for code in _reachable(value, seen):
      out |= source_files.of(code)
  waiting = [*out]
  while waiting:
    name = waiting.pop()
    if _is_installed(out[name]):
      out |= _listed(name.partition('.')[0])
      continue
    for other, path in imports.of(name.partition('/')[0], out[name]).items():
      if other not in out and not source_files.is_known(other):
        out[other] = path
        waiting.append(other)
  return out


def modules(files: Mapping[str, pathlib.Path]) -> dict[str, str]:
  """SHA-256 of modules that are found by name and are not installed.

  Args:
    files: See `paths`.
  """
  loose = {
    name: path
    for name, path in files.items()
    if not ('/' in name or name == '__main__' or _is_installed(path))
  }
  return source_files.hashes(loose)


def _reachable(value: object, seen: set[int]) -> Iterator[source_files.Code]:
  """Classes, functions and modules from outside that make up a value."""
  if isinstance(value, (str, bytes, int, float)) or id(value) in seen:
    return
  seen.add(id(value))
  if isinstance(value, (type, types.FunctionType, types.ModuleType)):
    if source_files.is_own(value):
      return
    yield value
  for part in _parts(value):
    yield from _reachable(part, seen)


def _parts(value: object) -> list[object]:
  """What a value is made of."""
  match value:
    case type():
      members = [
        each
        for each in vars(value).values()
        if not isinstance(each, types.FunctionType)  # See `source_files`.
      ]
      return [*value.__mro__[1:], *members]
    case types.ModuleType():
      return []  # Its file says what it imports.
    case types.FunctionType():
      # What wraps a function, or was made by another, holds it in a cell.
      return [*(value.__closure__ or ()), *(value.__defaults__ or ())]
    case types.CellType():
      return [getattr(value, 'cell_contents', None)]
    case functools.partial():
      return [value.func, *value.args, *value.keywords.values()]
    case types.MethodType():
      return [value.__func__, value.__self__]
    case Mapping():
      return [*value.values()]
    case list() | tuple() | set() | frozenset():
      return [type(value), *value]
  slots = getattr(type(value), '__slots__', ())
  held = [getattr(value, name, None) for name in slots if name != '__dict__']
  return [type(value), *held, *getattr(value, '__dict__', {}).values()]


def _is_installed(path: pathlib.Path) -> bool:
  return bool({'site-packages', 'dist-packages'} & {*path.parts})


@functools.cache
def _listed(top: str) -> dict[str, pathlib.Path]:
  """The lists of files, with their hashes, of an installed package."""
  return {
    f'{name}/{each.name}': pathlib.Path(each.locate())
    for name in _packages().get(top, ())
    for each in importlib.metadata.files(name) or ()
    if each.name == 'RECORD'
  }


@functools.cache
def _packages() -> Mapping[str, list[str]]:
  return importlib.metadata.packages_distributions()
