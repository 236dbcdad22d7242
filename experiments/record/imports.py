"""What a source file imports: found by reading it, nothing of it is run."""

import ast
from collections.abc import Iterator
import functools
import importlib.machinery
import importlib.util
import pathlib

_CALLS = ('import_module', '__import__')  # With a name that is written there.


def of(module: str, path: pathlib.Path) -> dict[str, pathlib.Path]:
  """The files of what a module imports, packages around them included.

  Args:
    module: Its name, for what it imports relative to itself.
    path: Its file; only Python source is read.

  Returns:
    By module name; those that are built in, or not there, are left out.
  """
  out: dict[str, pathlib.Path] = {}
  for name in named(module, path):
    out |= _found(name)
  return out


def named(module: str, path: pathlib.Path) -> tuple[str, ...]:
  """The modules that a file may mean: `from a import b` may mean a.b.

  Args:
    module: Its name, for what it imports relative to itself.
    path: Its file; only Python source is read.
  """
  if path.suffix != '.py' or not path.exists():
    return ()
  is_package = path.name == '__init__.py'
  package = module if is_package else module.rpartition('.')[0]
  return _names(path.read_bytes(), package)


@functools.lru_cache(maxsize=256)
def _names(source: bytes, package: str) -> tuple[str, ...]:
  try:
    tree = ast.parse(source)
  except (SyntaxError, ValueError):
    return ()
  names = (name for node in ast.walk(tree) for name in _named(node, package))
  return tuple(dict.fromkeys(names))


def _named(node: ast.AST, package: str) -> Iterator[str]:
  match node:
    case ast.Import():
      yield from (alias.name for alias in node.names)
    case ast.ImportFrom():
      base = node.module or ''
      if node.level:
        parents = package.split('.')
        kept = parents[: len(parents) - node.level + 1]
        base = '.'.join([*kept, *filter(None, [base])])
      yield base
      yield from (f'{base}.{alias.name}' for alias in node.names)
    case ast.Call(args=[ast.Constant(value=str(name)), *_]):
      called = getattr(node.func, 'attr', getattr(node.func, 'id', ''))
      if called in _CALLS:
        yield name


def _found(name: str) -> dict[str, pathlib.Path]:
  """The file of a module and of each package around it."""
  out, places = {}, None
  parts = name.split('.')
  for count in range(1, len(parts) + 1):
    whole = '.'.join(parts[:count])
    spec = _spec(whole, places)
    if spec is None:
      break
    if spec.has_location and spec.origin:
      out[whole] = pathlib.Path(spec.origin)
    places = spec.submodule_search_locations
    if places is None:
      break
  return out


def _spec(
  name: str, places: list[str] | None
) -> importlib.machinery.ModuleSpec | None:
  try:
    if places is None:
      return importlib.util.find_spec(name)  # Of the top: imports nothing.
    return importlib.machinery.PathFinder.find_spec(name, places)
  except (ImportError, ValueError):
    return None
