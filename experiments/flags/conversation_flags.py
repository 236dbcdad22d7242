"""Flags for every choice of a conversation, and the one that they make."""

import dataclasses
from typing import Any

from absl import flags

from waggle_tasks import conversation
from waggle_tasks.experiments.flags import scenario_flags
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import packets

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

_KIND = conversation.Conversation


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  scenario_flags.define(_KIND)


def read() -> conversation.Conversation:
  """The conversation of the flags.

  Raises:
    WaggleError: if a value breaks a rule.
  """
  parts: dict[str, dict[str, Any]] = {'': {}}
  for name, field in scenario_fields.table(_KIND).items():
    flag = flags.FLAGS[name]
    if flag.present:
      value: Any = flag.value
      if field.form is not None:
        value = scenario_fields.parse(name, value)
      parts.setdefault(field.part, {})[field.name] = field.taken(value)
  text = flags.FLAGS['text'].value
  whole = parts.pop('')
  if text is not None:
    if 'bits' in whole:
      raise packets.PacketError('`text` must not be given beside `bits`')
    whole['bits'] = packets.text_bits(text)
  for part, values in parts.items():
    whole[part] = dataclasses.replace(getattr(_KIND, part), **values)
  return _KIND(**whole)
