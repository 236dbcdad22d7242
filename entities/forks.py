"""A process that was forked from one that drew cannot draw: it would hang.

The threads of the GL library are not there in the copy, which waits for them.
"""

import os

from waggle_tasks import errors

_first: int | None = None  # The process that drew first.


class ForkError(errors.WaggleError):
  """Drawing in a process that was forked after its parent drew."""


def check() -> None:
  """Notes that this process draws.

  Raises:
    ForkError: if it was forked from one that drew.
  """
  global _first
  here = os.getpid()
  if _first is None:
    _first = here
  elif _first != here:
    raise ForkError(
      'images must not be drawn in a process that was forked after its parent'
      ' drew: it would wait for ever; start it with the method "spawn", such as'
      " multiprocessing.get_context('spawn') or"
      " AsyncVectorEnv(..., context='spawn')"
    )
