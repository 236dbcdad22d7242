"""The files that a class, a function or a module comes from."""

from collections.abc import Mapping
import hashlib
import inspect
import pathlib
import sys
import types

from waggle_tasks import errors

_PROJECT = 'waggle_tasks'
_HEAP_TYPE = 1 << 9  # Of a class that Python code made (Py_TPFLAGS_HEAPTYPE).

Code = type | types.FunctionType | types.ModuleType


class UnknownSourceError(errors.WaggleError):
  """Code that decides results and comes from no file."""


def is_known(module: str) -> bool:
  """Whether a module is of this project or of Python."""
  top = module.partition('.')[0]
  return top == _PROJECT or top in sys.stdlib_module_names


def is_own(code: Code) -> bool:
  """Whether the project or Python brings it, or it is no Python code."""
  if isinstance(code, type) and not code.__flags__ & _HEAP_TYPE:
    return True
  # What `exec` makes without a name says that it is built in.
  name = _module(code)
  return name != 'builtins' and is_known(name)


def _module(code: Code) -> str:
  """Where it is written, not what a decorator says about it."""
  match code:
    case types.ModuleType():
      name = code.__name__
    case types.FunctionType():
      name = str(code.__globals__.get('__name__', ''))
    case _:
      name = code.__module__
  return name or 'nowhere'


def of(code: Code) -> dict[str, pathlib.Path]:
  """Its files, by names that do not tell where they lie.

  Raises:
    UnknownSourceError: if it, or a part of it, was made in a prompt or by
      `exec`.
  """
  name = _module(code)
  parts = [each.__code__.co_filename for each in _functions(code)]
  home = getattr(sys.modules.get(name), '__file__', None) or ''
  if name not in sys.modules and parts:  # Loaded from a file by its path.
    home = parts[0]
  for each in (home, *parts):
    if not pathlib.Path(each).is_file():
      raise UnknownSourceError(
        f'{getattr(code, "__qualname__", name)} decides results and must come'
        ' from a file, or they cannot be told from those of another: it is of'
        f' {name}, made in a prompt or by exec; write it into a module and'
        ' import it'
      )
  # A worker knows the program that was started by another name.
  name = '__main__' if name == '__mp_main__' else name
  first = pathlib.Path(home)
  rest = {pathlib.Path(each) for each in parts} - {first}
  return {name: first} | {f'{name}/{path.name}': path for path in rest}


def hashes(files: Mapping[str, pathlib.Path]) -> dict[str, str]:
  """SHA-256 of every file, by its name; of one that is gone, nothing."""
  out = {}
  for name, path in sorted(files.items()):
    try:
      out[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    except FileNotFoundError:
      out[name] = ''
  return out


def _functions(code: Code) -> list[types.FunctionType]:
  """The functions that a class or a function is made of.

  Methods such as __init__ are left out: Python writes some by itself.
  """
  if isinstance(code, types.FunctionType):
    return [code]
  if isinstance(code, types.ModuleType):
    return []
  members = (_bare(each) for each in vars(code).values())
  functions = [
    each
    for member in members
    if isinstance(member, types.FunctionType)
    for each in (member, inspect.unwrap(member))
  ]
  return [
    each
    for each in functions
    if not each.__name__.startswith('__') and not is_own(each)
  ]


def _bare(member: object) -> object:
  """The function in a static method, a class method or a property."""
  for name in ('__func__', 'fget', 'func'):
    member = getattr(member, name, member)
  return member
