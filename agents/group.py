"""Numbers that belong together, each with its limits, checked when made."""

from collections.abc import Mapping
import dataclasses
import typing
from typing import Any, TypeVar

from waggle_tasks import errors
from waggle_tasks.protocol import checks

_Value = TypeVar('_Value')
_LIMITS = 'limits'
_ANY = 0.0, 1e6  # Of a number that says no more.
_SMALLEST_PX = 5  # A smaller window holds no corner.


class ReceiverError(errors.WaggleError):
  """A receiver, or a number of one, that does not exist or cannot work."""


def number(default: _Value, low: float, high: float) -> _Value:
  """A field of a `Group` with the smallest and the largest value it takes."""
  return dataclasses.field(default=default, metadata={_LIMITS: (low, high)})


@dataclasses.dataclass(frozen=True)
class Group:
  """A frozen dataclass of numbers and switches that checks them when made.

  A number without limits of its own, see `number`, is 0 to a million.
  """

  def __post_init__(self) -> None:
    kinds = kinds_of(type(self))
    for field in dataclasses.fields(self):
      name, value = field.name, getattr(self, field.name)
      if kinds[name] is bool:
        plain: float = checks.switch(name, value, ReceiverError)
      else:
        check: Any = checks.integer if kinds[name] is int else checks.number
        plain = check(name, value, *_limits(field), ReceiverError)
      checks.settle(self, name, plain)


def _limits(field: dataclasses.Field) -> tuple[float, float]:
  return field.metadata.get(_LIMITS, _ANY)


def kinds_of(group: type) -> Mapping[str, Any]:
  """What each field of a dataclass is declared as, by its name."""
  try:
    hints = typing.get_type_hints(group)
  except (NameError, TypeError):  # Of names that are known to a checker alone.
    hints = {}
  return {f.name: hints.get(f.name, f.type) for f in dataclasses.fields(group)}


def check_kinds(config: object) -> None:
  """Refuses parts of a configuration that are none of those declared.

  Raises:
    ReceiverError: naming the part and what it may be.
  """
  for name, kind in kinds_of(config.__class__).items():
    value = getattr(config, name)
    if not isinstance(value, kind):
      kinds = [each.__name__ for each in typing.get_args(kind) or (kind,)]
      words = ' or '.join(kinds).replace('NoneType', 'None')
      raise ReceiverError(f'`{name}` must be a {words}: got {value!r}')


def zoomed(config: _Value, factor: float) -> _Value:
  """The same numbers for a camera of another focal length.

  Everything in pixels, which is told by the unit in its name, grows with the
  focal length, as far as its limits let it; times, shares and scores stay.

  Args:
    config: A configuration or one of its groups.
    factor: The other camera's focal length over this one's, positive.
  """
  whole: Any = config
  changes = {}
  for field in dataclasses.fields(whole):
    value = getattr(config, field.name)
    if dataclasses.is_dataclass(value):
      changes[field.name] = zoomed(value, factor)
    elif field.name.endswith(('_px', '_px_s')):
      kind, (low, high) = type(value), _limits(field)
      least = max(low, min(value, _SMALLEST_PX)) if kind is int else low
      grown = kind(round(value * factor, 9))
      changes[field.name] = min(max(grown, least), high)
  return dataclasses.replace(whole, **changes)
