"""Results as JSON, and the version of the form that they have."""

from collections.abc import Mapping
import json
from typing import Any

from waggle_tasks import errors, plain

# Every object that is written says it; what says none is of format 1.
FORMAT = 2


class FormatError(errors.WaggleError):
  """Results of a newer program than this one."""


def dumps(value: object) -> str:
  """One line of JSON; NaN and infinity are refused."""
  return json.dumps(plain.to_plain(value), allow_nan=False)


def pretty(value: object) -> str:
  """A JSON file for people to read."""
  return json.dumps(plain.to_plain(value), indent=2, allow_nan=False) + '\n'


def stamped(value: object) -> dict[str, Any]:
  """A dataclass or a table as plain data, beginning with its format."""
  return {'format': FORMAT, **plain.to_plain(value)}


def unstamped(table: Mapping[str, Any], place: object) -> dict[str, Any]:
  """Plain data without their format; see `check_format`."""
  check_format(table, place)
  return {name: value for name, value in table.items() if name != 'format'}


def check_format(table: Mapping[str, Any], place: object) -> None:
  """Refuses what this program does not know how to read.

  Args:
    table: Plain data; without `format` they are of the oldest.
    place: Where they are from, for people.

  Raises:
    FormatError: naming the formats that it knows.
  """
  found = table.get('format', 1)
  if isinstance(found, bool) or not isinstance(found, int) or found < 1:
    raise FormatError(f'`format` of {place} must be a number: got {found!r}')
  if found > FORMAT:
    raise FormatError(
      f'`format` of {place} must be 1 to {FORMAT} for this program: got'
      f' {found}, which a newer one wrote; update waggle-tasks to read it'
    )
