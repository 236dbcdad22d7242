"""Checks that configuration values share; each names the field it refuses."""

from collections.abc import Sequence
import math

from waggle_tasks import errors


def number(
  field: str,
  value: float,
  minimum: float,
  maximum: float,
  error: type[errors.WaggleError],
) -> None:
  """Refuses a value that is not a finite number in [minimum, maximum].

  Args:
    field: Name of the field, as its user writes it.
    value: The value to check.
    minimum: Smallest value allowed.
    maximum: Largest value allowed.
    error: What to raise.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
  if not is_number or not math.isfinite(value):
    raise error(f'`{field}` must be a finite number: got {value!r}')
  if not minimum <= value <= maximum:
    raise error(
      f'`{field}` must be between {minimum:g} and {maximum:g}: got {value!r}'
    )


def integer(
  field: str,
  value: int,
  minimum: int,
  maximum: int,
  error: type[errors.WaggleError],
) -> None:
  """Refuses a value that is not an integer in [minimum, maximum].

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  if not isinstance(value, int) or isinstance(value, bool):
    raise error(f'`{field}` must be an integer: got {value!r}')
  if not minimum <= value <= maximum:
    raise error(
      f'`{field}` must be between {minimum} and {maximum}: got {value!r}'
    )


def switch(field: str, value: bool, error: type[errors.WaggleError]) -> None:
  """Refuses a value that is neither True nor False.

  Raises:
    WaggleError: of type `error`, naming the field, the rule and the value.
  """
  if not isinstance(value, bool):
    raise error(f'`{field}` must be True or False: got {value!r}')


def choice(
  field: str,
  value: str,
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
