"""Receivers by name, and by name with some of their numbers changed."""

import dataclasses

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import receiver
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks

RECEIVERS = {
  'klt': receiver.KltReceiver,
  'klt_bank': receiver.KltBankReceiver,
  'absolute': receiver.AbsoluteReceiver,
  'view_bank': receiver.ViewBankReceiver,
}


ReceiverError = config_lib.ReceiverError


def make(
  name: str,
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
) -> receiver.Receiver:
  """Makes a receiver at the beginning of an episode.

  Args:
    name: One of `RECEIVERS`, as it is ('klt') or with parts of its
      configuration changed ('klt:corner_quality=0.1,separators=off').
    agreement: What both sides know.

  Raises:
    ReceiverError: as `configured` does.
  """
  made, config = configured(name)
  return made(agreement, config_lib.zoomed(config, agreement.camera.zoom))


def configured(
  name: str,
) -> tuple[type[receiver.Receiver], config_lib.Config]:
  """The class that a name stands for and the configuration that goes with it.

  Args:
    name: See `make`.

  Raises:
    ReceiverError: if the name or what is changed is not known, or a value is
      not of its type.
  """
  kind, _, changes = name.partition(':')
  checks.choice('receiver', kind, [*RECEIVERS], ReceiverError)
  made = RECEIVERS[kind]
  return made, configure(changes, made.DEFAULT)


def configure(
  changes: str, default: config_lib.Config = config_lib.Config()
) -> config_lib.Config:
  """A configuration with changes such as 'max_rmse=0.2,separators=off'.

  Args:
    changes: Names with numbers, or with 'on' or 'off'; may be empty.
    default: What is changed.

  Raises:
    ReceiverError: if a name is not known, or a value is not of its type.
  """
  groups = {
    f.name: group
    for f in dataclasses.fields(default)
    if (group := getattr(default, f.name)) is not None
  }
  homes = {
    field.name: (group, type(getattr(value, field.name)))
    for group, value in groups.items()
    for field in dataclasses.fields(value)
  }
  for change in changes.split(',') if changes else []:
    name, _, text = change.partition('=')
    checks.choice('receiver number', name, [*homes], ReceiverError)
    group, kind = homes[name]
    value = _switch(name, text) if kind is bool else _number(name, text, kind)
    groups[group] = dataclasses.replace(groups[group], **{name: value})
  return config_lib.Config(**groups)


_SWITCHES = {'on': True, 'off': False}


def _switch(name: str, text: str) -> bool:
  checks.choice(name, text, [*_SWITCHES], ReceiverError)
  return _SWITCHES[text]


def _number(name: str, text: str, kind: type[int] | type[float]) -> float:
  try:
    return kind(text)
  except ValueError:
    raise ReceiverError(
      f'`{name}` must be of type {kind.__name__}: got {text!r}'
    ) from None
