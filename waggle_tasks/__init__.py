"""waggle_tasks: a motion-communication task suite for dm_control composer.

Importing this package imports neither dm_control nor mujoco, nor does any name
of it but `load`, when it is called. It picks a GL backend where none would
work.
"""

import importlib
import os
import sys
from typing import TYPE_CHECKING

from waggle_tasks import runtime
from waggle_tasks._version import __version__

if TYPE_CHECKING:
  from dm_control import composer

  from waggle_tasks.agents import receivers
  from waggle_tasks.agents.observer_agent import Team
  from waggle_tasks.arenas import layouts
  from waggle_tasks.errors import WaggleError
  from waggle_tasks.plain import from_plain, to_plain
  from waggle_tasks.protocol.agreement import Agreement
  from waggle_tasks.scenario import Scenario

__all__ = [
  'Agreement',
  'Scenario',
  'Team',
  'WaggleError',
  '__version__',
  'from_plain',
  'layouts',
  'load',
  'receivers',
  'to_plain',
]

# Where names are that are imported when they are first asked for.
_HOMES = {
  'Agreement': 'protocol.agreement',
  'Scenario': 'scenario',
  'Team': 'agents.observer_agent',
  'WaggleError': 'errors',
  'from_plain': 'plain',
  'layouts': 'arenas.layouts',
  'receivers': 'agents.receivers',
  'to_plain': 'plain',
}

if _gl := runtime.default_gl(os.environ, sys.platform):
  os.environ['MUJOCO_GL'] = _gl
  runtime.choose_again(sys.modules)


def __getattr__(name: str) -> object:
  if name not in _HOMES:
    raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
  home = _HOMES[name]
  value = importlib.import_module(f'{__name__}.{home}')
  if not home.endswith(f'.{name}'):
    value = getattr(value, name)
  globals()[name] = value  # Asked for once.
  return value


def __dir__() -> list[str]:
  return sorted({*globals(), *__all__})


def load(name: str, **changes: object) -> 'composer.Environment':
  """Builds the environment of a named scenario.

  Args:
    name: A name from the table of scenarios.
    **changes: Fields of the scenario to replace.

  Returns:
    An environment, to be made, used and closed in one thread.

  Raises:
    WaggleError: The name, a field or a value is not valid; the message lists
      the valid choices.
    VersionError: dm-control cannot run on the installed mujoco.
  """
  from waggle_tasks import registry

  return registry.load(name, **changes)
