"""The flag that names a receiver, for every launcher that takes one."""

from collections.abc import Iterable
from typing import Any, overload

from absl import flags

from waggle_tasks import scenario
from waggle_tasks.agents import outsiders, receivers
from waggle_tasks.experiments.record import fitting

JOINT = fitting.JOINT
_LANGUAGE = f"Unset, {JOINT} where another language than the paper's is spoken."

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

RULE = (
  f'One of {", ".join(receivers.RECEIVERS)}, a name that an installed package'
  f' offers, or {outsiders.FORM} of your own;'
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
    'receiver', default, f'How observers read images. {RULE} {_LANGUAGE}'
  )


def chosen(
  flag: flags.FlagHolder[str], scenes: Iterable[scenario.Scenario]
) -> str:
  """The receiver that was asked for, or one that reads what is spoken.

  Args:
    flag: What `define` made.
    scenes: What is to be flown.

  Raises:
    ReceiverError: if there is none of that name, or it does not read a
      language of theirs.
  """
  agreements = {scene.language: scene.agreement for scene in scenes}
  name = flag.value
  if not flag.present and any(a.language for a in agreements.values()):
    name = JOINT
  for agreement in agreements.values():
    receivers.make(name, agreement)
  return name
