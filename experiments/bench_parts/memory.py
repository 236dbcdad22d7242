"""Peak memory of one process over many broadcasts."""

import resource
import sys

from waggle_tasks import scenario
from waggle_tasks.experiments.bench_parts import loops

# `ru_maxrss` is in kilobytes on Linux and in bytes on macOS (getrusage(2)).
_UNIT_MB = 2**-20 if sys.platform == 'darwin' else 2**-10


def measure(scene: scenario.Scenario, broadcasts: int) -> list[float]:
  """The peak so far after each broadcast of this process, in MB."""
  peaks_mb = []
  for _ in range(broadcasts):
    loops.run(scene)
    usage = resource.getrusage(resource.RUSAGE_SELF)
    peaks_mb.append(usage.ru_maxrss * _UNIT_MB)
  return peaks_mb
