"""Values of this project as plain data, and back: what JSON can hold.

A dataclass becomes a table of its fields, and is made again by what its fields
are declared as; nothing is said here about any one of them. Where the
declaration leaves open which class a value has, as for a layout of one's own,
its table stands under the place of its class: {'package.module:Class': {...}}.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import enum
import functools
import importlib
import inspect
import pathlib
from typing import Any, TypeVar

import numpy as np

from waggle_tasks import errors, kinds
from waggle_tasks.protocol import gestures, payload

_Value = TypeVar('_Value')
# What makes a value of numbers that stand for its fields.
_SHORT: Mapping[object, Callable[..., Any]] = {
  gestures.Codebook: gestures.v_codebook
}


class PlainError(errors.WaggleError):
  """Plain data that make no such value."""


class UnknownFieldError(PlainError):
  """A field that this program does not know."""


def to_plain(value: object) -> Any:  # noqa: ANN401
  """Turns any value into what JSON can hold."""
  return _plain(value, Any)


def _plain(value: Any, kind: Any) -> Any:  # noqa: ANN401
  """The same of a value that is declared as a kind; Any says nothing."""
  match value:
    case payload.Payload():
      return value.text
    case enum.Enum():
      return value.value
    case np.ndarray() | np.generic():
      return value.tolist()
    case None | str() | bool() | int() | float():
      return value
    case Mapping():
      inner = kinds.inner(kind, type(value), 2)[1]
      return {str(name): _plain(each, inner) for name, each in value.items()}
    case list() | tuple():
      inner = kinds.inner(kind, type(value), len(value))
      return [_plain(v, k) for v, k in zip(value, inner, strict=True)]
    case set() | frozenset():
      return sorted((_plain(each, Any) for each in value), key=repr)
    case pathlib.PurePath():
      return str(value)
    case bytes():
      return value.hex()
  if hasattr(value, '__qualname__'):  # A class or a function.
    return _place(value)
  if not dataclasses.is_dataclass(value):  # Of one's own.
    return {_place(type(value)): _plain(getattr(value, '__dict__', {}), Any)}
  made: Any = type(value)
  hints = kinds.hints(made)
  table = {
    field.name: _plain(getattr(value, field.name), hints.get(field.name, Any))
    for field in dataclasses.fields(value)
  }
  said = kinds.classes(kind)
  return table if said in ([Any], [type(value)]) else {
    _place(type(value)): table
  }  # fmt: skip


def from_plain(
  kind: type[_Value],
  plain: object,
  name: str = '',
) -> _Value:
  """Makes a value of plain data: `to_plain` undone.

  Fields that are not there have their defaults.

  Args:
    kind: What it is: a dataclass, or anything that one may hold.
    plain: The data.
    name: What errors call it.

  Returns:
    The value.

  Raises:
    WaggleError: naming the field with its path, the rule and the value.
  """
  return _read(kind, plain, name)


def fields(
  maker: Callable[..., Any], table: Mapping[str, Any], name: str = ''
) -> dict[str, Any]:
  """The values of some fields, made of plain data.

  Args:
    maker: A dataclass, or another function that takes the fields.
    table: The data by the names of fields.
    name: What errors call it.

  Raises:
    WaggleError: see `from_plain`.
  """
  known = [*_parameters(maker)]
  hints, out = kinds.hints(maker), {}
  for field, plain in table.items():
    if field in known:
      out[field] = _read(hints.get(field, Any), plain, _join(name, field))
    elif field not in hints:  # Else the others make it.
      raise UnknownFieldError(
        f'`{_join(name, field)}` must be one of the fields {known}.'
        f'{errors.did_you_mean(str(field), known)}'
      )
  return out


def _read(kind: Any, plain: Any, name: str) -> Any:  # noqa: ANN401
  if kind is Any:
    return plain
  declared = kind
  for kind in kinds.members(declared):
    if kinds.takes(kind, plain):
      break
  else:
    raise _refused(kinds.members(declared), plain, name)
  form = kinds.form_of(kind)
  if form in kinds.WORDS:
    return plain
  if form in kinds.LISTS:
    return _read_list(kind, plain, name)
  if form is np.ndarray:
    return _read_array(plain, name)
  if form is payload.Payload:
    with _named(name):
      return payload.Payload.from_text(plain)
  if form is pathlib.Path or kinds.is_enum(form):
    return form(plain)
  if not isinstance(plain, Mapping) or kind is object:
    return plain
  if isinstance(form, type) and issubclass(form, Mapping):
    inner = kinds.inner(kind, form, 2)[1]
    return {n: _read(inner, v, _join(name, n)) for n, v in plain.items()}
  place = str(next(iter(plain))) if len(plain) == 1 else ''
  if dataclasses.is_dataclass(form) and ':' not in place:
    return _made(form, plain, name)
  found = _found(place, declared, plain, name)
  return _read(found, plain[place], name)


def _refused(several: Sequence[Any], plain: object, name: str) -> PlainError:
  words = ' or '.join(map(kinds.word, several))
  choices = [each for kind in several for each in kinds.choices(kind) or ()]
  hint = errors.did_you_mean(str(plain), [*map(str, choices)])
  said = f'`{name or "value"}` must be {words}: got {plain!r}'
  return PlainError(f'{said}.{hint}' if hint else said)


def _read_list(kind: Any, plain: Sequence[Any], name: str) -> Any:  # noqa: ANN401
  form = kinds.form_of(kind)
  inner = kinds.inner(kind, form, len(plain), strict=True)
  if len(inner) != len(plain):
    raise PlainError(
      f'`{name}` must hold {len(inner)} values: got {len(plain)}'
    )
  made: Any = tuple if form is Sequence else form
  return made(
    _read(one, each, f'{name}[{number}]')
    for number, (one, each) in enumerate(zip(inner, plain, strict=True))
  )


def _read_array(plain: Sequence[Any], name: str) -> np.ndarray:
  with contextlib.suppress(ValueError):  # Of lines that are not alike.
    array = np.array(plain)
    if array.dtype.kind in 'biuf':
      return array
  raise PlainError(f'`{name}` must be an array of numbers: got {plain!r}')


def _made(kind: Any, table: Mapping[str, Any], name: str) -> Any:  # noqa: ANN401
  """A dataclass of the table of its fields."""
  maker = _SHORT.get(kind, kind)
  if table.keys() & {field.name for field in dataclasses.fields(kind)}:
    maker = kind
  values = fields(maker, table, name)
  parameters = _parameters(maker)
  for field, parameter in parameters.items():
    if parameter.default is parameter.empty and field not in values:
      raise PlainError(
        f'`{_join(name, field)}` must be given: there is only {[*table]}'
      )
  with _named(name, [*parameters]):
    return maker(**values)


def _found(
  place: str,
  kind: Any,  # noqa: ANN401
  table: Mapping[str, Any],
  name: str,
) -> type:
  """The dataclass that data name, from anywhere, as far as it is declared."""
  module, _, path = place.partition(':')
  if not module or not path:
    raise PlainError(
      f"`{name}` must be a table {{'package.module:Class': {{...}}}}: got"
      f' {dict(table)}'
    )
  try:
    found: Any = importlib.import_module(module)
    for part in path.split('.'):
      found = getattr(found, part)
  except (Exception, SystemExit) as error:  # It is code of anybody.
    raise PlainError(
      f'`{name}` must be of a class that can be imported: {place}:'
      f' {type(error).__name__}: {error}'
    ) from error
  if not isinstance(found, type) or not dataclasses.is_dataclass(found):
    raise PlainError(
      f'`{name}` must be of a dataclass, else it cannot be made again: got'
      f' {place}'
    )
  closed = kinds.classes(kind)
  is_open = not all(map(dataclasses.is_dataclass, closed))
  if is_open or any(issubclass(found, each) for each in closed):
    return found
  words = ' or '.join(map(kinds.word, closed))
  raise PlainError(f'`{name}` must be {words}: got {place}')


@contextlib.contextmanager
def _named(name: str, fields_: Sequence[str] = ()) -> Iterator[None]:
  """Adds the path to what a value says of its fields when it is made."""
  try:
    yield
  except (TypeError, ValueError) as error:
    text = str(error)
    if not name and isinstance(error, errors.WaggleError):
      raise
    if any(text.startswith(f'`{field}`') for field in fields_):
      raise PlainError(f'`{name}.{text[1:]}') from None
    raise PlainError(f'`{name or "value"}` cannot be made: {text}') from error


@functools.cache
def _parameters(maker: Callable[..., Any]) -> Mapping[str, inspect.Parameter]:
  return inspect.signature(maker).parameters


def _place(made: Any) -> str:  # noqa: ANN401
  """Where a class or a function is: 'package.module:Class'."""
  return f'{made.__module__}:{made.__qualname__}'


def _join(name: str, field: object) -> str:
  return f'{name}.{field}' if name else str(field)
