"""Changes the numbers of any configuration by words: 'a=0.2,b=off'."""

from collections.abc import Iterator, Mapping
import dataclasses
import math
import types
import typing
from typing import Any

from waggle_tasks import errors
from waggle_tasks.agents import group
from waggle_tasks.protocol import checks

_SWITCHES = {'on': True, 'off': False}
_NUMBERS = (int, float)
_KINDS = (bool, *_NUMBERS, str)


def changed(default: object, changes: str) -> object:
  """A configuration with some of its numbers, switches and words changed.

  Args:
    default: A frozen dataclass, whose fields may be such dataclasses again;
      None where there is nothing to change.
    changes: Such as 'max_rmse=0.2,separators=off'; may be empty.

  Raises:
    ReceiverError: if a name is not known or means two things, a value is not
      of its type, or the configuration refuses it.
  """
  if not changes:
    return default
  homes: dict[str, list[tuple[str, type]]] = {}
  for place, kind in _all(default, ''):
    homes.setdefault(place.rpartition('.')[2], []).append((place, kind))
  values = {}
  for change in changes.split(','):
    name, _, text = change.partition('=')
    checks.choice('receiver number', name, [*homes], group.ReceiverError)
    if len(homes[name]) > 1:
      places = ' and '.join(place for place, _ in homes[name])
      raise group.ReceiverError(
        f'`{name}` must be one number of the receiver: it is {places}'
      )
    values[name] = _read(name, text, homes[name][0][1])
  try:
    return _with(default, values)
  except (TypeError, ValueError) as error:
    if isinstance(error, errors.WaggleError):
      raise
    raise group.ReceiverError(
      f'the receiver must take {changes!r}: {error}'
    ) from None


def switches(default: object) -> list[str]:
  """The names of all switches of a configuration that are on."""
  return [
    place.rpartition('.')[2]
    for place, kind in _all(default, '')
    if kind is bool and _value(default, place)
  ]


def _all(config: object, before: str) -> Iterator[tuple[str, type]]:
  """The place of all that can be changed, and its type."""
  if not dataclasses.is_dataclass(config):
    return
  kinds = group.kinds_of(type(config))
  for field in dataclasses.fields(config):
    part, place = getattr(config, field.name), f'{before}{field.name}'
    if dataclasses.is_dataclass(part):
      yield from _all(part, f'{place}.')
    elif field.init and (kind := _kind(kinds[field.name], part)):
      yield place, kind


def _kind(declared: object, value: object) -> type | None:
  """What is read for a field; None for what cannot be written in a word."""
  choices = [
    each
    for each in typing.get_args(declared) or (declared,)
    if each is not types.NoneType
  ]
  for kind in (*choices, type(value)):
    if kind in _KINDS:
      return kind
  return None


def _value(config: object, place: str) -> object:
  for name in place.split('.'):
    config = getattr(config, name)
  return config


def _with(config: object, values: Mapping[str, object]) -> object:
  whole: Any = config
  changes = {}
  for field in dataclasses.fields(whole):
    part = getattr(config, field.name)
    if dataclasses.is_dataclass(part):
      if (new := _with(part, values)) is not part:
        changes[field.name] = new
    elif field.name in values:
      changes[field.name] = values[field.name]
  return dataclasses.replace(whole, **changes) if changes else config


def _read(name: str, text: str, kind: type) -> object:
  if kind is bool:
    checks.choice(name, text, [*_SWITCHES], group.ReceiverError)
    return _SWITCHES[text]
  try:
    value = kind(text)
  except ValueError:
    raise group.ReceiverError(
      f'`{name}` must be of type {kind.__name__}: got {text!r}'
    ) from None
  if kind is float and not math.isfinite(value):
    raise group.ReceiverError(
      f'`{name}` must be a finite number: got {value!r}'
    )
  return value
