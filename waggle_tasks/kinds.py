"""What the declared types of fields take as plain data."""

from collections.abc import Callable, Mapping, Sequence
import enum
import functools
import math
import pathlib
import types
import typing
from typing import Any

import numpy as np

from waggle_tasks.protocol import payload

WORDS = types.NoneType, bool, int, float, str
LISTS = tuple, list, set, frozenset, Sequence
# What is written without a table: its data, and what they are called.
FORMS: Mapping[object, tuple[type | tuple[type, ...], str]] = {
  types.NoneType: (types.NoneType, 'None'),
  bool: (bool, 'True or False'),
  int: (int, 'an integer'),
  float: ((int, float), 'a finite number'),
  str: (str, 'text'),
  payload.Payload: (str, 'bits of a payload'),
  pathlib.Path: (str, 'a path'),
  np.ndarray: (list, 'an array of numbers'),
  **dict.fromkeys(LISTS, ((list, tuple), 'a list')),
}


def takes(kind: Any, plain: object) -> bool:  # noqa: ANN401
  """Whether data have the form of one of `members`."""
  form = form_of(kind)
  if form in FORMS:
    if isinstance(plain, bool):
      return form is bool
    if isinstance(plain, float) and not math.isfinite(plain):
      return False
    return isinstance(plain, FORMS[form][0])
  if (listed := choices(kind)) is not None:
    return plain in listed
  return form in (Any, object) or isinstance(plain, Mapping)


def word(kind: Any) -> str:  # noqa: ANN401
  """What a kind takes, for people."""
  if (listed := choices(kind)) is not None:
    return f'one of {listed}'
  form = form_of(kind)
  if form in FORMS:
    return FORMS[form][1]
  return f'a table of {getattr(form, "__name__", form)}'


@functools.cache
def choices(kind: Any) -> list[Any] | None:  # noqa: ANN401
  """The only data that a kind takes; None where there is no list of them."""
  if is_enum(kind):
    return [each.value for each in kind]
  is_literal = typing.get_origin(kind) is typing.Literal
  return [*typing.get_args(kind)] if is_literal else None


@functools.cache
def form_of(kind: Any) -> Any:  # noqa: ANN401
  """A kind without what it says of its parts."""
  return typing.get_origin(kind) or kind


def is_enum(kind: object) -> bool:
  """Whether a kind is an enumeration."""
  return isinstance(kind, type) and issubclass(kind, enum.Enum)


@functools.cache
def members(kind: Any) -> list[Any]:  # noqa: ANN401
  """The kinds that a value may have by its declaration."""
  is_union = typing.get_origin(kind) in (typing.Union, types.UnionType)
  return [*typing.get_args(kind)] if is_union else [kind]


def classes(kind: Any) -> list[Any]:  # noqa: ANN401
  """The members of a kind that are written as tables."""
  forms = map(form_of, members(kind))
  return [form for form in forms if form not in FORMS]


def inner(
  kind: Any,  # noqa: ANN401
  form: type,
  count: int,
  *,
  strict: bool = False,
) -> list[Any]:
  """What the parts of a value are declared as.

  Args:
    kind: What the whole is.
    form: The type that it has, of those that `kind` allows.
    count: How many parts there are.
    strict: Whether another count of parts is returned as it is declared.
  """
  if kind is Any:
    return [Any] * count
  for each in members(kind):
    origin, args = typing.get_origin(each), [*typing.get_args(each)]
    if isinstance(origin, type) and args and issubclass(form, origin):
      if args[-1] is Ellipsis or (origin is not tuple and len(args) == 1):
        return args[:1] * count
      if len(args) == count or strict:
        return args
  return [Any] * count


@functools.cache
def hints(maker: Callable[..., Any]) -> dict[str, Any]:
  """What fields are declared as, where that can be known."""
  try:
    return typing.get_type_hints(maker)
  except (NameError, TypeError):  # Of names that are known to a checker alone.
    return {}
