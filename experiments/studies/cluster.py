"""Flies jobs on a Dask cluster instead of in processes of this one.

A worker of the cluster must have the same versions and the same sources. It
works on one job at a time: several would share its GL.
"""

from collections.abc import Generator, Iterator, Sequence
from concurrent import futures as futures_lib
import contextlib
import dataclasses
import functools
import importlib.util
import logging
import pathlib
import queue
import re
import socket
import tempfile
import threading
import time
from typing import TYPE_CHECKING
import uuid

from waggle_tasks import errors
from waggle_tasks.experiments.record import provenance, source_files
from waggle_tasks.experiments.studies import dask_probe, pool

if TYPE_CHECKING:
  import distributed

EXTRA = "pip install 'waggle-tasks[cluster]'"
_CONNECT_S = 10.0
_POLL_S = 0.5
_LOOK_S = 10.0  # How often to look whether anybody works.
_WORKERS_S = 60.0  # Clusters that grow on demand take a while.
_TURN = threading.Lock()
_Result = tuple[object, dict[str, bytes]]  # See `pool.Done`.


class ClusterError(errors.WaggleError):
  """A cluster that cannot be used."""


def find(scheduler: str) -> str:
  """Where a scheduler listens; refused when none does, before work.

  Args:
    scheduler: Its address, tcp://HOST:PORT, or the JSON file that it wrote.

  Returns:
    Its address.

  Raises:
    ClusterError: naming what is missing.
  """
  if importlib.util.find_spec('distributed') is None:
    raise ClusterError(f'`scheduler` needs an extra: {EXTRA}')
  try:
    address = scheduler
    if '://' not in scheduler and _names_file(scheduler):
      address = dask_probe.written(scheduler)
    found = re.fullmatch(r'tcp://(?:\[(.+)\]|([^\[\]:]+)):(\d+)', address)
    if not found or not 0 < int(found[3]) < 2**16:  # More would wrap around.
      raise ValueError('not tcp://HOST:PORT, nor tcp://[IPV6]:PORT')
    place = found[1] or found[2], int(found[3])
    socket.create_connection(place, _CONNECT_S).close()
    theirs = dask_probe.ask(address, _CONNECT_S)['packages']
  except (OSError, ValueError) as error:
    raise ClusterError(
      '`scheduler` must be the address of a running Dask scheduler, such as'
      f' tcp://127.0.0.1:8786, or the file that it wrote: {scheduler}: {error}'
    ) from None
  for name in ('dask', 'distributed'):
    here = importlib.import_module(name).__version__
    if theirs.get(name) != here:
      raise ClusterError(
        f'`scheduler` must have the versions of this command: {name} is'
        f' {theirs.get(name)} at {address}, not {here}'
      )
  return address


def _names_file(scheduler: str) -> bool:
  return scheduler.endswith('.json') or pathlib.Path(scheduler).exists()


def run(jobs: Sequence[pool.Job], place: str) -> Generator[pool.Done]:
  """Runs jobs on a cluster and yields those that are done, as `pool.run`.

  Args:
    jobs: What to do; they are begun in about this order.
    place: Address of the scheduler, see `find`.

  Raises:
    ClusterError: if there is no worker, or one of other versions or sources,
      or if the scheduler or all workers went away.
    WorkerError: if a job failed on every worker that tried it.
  """
  import distributed

  if not jobs:
    return
  # It tells of every try to find a scheduler that is gone.
  logging.getLogger('distributed.client').setLevel(logging.CRITICAL)
  ours = _origin()
  try:
    _wait_for_workers(place)
    with distributed.Client(place, timeout=_CONNECT_S) as client:
      yield from _run(jobs, client, place, ours)
  except futures_lib.CancelledError:
    raise _gone(place, 'the connection to it is lost') from None
  except (OSError, ImportError) as error:
    raise _gone(place, str(error) or 'it answers nothing') from None


def _wait_for_workers(place: str) -> None:
  end_s = time.monotonic() + _WORKERS_S
  while not dask_probe.ask(place, _CONNECT_S)['workers']:
    if time.monotonic() > end_s:
      raise ClusterError(
        f'`scheduler` must have workers: {place} had none for {_WORKERS_S:g} s'
      )
    time.sleep(_POLL_S)


