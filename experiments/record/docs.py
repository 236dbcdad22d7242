"""What docstrings say of each field, as sentences for people."""

from collections.abc import Callable
import inspect
import operator
import re
import sys
import types
from typing import Any

_SECTIONS = re.compile(
  r'^(?:Attributes|Args):\n((?:(?: +.*)?\n)*)', re.MULTILINE
)
_FIELD = re.compile(r'^  (\w+): (.*(?:\n    .*)*)', re.MULTILINE)
_CONSTANT = re.compile(r'`((?:\w+\.)*[A-Z][A-Z_]+)`')


def sentences(made: Callable[..., Any]) -> dict[str, str]:
  """What the docstring of a dataclass or a function says of each field.

  A constant that it names, such as `LAYOUTS`, is told by what it holds.

  Args:
    made: The dataclass or the function.

  Returns:
    By the fields' names, one line each; nothing where there is no docstring.
  """
  module = sys.modules[made.__module__]
  return {
    name: _CONSTANT.sub(lambda found: _held(module, found[1]), _line(text))
    for section in _SECTIONS.findall(f'{inspect.getdoc(made) or ""}\n')
    for name, text in _FIELD.findall(section)
  }


def _line(text: str) -> str:
  return ' '.join(text.split())


def _held(module: types.ModuleType, name: str) -> str:
  """What a constant holds, as a list."""
  return ', '.join(map(str, operator.attrgetter(name)(module)))
