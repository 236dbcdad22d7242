"""What runs a simulation says that it cannot be copied."""

from typing import SupportsIndex

from waggle_tasks import errors


class CopyError(errors.WaggleError):
  """A copy of what cannot be copied."""


class Uncopied:
  """A base of what is made anew rather than copied or pickled."""

  def __reduce_ex__(self, protocol: SupportsIndex) -> tuple:
    """Refuses to be copied or pickled.

    Raises:
      CopyError: always.
    """
    raise CopyError(
      f'{type(self).__name__} is part of a running simulation and cannot be'
      ' copied or pickled: copy or pickle its `Scenario` and make another one'
      ' of it, with `waggle_tasks.load` or `waggle_tasks.registry.environment`'
    )
