"""Receivers by name, or by module and class, with numbers changed in place."""

from collections.abc import Callable, Sequence
import inspect
from typing import Any, Protocol

from waggle_tasks import doors
from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import (
  description,
  events_receiver,
  group,
  joint_receiver,
  learned_receiver,
  outsiders,
  receiver,
  seeker,
  settings,
)
from waggle_tasks.protocol import agreement as agreement_lib

ReceiverError = group.ReceiverError


class Maker(Protocol):
  """What makes a receiver: mostly its class.

  Attributes:
    DEFAULT: The configuration that goes with it, see `receiver.Receiver`.
  """

  DEFAULT: object

  def __call__(
    self, agreement: agreement_lib.Agreement, config: object
  ) -> receiver.Receiver:
    """Makes a receiver at the beginning of an episode."""
    ...


RECEIVERS: dict[str, Any] = {  # A `Maker` each.
  'klt': receiver.KltReceiver,
  'klt_bank': receiver.KltBankReceiver,
  'absolute': receiver.AbsoluteReceiver,
  'view_bank': receiver.ViewBankReceiver,
  'joint': joint_receiver.JointReceiver,
  'events': events_receiver.EventsReceiver,
  'learned': learned_receiver.LearnedReceiver,
  'seeker': seeker.SeekerReceiver,
}
_PARTS = ('step', 'track', 'segment')  # Of what was made.


def make(
  name: str,
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
) -> receiver.Receiver:
  """Makes a receiver at the beginning of an episode.

  Args:
    name: One of `RECEIVERS`, one that an installed package offers, see
      `doors`, or a class of one's own by its place, 'package.module:Class'; as
      it is ('klt') or with parts of its
      configuration changed ('klt:corner_quality=0.1,separators=off').
    agreement: What both sides know.

  Raises:
    ReceiverError: as `configured` does; and if it is no receiver.
  """
  made, config = configured(name)
  _check_call(made, f'`{_plain(name)}`', ('agreement', 'config'))
  reader = made(agreement, config)
  if missing := [part for part in _PARTS if not hasattr(reader, part)]:
    raise ReceiverError(
      f'`{_plain(name)}` must have {", ".join(_PARTS)}, of which the last two'
      f' may be None: it lacks {", ".join(missing)}'
    )
  _check_call(reader.step, f'`step` of {_plain(name)}', ('image', 'time_s'))
  return reader


def configured(name: str) -> tuple[Maker, object]:
  """What makes a receiver of a name, and the configuration that goes with it.

  Args:
    name: See `make`.

  Raises:
    ReceiverError: if the name, the module, the class or what is changed is not
      known, or a value is not of its type.
    DoorError: if a package offers the name and it cannot be used.
  """
  made: Any
  kind, _, changes = name.partition(':')
  offered = doors.find('receivers', kind, RECEIVERS)
  if kind in RECEIVERS or offered is not None:
    made = RECEIVERS.get(kind, offered)
    outsiders.check(made, kind)
  else:
    known = [*RECEIVERS, *doors.names('receivers')]
    made, changes = outsiders.find(kind, changes, known)
  return made, configure(changes, made.DEFAULT)


def configure(changes: str, default: object = config_lib.Config()) -> object:
  """A configuration with changes such as 'max_rmse=0.2,separators=off'.

  Args:
    changes: Names with numbers, or with 'on' or 'off'; may be empty.
    default: What is changed: a frozen dataclass, of others where it has groups.

  Raises:
    ReceiverError: if a name is not known, or a value is not of its type.
  """
  return settings.changed(default, changes)


def describe(
  name: str,
  agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
  width_px: float | None = None,
) -> description.Description:
  """The limits of a receiver, for people.

  A receiver of one's own tells them with a class method
  `describe(agreement, config, width_px)`; one without it tells nothing.

  Args:
    name: See `make`.
    agreement: What both sides know.
    width_px: How wide the target is in the picture, where that is known.

  Raises:
    ReceiverError: as `configured` does.
  """
  made, config = configured(name)
  tell = getattr(made, 'describe', None)
  if tell is None:
    return description.Description()
  told = tell(agreement, config, width_px)
  if not isinstance(told, description.Description):
    raise ReceiverError(
      f'`describe` of {_plain(name)} must return a description.Description:'
      f' got {told!r}'
    )
  return told


def _plain(name: str) -> str:
  """A receiver's name without what is changed."""
  return ':'.join(each for each in name.split(':') if '=' not in each)


def _check_call(
  function: Callable, what: str, arguments: Sequence[str]
) -> None:
  """Refuses what cannot be called with these arguments in this order."""
  try:
    inspect.signature(function).bind(*arguments)
  except ValueError:
    return  # Of compiled code, which does not say what it takes.
  except TypeError as error:
    raise ReceiverError(
      f'{what} must take ({", ".join(arguments)}): {error}'
    ) from None
