"""Checks that configuration values share; each names the field it refuses.

Numbers come from anywhere: numpy's are as good as Python's. Each check returns
the plain Python value, and that is what a configuration keeps, so that it
compares, prints and is written in the same way wherever it came from.
"""

from collections.abc import Callable, Mapping, Sequence
import dataclasses
import math
import numbers
from typing import TypeGuard

import numpy as np

from waggle_tasks import errors


def number(
  field: str,
  value: float,
  minimum: float,
  maximum: float,
  error: type[errors.WaggleError],
) -> float:
  """Refuses a value that is not a finite number in [minimum, maximum].

  Args:
    field: Name of the field, as its user writes it.
    value: The value to check.
    minimum: Smallest value allowed.
    maximum: Largest value allowed.
    error: What to raise.

  Returns:
    The value as a plain number: an int when it is a whole number by its type,
    otherwise a float.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  if not isinstance(value, numbers.Real) or isinstance(value, bool):
    raise error(f'`{field}` must be a finite number: got {value!r}')
  plain = _plain(value)
  if not math.isfinite(plain):
    raise error(f'`{field}` must be a finite number: got {plain!r}')
  if not minimum <= plain <= maximum:
    raise error(
      f'`{field}` must be between {minimum:g} and {maximum:g}: got {plain!r}'
    )
  return plain


def _plain(value: float) -> float:
  """An int or a float; infinite where it is beyond all floats."""
  try:
    nearest = float(value)
  except OverflowError:
    return math.inf if value > 0 else -math.inf
  return int(value) if isinstance(value, numbers.Integral) else nearest


def integer(
  field: str,
  value: int,
  minimum: int,
  maximum: int,
  error: type[errors.WaggleError],
) -> int:
  """Refuses a value that is not an integer in [minimum, maximum].

  Returns:
    The value as a plain int.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  if not isinstance(value, numbers.Integral) or isinstance(value, bool):
    raise error(f'`{field}` must be an integer: got {value!r}')
  plain = int(value)
  if not minimum <= plain <= maximum:
    raise error(
      f'`{field}` must be between {minimum} and {maximum}: got {plain!r}'
    )
  return plain


def whole_choice(
  field: str,
  value: int,
  choices: Sequence[int],
  error: type[errors.WaggleError],
) -> int:
  """Refuses a value that is not one of some integers, and lists them.

  Returns:
    The value as a plain int.

  Raises:
    WaggleError: of type `error`, naming the field, the value and the choices.
  """
  whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
  if not whole or value not in choices:
    raise error(f'`{field}` must be one of {[*choices]}: got {value!r}')
  return int(value)


def is_bits(value: object) -> TypeGuard[str]:
  """Whether a value is text of nothing but the characters 0 and 1."""
  return isinstance(value, str) and not set(value) - {*'01'}


def bits(
  field: str,
  value: str,
  fewest: int,
  most: int | None,
  error: type[errors.WaggleError],
) -> None:
  """Refuses what is not text of so many characters of 0 and 1.

  Args:
    field: Name of the field, as its user writes it.
    value: The value to check.
    fewest: How many there must be at least.
    most: How many there may be at most; None for any number.
    error: What to raise.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  fits = is_bits(value) and fewest <= len(value) <= (most or len(value))
  if not fits:
    number = f'{fewest} or more' if most is None else f'{fewest} to {most}'
    rule = f'{fewest if fewest == most else number} characters of 0 and 1'
    got = f'{len(value)} of them' if is_bits(value) else f'{value!r}'
    raise error(f'`{field}` must be {rule}: got {got}')


def switch(field: str, value: bool, error: type[errors.WaggleError]) -> bool:
  """Refuses a value that is neither True nor False.

  Returns:
    The value as a plain bool.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  if not isinstance(value, (bool, np.bool_)):
    raise error(f'`{field}` must be True or False: got {value!r}')
  return bool(value)


def settle_numbers(
  values: object,
  limits: Mapping[str, tuple[float, float]],
  error: type[errors.WaggleError],
) -> None:
  """Checks fields of a frozen dataclass; plain numbers stay in them.

  A field that is declared as int takes integers only.

  Args:
    values: The dataclass, in its `__post_init__`.
    limits: Smallest and largest value of each field, by its name.
    error: What to raise.

  Raises:
    WaggleError: see `number` and `integer`.
  """
  if not dataclasses.is_dataclass(values):
    raise TypeError(f'`values` must be a dataclass: got {values!r}')
  kinds = {each.name: each.type for each in dataclasses.fields(values)}
  for field, (low, high) in limits.items():
    whole = kinds[field] is int
    check: Callable[..., float] = integer if whole else number
    plain = check(field, getattr(values, field), low, high, error)
    settle(values, field, plain)


def settle(values: object, field: str, value: object) -> None:
  """Puts what a check has returned into a frozen dataclass."""
  object.__setattr__(values, field, value)


def choice(
  field: str,
  value: object,
  choices: Sequence[str],
  error: type[errors.WaggleError],
) -> None:
  """Refuses a value that is not one of the choices, and lists them.

  Raises:
    WaggleError: of type `error`, naming the field, the value and the choices.
  """
  if value not in choices:
    hint = errors.did_you_mean(str(value), choices)
    raise error(
      f'`{field}` must be one of {[*map(str, choices)]}: got {value!r}.{hint}'
    )