def _run(
  jobs: Sequence[pool.Job],
  client: 'distributed.Client',
  place: str,
  ours: tuple[str, dict[str, str]],
) -> Iterator[pool.Done]:
  news: queue.SimpleQueue[distributed.Future] = queue.SimpleQueue()
  run_name = uuid.uuid4().hex  # Others may fly jobs of the same names.
  named = {f'{run_name} {job.name}': job for job in jobs}
  futures = [
    client.submit(
      _work, job, ours, key=key, priority=-number, retries=pool.TRIES - 1
    )
    for number, (key, job) in enumerate(named.items())
  ]
  for future in futures:
    future.add_done_callback(news.put)
  for _ in futures:
    future = _next(news, place)
    job = named[str(future.key)]
    yield pool.Done(job, *_result(future, job))
    future.release()


def _next(
  news: queue.SimpleQueue['distributed.Future'], place: str
) -> 'distributed.Future':
  """The next future that is done; ends when nobody works on it any more."""
  seen_s = time.monotonic()
  while True:
    with contextlib.suppress(queue.Empty):
      return news.get(timeout=_LOOK_S)
    reason = 'it has no workers'
    try:
      if dask_probe.ask(place, _CONNECT_S)['workers']:
        seen_s = time.monotonic()
    except ConnectionError as error:
      reason = str(error)
    if time.monotonic() - seen_s > _WORKERS_S:
      raise _gone(place, f'for {_WORKERS_S:g} s {reason}')


def _gone(place: str, reason: str) -> ClusterError:
  return ClusterError(
    f'`scheduler` went away: {place}: {reason}. What was flown is kept: when it'
    ' runs again, the same command goes on with the rest'
  )


def _result(future: 'distributed.Future', job: pool.Job) -> _Result:
  import distributed

  if future.cancelled():  # With the connection to the scheduler.
    raise futures_lib.CancelledError
  error = future.exception(_WORKERS_S)
  if isinstance(error, ClusterError):
    raise ClusterError(str(error))
  if error is not None:
    reason = f'{type(error).__name__}: {error}'
    if isinstance(error, distributed.KilledWorker):
      reason = 'each worker that tried it died'
    raise pool.WorkerError(f'{job.name} failed, at last: {reason}')
  return future.result(_WORKERS_S)


def _work(job: pool.Job, theirs: tuple[str, dict[str, str]]) -> _Result:
  """Does a job in a worker of the cluster, and nothing else meanwhile."""
  digest, versions = _origin()
  if digest != theirs[0]:
    raise ClusterError(
      'workers must have the sources of the client: those on'
      f' {socket.gethostname()} differ; start it again with the same ones'
    )
  other = {n for n, v in theirs[1].items() if versions.get(n) != v}
  if other:
    name = min(other)
    raise ClusterError(
      f'workers must have the versions of the client: {name} is'
      f' {versions.get(name)} on {socket.gethostname()}, not {theirs[1][name]}'
    )
  for name, hash_there in job.modules:
    if _module_hash(name) != hash_there:
      raise ClusterError(
        f'workers must have the modules of the client: {name} is missing on'
        f' {socket.gethostname()}, or differs; put the same one on its'
        ' PYTHONPATH and start it again'
      )
  with _TURN:
    pool.share_cores()
    return _done(job)


def _done(job: pool.Job) -> _Result:
  """What a job returns, and the files that it leaves in a folder of its own."""
  if job.draft is None:
    return job.do(lambda amount: None), {}
  with tempfile.TemporaryDirectory() as home:
    draft = pathlib.Path(home, job.draft.name)
    value = dataclasses.replace(job, draft=draft).do(lambda amount: None)
    files = draft.iterdir() if draft.exists() else ()
    return value, {path.name: path.read_bytes() for path in files}


@functools.cache
def _origin() -> tuple[str, dict[str, str]]:
  """Sources and versions of this process; asked for when it begins."""
  digest = provenance.source_digest(provenance.source_hashes())
  return digest, provenance.versions()


@functools.cache
def _module_hash(name: str) -> str | None:
  """SHA-256 of a module's file when this process first used it, or None.

  What was imported stays as it was, whatever becomes of the file.
  """
  try:
    spec = importlib.util.find_spec(name)
  except (ImportError, ValueError):
    return None
  if spec is None or not spec.origin:
    return None
  return source_files.hashes({name: pathlib.Path(spec.origin)})[name]
