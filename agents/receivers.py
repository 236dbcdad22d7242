"""Receivers by name, and by name with some of their numbers changed."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import receiver
from waggle_tasks.protocol import checks, gestures

RECEIVERS = {'klt': receiver.KltReceiver}


class ReceiverError(errors.WaggleError):
  """A receiver, or a number of one, that does not exist."""


def make(name: str, codebook: gestures.Codebook) -> receiver.Receiver:
  """Makes a receiver at the beginning of an episode.

  Args:
    name: One of `RECEIVERS`, as it is ('klt') or with numbers of its
      configuration changed ('klt:corner_quality=0.1,max_rmse=0.2').
    codebook: The agreed gestures.

  Raises:
    ReceiverError: if the name or a number is not known, or not a number.
  """
  kind, _, changes = name.partition(':')
  checks.choice('receiver', kind, [*RECEIVERS], ReceiverError)
  return RECEIVERS[kind](codebook, configure(changes))


def configure(changes: str) -> config_lib.Config:
  """The default configuration with changes such as 'max_rmse=0.2,...'.

  Raises:
    ReceiverError: if a name is not known, or a value is not a number.
  """
  default = config_lib.Config()
  groups = {
    f.name: getattr(default, f.name) for f in dataclasses.fields(default)
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
    checks.number(name, value, 0, 1e6, ReceiverError)
    groups[group] = dataclasses.replace(groups[group], **{name: value})
  return config_lib.Config(**groups)
