"""What has to be installed for learning libraries."""

import importlib.util

from waggle_tasks import errors

PACKAGES = 'gymnasium', 'pettingzoo'


class LearningError(errors.WaggleError):
  """A choice of a learner that does not exist, or what it takes is missing."""


def check() -> None:
  """Looks for the packages.

  Raises:
    LearningError: if one is missing, with the line that installs it.
  """
  missing = [
    each for each in PACKAGES if importlib.util.find_spec(each) is None
  ]
  if missing:
    raise LearningError(
      f'waggle_tasks.rl needs {" and ".join(missing)}:'
      " pip install 'waggle-tasks[rl]'"
    )
