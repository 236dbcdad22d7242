"""waggle_tasks: a motion-communication task suite for dm_control composer.

Importing this package imports neither dm_control nor mujoco: it picks a GL
backend where none would work, and names a broken pair of versions.
"""

import os
import sys
from typing import TYPE_CHECKING

from waggle_tasks import runtime
from waggle_tasks._version import __version__

if TYPE_CHECKING:
  from dm_control import composer

__all__ = ['__version__', 'load']

if _gl := runtime.default_gl(os.environ, sys.platform):
  os.environ['MUJOCO_GL'] = _gl
  runtime.choose_again(sys.modules)
if not runtime.reports_versions(sys.argv, sys.orig_argv):
  runtime.require_versions()


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
  """
  # Imported here, because the agents' side of the package must not reach
  # dm_control.
  from waggle_tasks import registry

  return registry.load(name, **changes)
