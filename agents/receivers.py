"""Receivers by name, and by name with some of their numbers changed."""

import dataclasses

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import receiver
from waggle_tasks.protocol import checks, gestures

RECEIVERS = {
  'klt': receiver.KltReceiver,
  'view_bank': receiver.ViewBankReceiver,
}


ReceiverError = config_lib.ReceiverError


def make(
  name: str, codebook: gestures.Codebook, zoom: float = 1.0
) -> receiver.Receiver:
  """Makes a receiver at the beginning of an episode.

  Args:
    name: One of `RECEIVERS`, as it is ('klt') or with numbers of its
      configuration changed ('klt:corner_quality=0.1,max_rmse=0.2').
    codebook: The agreed gestures.
    zoom: Focal length of the camera over that of an observer's eye.

  Raises:
    ReceiverError: if the name or a number is not known, or not a number.
  """
  kind, _, changes = name.partition(':')
  checks.choice('receiver', kind, [*RECEIVERS], ReceiverError)
  made = RECEIVERS[kind]
  config = config_lib.zoomed(configure(changes, made.DEFAULT), zoom)
  return made(codebook, config)


def configure(
  changes: str, default: config_lib.Config = config_lib.Config()
) -> config_lib.Config:
  """A configuration with changes such as 'max_rmse=0.2,...'.

  Args:
    changes: Names and numbers; may be empty.
    default: What is changed.

  Raises:
    ReceiverError: if a name is not known, or a value is not a number.
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
    try:
      value = kind(text)
    except ValueError:
      raise ReceiverError(
        f'`{name}` must be of type {kind.__name__}: got {text!r}'
      ) from None
    groups[group] = dataclasses.replace(groups[group], **{name: value})
  return config_lib.Config(**groups)
