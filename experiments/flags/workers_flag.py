"""The flag that says how many processes work, for launchers that take it."""

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments.machine import cores
from waggle_tasks.protocol import checks

# The flag defined here belongs to the launcher that asks for it.
flags.disclaim_key_flags()

_MOST = 1024


def define() -> flags.FlagHolder[int | None]:
  """Defines the flag for the launcher that calls this."""
  return flags.DEFINE_integer(
    'workers', None, 'How many processes; unset, one for each core.'
  )


def count(value: int | None) -> int:
  """How many workers a flag asks for, one a core if it is not given.

  Args:
    value: What it says.

  Raises:
    WaggleError: if it asks for none, or for too many.
  """
  if value is not None:
    return checks.integer('workers', value, 1, _MOST, errors.WaggleError)
  return len(cores.usable())
