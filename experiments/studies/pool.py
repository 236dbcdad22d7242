"""Spawned worker processes that are watched, and replaced when they fail.

Processes are spawned: a fork after a GL context exists hangs. Each worker
does one job at a time and says from time to time that it is alive. One that
dies, or falls silent, is replaced, and its job is tried once more.
"""

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import multiprocessing
from multiprocessing import connection
from multiprocessing import process as process_lib
import os
import pathlib
import signal
import time
import traceback
from typing import Any

import cv2

from waggle_tasks import errors
from waggle_tasks.experiments.machine import gl

SILENCE_S = 120.0  # Longer than any job is silent, starting included.
TRIES = 2
# Workers keep the memory of images instead of handing it back each time: up to
# 64 MB a piece, 256 MB in all (mallopt(3)).
_MEMORY = {
  'MALLOC_MMAP_THRESHOLD_': str(2**26),
  'MALLOC_TRIM_THRESHOLD_': str(2**28),
}


class WorkerError(errors.WaggleError):
  """A job that failed in every worker that tried it."""


class _JobError(Exception):
  """What a job raised in its worker."""


@dataclasses.dataclass(frozen=True)
class Job:
  """Something to do in a worker.

  Attributes:
    name: For people.
    work: What to call; it and its arguments are sent to another process.
    arguments: For `work`; a function to report progress with comes first.
    modules: Names of modules from outside of this project that it uses, and
      the SHA-256 of each: who does it elsewhere must have the same.
    draft: A folder that its work leaves, which comes last; None for no folder.
  """

  name: str
  work: Callable
  arguments: tuple
  modules: tuple[tuple[str, str], ...] = ()
  draft: pathlib.Path | None = None

  def do(self, report: Callable[[float], None]) -> object:
    """Does it, and returns what its work returned."""
    folder = () if self.draft is None else (self.draft,)
    return self.work(report, *self.arguments, *folder)


@dataclasses.dataclass(frozen=True)
class Advance:
  """How far a job is; `amount` is what its work reported."""

  job: Job
  amount: float


@dataclasses.dataclass(frozen=True)
class Done:
  """A finished job.

  Attributes:
    job: The job.
    value: What its work returned.
    files: What it left in the folder of its draft, where that is elsewhere.
  """

  job: Job
  value: Any
  files: Mapping[str, bytes] = dataclasses.field(default_factory=dict)


# Begins jobs in their order and tells what becomes of them.
Engine = Callable[[Sequence[Job]], Generator[Advance | Done]]


@dataclasses.dataclass(eq=False)
class _Worker:
  """One process, the parent's end of its pipe, and what it does."""

  process: process_lib.BaseProcess
  pipe: connection.Connection
  job: Job | None = None
  heard_s: float = dataclasses.field(default_factory=time.monotonic)


def run(
  jobs: Sequence[Job], workers: int, silence_s: float = SILENCE_S
) -> Generator[Advance | Done]:
  """Runs jobs and yields what happens, in the order in which it happens.

  Args:
    jobs: What to do; they are begun in this order.
    workers: How many processes, at least 1.
    silence_s: After how long without a sign of life a worker is replaced.

  Raises:
    WorkerError: if a job failed, or its worker died, `TRIES` times.
  """
  waiting, tries = list(jobs), dict.fromkeys((job.name for job in jobs), 0)
  team = [_start() for _ in range(min(workers, len(jobs)))]
  try:
    while waiting or any(worker.job for worker in team):
      for worker in team:
        if worker.job is None and waiting:
          _give(worker, waiting.pop(0))
      pipes = [worker.pipe for worker in team if worker.job]
      ready = connection.wait(pipes, timeout=1.0)
      for number, worker in enumerate(team):
        job = worker.job
        if job is None:
          continue
        if worker.pipe in ready:
          try:
            yield from _hear(worker, job)
            continue
          except _JobError as error:
            reason = str(error)
          except (EOFError, OSError):  # Also in the middle of a message.
            reason = _death(worker)
        elif time.monotonic() - worker.heard_s > silence_s:
          reason = f'no sign of life for {silence_s:g} s'
        else:
          continue
        _retry(worker, job, reason, waiting, tries)
        team[number] = _start()
  finally:
    for worker in team:
      _end(worker)


def share_cores() -> None:
  """Keeps this process to one core; others work beside it."""
  os.environ.setdefault('LP_NUM_THREADS', '0')  # Draw in this thread.
  cv2.setNumThreads(1)


def _start() -> _Worker:
  for name, value in _MEMORY.items():  # glibc reads them as a process starts.
    os.environ.setdefault(name, value)
  context = multiprocessing.get_context('spawn')
  ours, theirs = context.Pipe()
  process = context.Process(target=_serve, args=(theirs,), daemon=True)
  process.start()
  theirs.close()  # So that the worker's death closes the pipe.
  return _Worker(process, ours)


def _give(worker: _Worker, job: Job) -> None:
  worker.job, worker.heard_s = job, time.monotonic()
  with contextlib.suppress(BrokenPipeError):  # Its death is noticed later.
    worker.pipe.send(job)


def _hear(worker: _Worker, job: Job) -> Iterator[Advance | Done]:
  kind, value = worker.pipe.recv()
  worker.heard_s = time.monotonic()
  if kind == 'failed':
    raise _JobError(value)
  if kind == 'done':
    worker.job = None
    yield Done(job, value)
  else:
    yield Advance(job, value)


def _retry(
  worker: _Worker,
  job: Job,
  reason: str,
  waiting: list[Job],
  tries: dict[str, int],
) -> None:
  """Ends a failed worker and puts its job back, or gives it up."""
  _end(worker)
  tries[job.name] += 1
  if tries[job.name] >= TRIES:
    raise WorkerError(f'{job.name} failed {TRIES} times, at last: {reason}')
  waiting.insert(0, job)


def _death(worker: _Worker) -> str:
  """How a worker's process ended, which tells what to look for."""
  worker.process.join(1.0)
  code = worker.process.exitcode
  if code is None or code >= 0:
    return 'its process died'
  return f'its process was ended by {signal.Signals(-code).name}'


def _end(worker: _Worker) -> None:
  worker.process.kill()
  worker.process.join()
  worker.pipe.close()


def _serve(pipe: connection.Connection) -> None:
  """What a worker process does; it ends when its parent is gone."""
  signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent ends workers.
  share_cores()
  while True:
    try:
      job = pipe.recv()
    except EOFError:
      return
    try:
      value = job.do(lambda n: pipe.send(('progress', n)))
      answer = ('done', value)
    except BrokenPipeError:
      return
    except Exception as error:
      # Where nothing can be drawn, one line says what to mend.
      said = gl.problem() if gl.may_cause(error) else None
      answer = ('failed', said or traceback.format_exc(limit=-1).strip())
    pipe.send(answer)
