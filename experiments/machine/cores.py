"""The cores of this machine that are ours."""

import os


def usable() -> list[int]:
  """The cores that this process may run on, where the system tells; or all."""
  if hasattr(os, 'sched_getaffinity'):  # Not on macOS.
    return sorted(os.sched_getaffinity(0))
  return list(range(os.cpu_count() or 1))
