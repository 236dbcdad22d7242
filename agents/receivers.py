"""Receivers by name."""

from waggle_tasks import errors
from waggle_tasks.agents import receiver
from waggle_tasks.protocol import checks, gestures

RECEIVERS = {'klt': receiver.KltReceiver}


class ReceiverError(errors.WaggleError):
  """A receiver that does not exist."""


def make(name: str, codebook: gestures.Codebook) -> receiver.Receiver:
  """Makes a receiver at the beginning of an episode.

  Args:
    name: One of `RECEIVERS`.
    codebook: The agreed gestures.

  Raises:
    ReceiverError: if the name is not known.
  """
  checks.choice('receiver', name, [*RECEIVERS], ReceiverError)
  return RECEIVERS[name](codebook)
