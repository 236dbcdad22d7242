"""Values of this project as JSON."""

from collections.abc import Mapping
import dataclasses
import enum
import json
import pathlib
from typing import Any

import numpy as np

from waggle_tasks.protocol import payload


def to_json(value: object) -> Any:  # noqa: ANN401
  """Turns configurations, events and arrays into what JSON can hold."""
  match value:
    case payload.Payload():
      return value.bits
    case enum.Enum():
      return str(value)
    case np.ndarray() | np.generic():
      return value.tolist()
    case Mapping():
      return {str(key): to_json(each) for key, each in value.items()}
    case list() | tuple():
      return [to_json(each) for each in value]
    case None | str() | bool() | int() | float():
      return value
    case set() | frozenset():
      return sorted((to_json(each) for each in value), key=repr)
    case pathlib.PurePath():
      return str(value)
    case bytes():
      return value.hex()
    case type():
      return value.__qualname__
  if dataclasses.is_dataclass(value):
    fields = {
      field.name: to_json(getattr(value, field.name))
      for field in dataclasses.fields(value)
    }
    return fields
  # Of one's own, such as a layout that is a plain class.
  return {
    'type': getattr(value, '__qualname__', type(value).__qualname__),
    **to_json(getattr(value, '__dict__', {})),
  }


def dumps(value: object) -> str:
  """One line of JSON; NaN and infinity are refused."""
  return json.dumps(to_json(value), allow_nan=False)


def pretty(value: object) -> str:
  """A JSON file for people to read."""
  return json.dumps(to_json(value), indent=2, allow_nan=False) + '\n'
