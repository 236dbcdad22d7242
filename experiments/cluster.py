"""Flies jobs on a Dask cluster instead of in processes of this one.

A worker of the cluster must have the same versions and the same sources. It
works on one job at a time: several would share its GL.
"""

from collections.abc import Iterator, Sequence
import functools
import importlib.util
import json
import pathlib
import re
import socket
import threading
import uuid

from waggle_tasks import errors
from waggle_tasks.experiments import pool, provenance

EXTRA = "pip install 'waggle-tasks[cluster]'"
_CONNECT_S = 10.0
_WORKERS_S = 60.0  # Clusters that grow on demand take a while.
_TURN = threading.Lock()


class ClusterError(errors.WaggleError):
  """A cluster that cannot be used."""


def find(scheduler: str) -> tuple[str, int]:
  """Where a scheduler listens; refused when nothing does, before work.

  Args:
    scheduler: Its address, tcp://HOST:PORT, or the JSON file that it wrote.

  Returns:
    Its host and port.

  Raises:
    ClusterError: naming what is missing.
  """
  if importlib.util.find_spec('distributed') is None:
    raise ClusterError(f'`scheduler` needs an extra: {EXTRA}')
  address = scheduler
  try:
    if scheduler.endswith('.json'):
      address = json.loads(pathlib.Path(scheduler).read_text())['address']
    found = re.fullmatch(r'tcp://(.+):(\d+)', address)
    if not found:
      raise ValueError('not tcp://HOST:PORT')
    place = found[1], int(found[2])
    socket.create_connection(place, _CONNECT_S).close()
  except (OSError, ValueError, KeyError, TypeError, OverflowError) as error:
    raise ClusterError(
      '`scheduler` must be the address of a running Dask scheduler, such as'
      f' tcp://127.0.0.1:8786, or the file that it wrote: {scheduler}: {error}'
    ) from None
  return place


def run(
  jobs: Sequence[pool.Job], place: tuple[str, int]
) -> Iterator[pool.Done]:
  """Runs jobs on a cluster and yields those that are done, as `pool.run`.

  Args:
    jobs: What to do; they are begun in about this order.
    place: Of the scheduler, see `find`.

  Raises:
    ClusterError: if there is no worker, or one of other versions or sources.
    WorkerError: if a job failed on every worker that tried it.
  """
  import distributed

  if not jobs:
    return
  address = f'tcp://{place[0]}:{place[1]}'
  with distributed.Client(address) as client:
    try:
      client.wait_for_workers(1, timeout=_WORKERS_S)
    except TimeoutError:
      raise ClusterError(
        f'`scheduler` must have workers: {address} had none for'
        f' {_WORKERS_S:g} s'
      ) from None
    ours = _origin()
    run_name = uuid.uuid4().hex  # Others may fly jobs of the same names.
    futures = [
      client.submit(
        _work, job, ours, key=f'{run_name} {job.name}',
        priority=-number, retries=pool.TRIES - 1,
      )
      for number, job in enumerate(jobs)
    ]  # fmt: skip
    named = dict(zip((future.key for future in futures), jobs, strict=True))
    try:
      for future in distributed.as_completed(futures):
        yield pool.Done(named[future.key], _result(future, named[future.key]))
        future.release()
    finally:
      client.cancel(futures)


def _result(future: object, job: pool.Job) -> object:
  error = future.exception()
  if isinstance(error, ClusterError):
    raise ClusterError(str(error))
  if error is not None:
    reason = f'{type(error).__name__}: {error}'
    raise pool.WorkerError(f'{job.name} failed, at last: {reason}')
  return future.result()


def _work(job: pool.Job, theirs: tuple[str, dict[str, str]]) -> object:
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
  with _TURN:
    pool.share_cores()
    return job.work(lambda amount: None, *job.arguments)


@functools.cache
def _origin() -> tuple[str, dict[str, str]]:
  """Sources and versions of this process; asked for when it begins."""
  digest = provenance.source_digest(provenance.source_hashes())
  return digest, provenance.versions()
