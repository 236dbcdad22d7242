"""Flags for every choice of a scenario, and the scenario that they make."""

from collections.abc import Container
import re
from typing import Any

from absl import flags

from waggle_tasks import scenario
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import packets

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()


def define(kind: type = scenario.Scenario) -> None:
  """Defines the flags for the launcher that calls this.

  Args:
    kind: Whose fields they are.
  """
  known = scenario_fields.table(kind)
  for name, field in known.items():
    default, text = field.default, _help(field.text, known) or name
    match default:
      case bool():
        flags.DEFINE_boolean(name, default, text)
      case str():
        flags.DEFINE_string(name, default, text)
      case int():
        flags.DEFINE_integer(name, default, text)
      case _:
        flags.DEFINE_float(name, default, text)
  flags.DEFINE_string(
    'text', None, 'A text that is sent in UTF-8, in place of --bits.'
  )


def _help(text: str, known: Container[str]) -> str:
  """A sentence about a field as one about its flag."""

  def word(found: re.Match) -> str:
    return f'--{found[1]}' if found[1] in known else found[1]

  return re.sub('`(.+?)`', word, text)


def read(
  usual: scenario.Scenario = scenario.Scenario(),
) -> scenario.Scenario:
  """A scenario, changed by the flags that were given.

  Raises:
    WaggleError: if a value breaks a rule of the scenario.
  """
  return scenario_fields.changed(usual, given())


def given() -> dict[str, Any]:
  """What the flags that were given say."""
  said = {n: v for n, v in values().items() if flags.FLAGS[n].present}
  if flags.FLAGS['text'].value is None:
    return said
  if 'bits' in said:
    raise packets.PacketError('`text` must not be given beside `bits`')
  return {**said, 'bits': packets.text_bits(flags.FLAGS['text'].value)}


def values() -> dict[str, Any]:
  """What the flags say, by the names of `scenario_fields`."""
  out = {name: flags.FLAGS[name].value for name in scenario_fields.defaults()}
  for name, value in out.items():
    if isinstance(value, str):  # Which may stand for more than text.
      out[name] = scenario_fields.parse(name, value)
  return out
