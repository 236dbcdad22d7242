"""Sweeps on a Dask cluster: a real scheduler and two real workers."""

from collections.abc import Callable, Iterator
import importlib.util
import json
import pathlib
import subprocess
import sys

import pytest

from waggle_tasks.experiments import cluster, pool, provenance

needs_dask = pytest.mark.skipif(
  importlib.util.find_spec('distributed') is None,
  reason="needs the extra [cluster]: pip install 'waggle-tasks[cluster]'",
)
# Dask warns of much; a process of its own keeps its threads and logs apart.
FLY = """
import functools, pathlib, sys
from waggle_tasks.experiments import (
  cluster, scenario_fields, sweep_cases, sweep_runner)
folder, scheduler, *grid = sys.argv[1:]
base = scenario_fields.defaults() | {
  'control': 'no_send', 'duration_s': 1.0, 'observers': 1}
engine = functools.partial(cluster.run, place=cluster.find(scheduler))
sweep_runner.run(
  sweep_cases.cases(sweep_cases.grid(grid), base, 1), 'view_bank',
  pathlib.Path(folder), engine, 'waggle sweep')
"""


@pytest.fixture(scope='module')
def dask(
  tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Callable[..., subprocess.Popen[bytes]]]:
  """Starts programs of Dask, which are ended at the end."""
  here, started = tmp_path_factory.mktemp('dask'), []

  def start(*words: str) -> subprocess.Popen[bytes]:
    process = subprocess.Popen(
      [sys.executable, '-m', 'dask', *words],
      cwd=here,
      stdout=subprocess.DEVNULL,
      stderr=subprocess.DEVNULL,
    )
    started.append(process)
    return process

  start.here = here
  yield start
  for process in reversed(started):
    process.terminate()
    process.wait(30)


@pytest.fixture(scope='module')
def scheduler(dask: Callable[..., object]) -> pathlib.Path:
  """The file of a scheduler that has two workers."""
  path = dask.here / 'scheduler.json'
  dask('scheduler', '--port=0', f'--scheduler-file={path}', '--no-dashboard')
  for _ in range(2):
    dask(
      'worker', f'--scheduler-file={path}', '--nthreads=1', '--nworkers=1',
      '--no-dashboard',
    )  # fmt: skip
  return path


@needs_dask
def test_a_cluster_gives_the_same_bytes_as_one_worker(
  scheduler: pathlib.Path,
  sweep: object,
  flown: object,
  wait_until: Callable[..., None],
) -> None:
  wait_until(scheduler.exists)
  address = json.loads(scheduler.read_text())['address']
  done = subprocess.run(
    [sys.executable, '-c', FLY, str(sweep.folder), address, *sweep.grid],
    capture_output=True,
    text=True,
    check=False,
  )
  assert done.returncode == 0, done.stderr
  assert sweep.results() == flown.results()


@needs_dask
@pytest.mark.parametrize(
  ('scheduler', 'said'),
  [
    ('tcp://127.0.0.1:1', 'Connection refused'),
    ('127.0.0.1:8786', 'not tcp://HOST:PORT'),
    ('none.json', 'No such file'),
  ],
)
def test_a_scheduler_that_is_not_there_is_refused(
  scheduler: str, said: str
) -> None:
  with pytest.raises(
    cluster.ClusterError,
    match=rf'`scheduler` must be the address of .*{scheduler}: .*{said}',
  ):
    cluster.find(scheduler)


@needs_dask
@pytest.mark.parametrize('text', ['', '[]', '{}', '{"address": 3}'])
def test_a_file_that_no_scheduler_wrote_is_refused(
  tmp_path: pathlib.Path, text: str
) -> None:
  (tmp_path / 'scheduler.json').write_text(text)
  with pytest.raises(cluster.ClusterError, match='or the file that it wrote'):
    cluster.find(str(tmp_path / 'scheduler.json'))


def test_without_the_extra_the_line_that_mends_it_is_told(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(importlib.util, 'find_spec', lambda name: None)
  with pytest.raises(
    cluster.ClusterError,
    match=r"needs an extra: pip install 'waggle-tasks\[cluster\]'",
  ):
    cluster.find('tcp://127.0.0.1:8786')


# What a worker refuses before it flies anything.


def _work(digest: str, versions: dict[str, str]) -> object:
  job = pool.Job('a', lambda report, value: value, (3,))
  return cluster._work(job, (digest, versions))


@pytest.fixture
def digest() -> str:
  return provenance.source_digest(provenance.source_hashes())


def test_a_worker_of_the_same_sources_works(digest: str) -> None:
  assert _work(digest, provenance.versions()) == 3


def test_a_worker_of_other_sources_is_refused(digest: str) -> None:
  with pytest.raises(cluster.ClusterError, match='must have the sources of'):
    _work(digest[::-1], provenance.versions())


def test_a_worker_of_other_versions_is_refused(digest: str) -> None:
  versions = provenance.versions() | {'mujoco': '9.9'}
  here = provenance.versions()['mujoco']
  with pytest.raises(
    cluster.ClusterError,
    match=f'must have the versions of the client: mujoco is {here} on .* 9.9',
  ):
    _work(digest, versions)
