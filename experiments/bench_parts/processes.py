"""Processes to measure in: spawned, drawing on one thread each.

What a machine does with its other cores, and what this process has loaded,
then stays out of the numbers. Nothing here imports a GL stack: how many
threads it draws with is settled when it is loaded.
"""

from collections.abc import Callable, Iterator
from concurrent import futures
from concurrent.futures import process
import contextlib
import multiprocessing
import os
import time
from typing import TypeVar

from waggle_tasks import errors
from waggle_tasks.experiments.machine import cores

_Result = TypeVar('_Result')

Clock = Callable[[], float]

# Mesa's software renderers (https://docs.mesa3d.org/drivers/llvmpipe.html).
_SOFTWARE = ('llvmpipe', 'softpipe')
_THREADS = ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS')


class ProcessError(errors.WaggleError):
  """A process to measure in that died."""


def clock(renderer_name: str) -> Clock:
  """The clock that other programs on the machine disturb least.

  Args:
    renderer_name: The GL renderer.

  Returns:
    Processor time of all threads where Mesa draws in software, which is the
    time that one undisturbed core takes; elsewhere time as it passes.
  """
  software = any(name in renderer_name.lower() for name in _SOFTWARE)
  return time.process_time if software else time.perf_counter


@contextlib.contextmanager
def worker(core: int | None = None) -> Iterator[futures.Executor]:
  """A new process that does one job after another.

  Args:
    core: The one core that it may run on; None for all of them.

  Raises:
    ProcessError: if it died.
  """
  context = multiprocessing.get_context('spawn')
  try:
    with futures.ProcessPoolExecutor(1, context, _prepare, (core,)) as executor:
      yield executor
  except process.BrokenProcessPool:
    raise ProcessError(
      'a process died while it was measured: see whether memory ran out, and'
      ' measure again'
    ) from None


def alone(function: Callable[..., _Result], *arguments: object) -> _Result:
  """Calls a function in a new process, on the last core."""
  with worker(cores.usable()[-1]) as executor:
    return executor.submit(function, *arguments).result()


def _prepare(core: int | None) -> None:
  """Confines a process, before it loads what it measures."""
  os.environ.update(dict.fromkeys(_THREADS, '1'))
  os.environ['LP_NUM_THREADS'] = '0'  # Draw in the calling thread.
  if core is not None and hasattr(os, 'sched_setaffinity'):
    os.sched_setaffinity(0, {core})
  import cv2

  cv2.setNumThreads(1)
