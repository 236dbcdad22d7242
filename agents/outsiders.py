"""Receivers from outside of this project, by module and class."""

from collections.abc import Callable, Sequence
import dataclasses
import importlib
import types
from typing import Any

from waggle_tasks import errors
from waggle_tasks.agents import group

FORM = 'package.module:Class'


class MissingError(group.ReceiverError):
  """A receiver whose module or class is not on this machine."""


def find(
  module_name: str, rest: str, known: Sequence[str]
) -> tuple[Callable, str]:
  """What makes a receiver, and the changes of its configuration.

  A worker imports it by itself, so that its name is all that is sent.

  Args:
    module_name: Its module.
    rest: Its class, and maybe changes: 'Class:number=value'.
    known: Names of receivers that need no module.

  Raises:
    ReceiverError: if there is no such module or class, or it is no receiver.
  """
  name, _, changes = rest.partition(':')
  if not _is_module(module_name) or not name.isidentifier():
    hint = errors.did_you_mean(module_name, known)
    raise group.ReceiverError(
      f'`receiver` must be one of {[*known]} or {FORM}: got'
      f' {module_name!r}.{hint}'
    )
  module = _imported(module_name, known)
  made = getattr(module, name, None)
  if made is None:
    own = [n for n, each in vars(module).items() if isinstance(each, type)]
    raise MissingError(
      f'`receiver` must be a class of {module_name}, which has no {name!r}.'
      f'{errors.did_you_mean(name, own)}'
    )
  check(made, f'{module_name}:{name}')
  return made, changes


def _is_module(name: str) -> bool:
  return all(part.isidentifier() for part in name.split('.'))


def _imported(name: str, known: Sequence[str]) -> types.ModuleType:
  try:
    return importlib.import_module(name)
  except ModuleNotFoundError as error:
    if error.name and f'{name}.'.startswith(f'{error.name}.'):
      raise MissingError(
        f'`receiver` must be one of {[*known]} or {FORM}: there is no module'
        f' {error.name!r} in the working folder, on PYTHONPATH or among what is'
        f' installed.{errors.did_you_mean(name, known)}'
      ) from None
    raise _broken(name, error) from error
  except (Exception, SystemExit) as error:  # It is code of anybody.
    raise _broken(name, error) from error


def _broken(name: str, error: BaseException) -> MissingError:
  return MissingError(
    f'`receiver` must be in a module that can be imported: {name}:'
    f' {type(error).__name__}: {error}'
  )


def check(made: object, place: str) -> None:
  """Refuses what cannot make a receiver.

  Args:
    made: A class, or anything that can be called.
    place: What an error calls it.

  Raises:
    ReceiverError: naming what it lacks.
  """
  lacks = []
  if not callable(made) or (isinstance(made, type) and not _steps(made)):
    lacks.append('step(image, time_s)')
  if not hasattr(made, 'DEFAULT'):
    lacks.append('DEFAULT, its configuration')
  if lacks:
    raise group.ReceiverError(
      f'`{place}` must be a receiver: it lacks {" and ".join(lacks)}'
    )
  maker: Any = made
  default = maker.DEFAULT
  frozen = getattr(type(default), '__dataclass_params__', None)
  if default is None or (frozen is not None and frozen.frozen):
    return
  if dataclasses.is_dataclass(default) and not isinstance(default, type):
    word = f'{type(default).__name__}, which is not frozen'
  else:
    word = repr(default)
  raise group.ReceiverError(
    f'`DEFAULT` of {place} must be a frozen dataclass, or None for a receiver'
    f' without numbers: got {word}'
  )


def _steps(made: type) -> bool:
  return callable(getattr(made, 'step', None))
