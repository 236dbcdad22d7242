"""The flag that names a receiver, for every launcher that takes one."""

from typing import Any, overload

from absl import flags

from waggle_tasks.agents import outsiders, receivers

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

RULE = (
  f'One of {", ".join(receivers.RECEIVERS)}, or {outsiders.FORM} of your own;'
  ' with :NUMBER=VALUE,... for other numbers.'
)


@overload
def define(default: str = 'klt') -> flags.FlagHolder[str]: ...


@overload
def define(default: None) -> flags.FlagHolder[str | None]: ...


def define(default: str | None = 'klt') -> flags.FlagHolder[Any]:
  """Defines the flag for the launcher that calls this.

  Args:
    default: The receiver when none is given; None for those of the launcher.
  """
  return flags.DEFINE_string(
    'receiver', default, f'How observers read images. {RULE}'
  )
