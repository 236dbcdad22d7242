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
import math
import pathlib
import types
import typing
from typing import Any, TypeVar

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import gestures, payload

_Value = TypeVar('_Value')
# What makes a value of numbers that stand for its fields.
_SHORT: Mapping[object, Callable[..., Any]] = {
  gestures.Codebook: gestures.v_codebook
}
_LISTS = tuple, list, set, frozenset
# Kinds that are written without a table: their data, and that in words.
_FORMS: Mapping[object, tuple[type | tuple[type, ...], str]] = {
  types.NoneType: (types.NoneType, 'None'),
  bool: (bool, 'True or False'),
  int: (int, 'an integer'),
  float: ((int, float), 'a finite number'),
  str: (str, 'text'),
  payload.Payload: (str, 'six bits'),
  pathlib.Path: (str, 'a path'),
  np.ndarray: (list, 'an array of numbers'),
  **dict.fromkeys(_LISTS, ((list, tuple), 'a list')),
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
      return value.bits
    case enum.Enum():
      return value.value
    case np.ndarray() | np.generic():
      return value.tolist()
    case None | str() | bool() | int() | float():
      return value
    case Mapping():
      inner = _inner(kind, Mapping, 2)[1]
      return {str(name): _plain(each, inner) for name, each in value.items()}
    case list() | tuple():
      kinds = _inner(kind, type(value), len(value))
      return [_plain(v, k) for v, k in zip(value, kinds, strict=True)]
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
  hints = _hints(made)
  table = {
    field.name: _plain(getattr(value, field.name), hints.get(field.name, Any))
    for field in dataclasses.fields(value)
  }
  said = [each for each in _members(kind) if each not in _FORMS]
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
  known = [*inspect.signature(maker).parameters]
  hints, out = _hints(maker), {}
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
  if not _takes(kind, plain):
    words = ' or '.join(map(_word, _members(kind)))
    choices = [each for one in _members(kind) for each in _choices(one) or ()]
    hint = errors.did_you_mean(str(plain), [*map(str, choices)])
    raise PlainError(
      f'`{name or "value"}` must be {words}: got {plain!r}.{hint}'.rstrip('.')
    )
  kind = next(each for each in _members(kind) if _takes(each, plain))
  form = typing.get_origin(kind) or kind
  if form in _LISTS:
    return _read_list(kind, plain, name)
  if form is np.ndarray:
    return _read_array(plain, name)
  if form is payload.Payload:
    with _named(name):
      return payload.Payload.from_bits(plain)
  if form is pathlib.Path or _is_enum(form):
    return form(plain)
  if not isinstance(plain, Mapping) or kind in (Any, object):
    return plain
  if isinstance(form, type) and issubclass(form, Mapping):
    inner = _inner(kind, Mapping, 2)[1]
    return {n: _read(inner, v, _join(name, n)) for n, v in plain.items()}
  if dataclasses.is_dataclass(form):
    return _made(form, plain, name)
  return _read_own(plain, name)


def _read_list(kind: Any, plain: Sequence[Any], name: str) -> Any:  # noqa: ANN401
  form = typing.get_origin(kind) or kind
  kinds = _inner(kind, form, len(plain), strict=True)
  if len(kinds) != len(plain):
    raise PlainError(
      f'`{name}` must hold {len(kinds)} values: got {len(plain)}'
    )
  return form(
    _read(inner, each, f'{name}[{number}]')
    for number, (inner, each) in enumerate(zip(kinds, plain, strict=True))
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
  parameters = inspect.signature(maker).parameters
  for field, parameter in parameters.items():
    if parameter.default is parameter.empty and field not in values:
      raise PlainError(
        f'`{_join(name, field)}` must be given: there is only {[*table]}'
      )
  with _named(name, [*parameters]):
    return maker(**values)


def _read_own(table: Mapping[str, Any], name: str) -> Any:  # noqa: ANN401
  """A value of a class that the data name, from anywhere."""
  place = str(next(iter(table))) if len(table) == 1 else ''
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
  except Exception as error:  # It is code of anybody.
    raise PlainError(
      f'`{name}` must be of a class that can be imported: {place}:'
      f' {type(error).__name__}: {error}'
    ) from error
  if not isinstance(found, type) or not dataclasses.is_dataclass(found):
    raise PlainError(
      f'`{name}` must be of a dataclass, else it cannot be made again: got'
      f' {place}'
    )
  return _read(found, table[place], name)


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


def _takes(kind: Any, plain: object) -> bool:  # noqa: ANN401
  """Whether data have the form of a kind."""
  if len(members := _members(kind)) > 1:
    return any(_takes(each, plain) for each in members)
  if (choices := _choices(kind)) is not None:
    return plain in choices
  form = typing.get_origin(kind) or kind
  if form in (Any, object):
    return True
  if form in (int, float) and isinstance(plain, bool):
    return False
  if isinstance(plain, float) and not math.isfinite(plain):
    return False
  return isinstance(plain, _FORMS[form][0] if form in _FORMS else Mapping)


def _word(kind: Any) -> str:  # noqa: ANN401
  """What a kind takes, for people."""
  if (choices := _choices(kind)) is not None:
    return f'one of {choices}'
  form = typing.get_origin(kind) or kind
  if form in _FORMS:
    return _FORMS[form][1]
  return f'a table of {getattr(form, "__name__", form)}'


def _choices(kind: Any) -> list[Any] | None:  # noqa: ANN401
  """The only data that a kind takes; None where there is no list of them."""
  if _is_enum(kind):
    return [each.value for each in kind]
  is_literal = typing.get_origin(kind) is typing.Literal
  return [*typing.get_args(kind)] if is_literal else None


def _is_enum(kind: object) -> bool:
  return isinstance(kind, type) and issubclass(kind, enum.Enum)


def _members(kind: Any) -> list[Any]:  # noqa: ANN401
  """The kinds that a value may have by its declaration."""
  is_union = typing.get_origin(kind) in (typing.Union, types.UnionType)
  return [*typing.get_args(kind)] if is_union else [kind]


def _inner(
  kind: Any,  # noqa: ANN401
  form: type,
  count: int,
  *,
  strict: bool = False,
) -> list[Any]:
  """What the parts of a value are declared as.

  Args:
    kind: What the whole is.
    form: Its type, maybe one of several in `kind`.
    count: How many parts there are.
    strict: Whether another count of parts is returned as it is declared.
  """
  for each in _members(kind):
    origin, args = typing.get_origin(each), [*typing.get_args(each)]
    if isinstance(origin, type) and args and issubclass(origin, form):
      if args[-1] is Ellipsis or (origin is not tuple and len(args) == 1):
        return args[:1] * count
      if len(args) == count or strict:
        return args
  return [Any] * count


@functools.cache
def _hints(maker: Callable[..., Any]) -> dict[str, Any]:
  """What fields are declared as, where that can be known."""
  try:
    return typing.get_type_hints(maker)
  except (NameError, TypeError):  # Of names that are known to a checker alone.
    return {}


def _place(made: Any) -> str:  # noqa: ANN401
  """Where a class or a function is: 'package.module:Class'."""
  return f'{made.__module__}:{made.__qualname__}'


def _join(name: str, field: object) -> str:
  return f'{name}.{field}' if name else str(field)
