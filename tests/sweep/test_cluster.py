"""Sweeps on a Dask cluster: a real scheduler and two real workers."""

from collections.abc import Callable, Iterator
from concurrent import futures
import contextlib
import importlib.util
import json
import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading
import types
from unittest import mock

import pytest

from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.studies import cluster, dask_probe, pool


def _ipv6() -> bool:
  with contextlib.suppress(OSError):
    socket.create_server(('::1', 0), family=socket.AF_INET6).close()
    return True
  return False


needs_dask = pytest.mark.skipif(
  importlib.util.find_spec('distributed') is None,
  reason="needs the extra [cluster]: pip install 'waggle-tasks[cluster]'",
)
IPV6 = _ipv6()
needs_ipv6 = pytest.mark.skipif(not IPV6, reason='needs IPv6')
# Dask warns of much; a process of its own keeps its threads and logs apart.
FLY = """
import functools, pathlib, sys
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.studies import (
  cluster, runner, sweep_cases, sweep_study)
receiver, folder, scheduler, *grid = sys.argv[1:]
base = scenario_fields.defaults() | {
  'control': 'no_send', 'duration_s': 1.0, 'observers': 1}
engine = functools.partial(cluster.run, place=cluster.find(scheduler))
cases = sweep_cases.cases(sweep_cases.grid(grid), base, 1)
runner.run(
  sweep_study.Sweep(cases, receiver), pathlib.Path(folder), engine,
  'waggle sweep')
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


def listening(path: pathlib.Path, wait_until: Callable[..., None]) -> str:
  """The address in a scheduler's file, which is empty for a moment."""
  found = []

  def read() -> list[str]:
    with contextlib.suppress(OSError, ValueError):
      found.append(json.loads(path.read_text())['address'])
    return found

  wait_until(read)
  return found[0]


@pytest.mark.slow
@needs_dask
def test_a_cluster_gives_the_same_bytes_as_one_worker(
  scheduler: pathlib.Path,
  sweep: object,
  flown: object,
  wait_until: Callable[..., None],
) -> None:
  address = listening(scheduler, wait_until)
  done = fly('view_bank', str(sweep.folder), address, *sweep.grid)
  assert done.returncode == 0, done.stderr
  assert sweep.results() == flown.results()


def fly(*words: str, **more: object) -> subprocess.CompletedProcess[str]:
  """Runs `FLY`."""
  return subprocess.run(
    [sys.executable, '-c', FLY, *words],
    capture_output=True, text=True, check=False, **more,
  )  # fmt: skip


@pytest.mark.long
@needs_dask
def test_a_suite_leaves_the_same_run_folders_from_a_cluster(
  scheduler: pathlib.Path,
  waggle: Callable[..., subprocess.CompletedProcess[str]],
  tmp_path: pathlib.Path,
  wait_until: Callable[..., None],
) -> None:
  address = listening(scheduler, wait_until)
  case = {'name': 'still', 'task': 'no_send', 'duration_s': 0.2}
  (tmp_path / 'own.json').write_text(json.dumps([case]))
  left = []
  for engine in ('--workers=1', f'--scheduler={address}'):
    done = waggle('suite', '--suite=own.json', engine, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    folder = (tmp_path / 'runs' / 'own-klt').rename(tmp_path / f'{len(left)}')
    left.append(
      {
        path.relative_to(folder): path.read_bytes()
        for path in folder.rglob('*')
        # They hold the wall clock, or the name of their folder.
        if path.is_file() and path.name not in ('provenance.json', 'seal.json')
        if path != folder / 'index.html'
      }
    )
  assert f'with the cluster of {address}' in done.stdout
  assert left[0] == left[1]
  assert pathlib.Path('cases', 'still', 'events.jsonl') in left[1]


OWN = """
from waggle_tasks.agents import receiver

class Own(receiver.Receiver):
  def step(self, image, time_s):
    return ()
"""


@pytest.mark.slow
@needs_dask
def test_workers_import_a_receiver_of_ones_own_by_its_name(
  dask: Callable[..., object],
  scheduler: pathlib.Path,
  tmp_path: pathlib.Path,
  wait_until: Callable[..., None],
) -> None:
  address = listening(scheduler, wait_until)
  (dask.here / 'own_on_cluster.py').write_text(OWN)  # Where workers run.
  words = str(tmp_path / 'out'), address, 'distance_m=1.3'
  done = fly('own_on_cluster:Own', *words, cwd=dask.here)
  assert done.returncode == 0, done.stderr
  (row,) = (tmp_path / 'out' / 'results.jsonl').read_text().splitlines()
  assert json.loads(row)['receiver'] == 'own_on_cluster:Own'


@pytest.mark.slow
@needs_dask
@pytest.mark.parametrize(
  ('scheduler', 'said'),
  [
    ('tcp://127.0.0.1:1', 'Connection refused'),
    ('127.0.0.1:8786', 'not tcp://HOST:PORT'),
    ('none.json', 'No such file'),
    ('tls://127.0.0.1:8786', 'not tcp://HOST:PORT'),
    ('tcp://::1:8786', r'nor tcp://\[IPV6\]:PORT'),
    ('tcp://127.0.0.1:65537', 'not tcp://HOST:PORT'),
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
@pytest.mark.parametrize(
  ('text', 'said'),
  [
    (b'', 'it is empty: its scheduler has not begun to listen yet'),
    (b'{"address": "tcp:', 'it is no JSON: '),
    (b'\xff\xfe', 'can.t decode byte'),
    (b'[]', 'it holds no address'),
    (b'{}', 'it holds no address'),
    (b'{"address": 3}', 'it holds no address'),
    (b'{"address": "inproc://1"}', 'not tcp://HOST:PORT'),
  ],
)
@pytest.mark.parametrize('name', ['scheduler.json', 'scheduler'])
def test_a_file_that_no_scheduler_wrote_is_refused(
  name: str, text: bytes, said: str, tmp_path: pathlib.Path
) -> None:
  (tmp_path / name).write_bytes(text)
  with pytest.raises(
    cluster.ClusterError, match=f'or the file that it wrote: .*{name}: .*{said}'
  ):
    cluster.find(str(tmp_path / name))


@contextlib.contextmanager
def listens(
  answer: bytes | None, family: socket.AddressFamily = socket.AF_INET
) -> Iterator[str]:
  """The address of a server that is no scheduler.

  Args:
    answer: What it says to everybody; None to hang up.
    family: IPv4 or IPv6.
  """
  host = '::1' if family == socket.AF_INET6 else '127.0.0.1'
  server = socket.create_server((host, 0), family=family)
  links = []

  def serve() -> None:
    while True:
      try:
        link, _ = server.accept()
      except OSError:
        return
      links.append(link)
      if answer is None:
        link.close()
      else:
        link.sendall(answer)

  thread = threading.Thread(target=serve)
  thread.start()
  named = f'[{host}]' if ':' in host else host
  try:
    yield f'tcp://{named}:{server.getsockname()[1]}'
  finally:
    server.shutdown(socket.SHUT_RDWR)
    thread.join()
    for each in (server, *links):
      each.close()


@pytest.mark.slow
@needs_dask
@pytest.mark.parametrize(
  ('answer', 'said'),
  [
    (b'', 'answers nothing within 0.5 s'),
    (None, 'what listens there '),
    (b'SSH-2.0-OpenSSH_9.2\r\n', 'what listens there is no scheduler: '),
    (b'HTTP/1.1 400 Bad Request\r\n\r\n', 'there is no scheduler: '),
  ],
)
def test_a_port_of_something_else_is_refused_within_the_limit(
  answer: bytes | None, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(cluster, '_CONNECT_S', 0.5)
  with (
    listens(answer) as address,
    pytest.raises(cluster.ClusterError, match=said),
  ):
    cluster.find(address)


@needs_dask
@pytest.mark.parametrize(
  'family', [socket.AF_INET, pytest.param(socket.AF_INET6, marks=needs_ipv6)]
)
def test_a_scheduler_of_another_version_is_refused(
  family: socket.AddressFamily, monkeypatch: pytest.MonkeyPatch
) -> None:
  theirs = {'packages': {'dask': '1.2', 'distributed': '1.2'}}
  monkeypatch.setattr(dask_probe, 'ask', lambda address, limit_s: theirs)
  with (
    listens(b'', family) as address,
    pytest.raises(
      cluster.ClusterError,
      match=rf'of this command: dask is 1.2 at {re.escape(address)}, not 2',
    ),
  ):
    cluster.find(address)


@needs_dask
def test_a_scheduler_that_gets_no_workers_is_refused(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(dask_probe, 'ask', lambda place, limit_s: {'workers': {}})
  monkeypatch.setattr(cluster, '_WORKERS_S', 0.1)
  with pytest.raises(
    cluster.ClusterError,
    match=r'must have workers: tcp://a:1 had none for 0\.1 s',
  ):
    list(cluster.run([pool.Job('a', print, ())], 'tcp://a:1'))


@needs_dask
@pytest.mark.parametrize('error', [futures.CancelledError(), TimeoutError()])
def test_a_scheduler_that_goes_away_as_a_result_is_fetched_is_told(
  error: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
  fetched = types.SimpleNamespace(
    key='r a', cancelled=lambda: False, exception=lambda limit_s: None
  )
  fetched.result = mock.Mock(side_effect=error)
  fetched.add_done_callback = lambda call: call(fetched)
  client = mock.MagicMock()
  client.return_value.__enter__.return_value.submit.return_value = fetched
  client.return_value.__exit__.return_value = False
  monkeypatch.setattr('distributed.Client', client)
  monkeypatch.setattr(cluster, '_wait_for_workers', lambda place: None)
  monkeypatch.setattr(cluster.uuid, 'uuid4', lambda: mock.Mock(hex='r'))
  with pytest.raises(
    cluster.ClusterError, match=r'went away: tcp://a:1: \w.+ What was flown is'
  ):
    list(cluster.run([pool.Job('a', print, ())], 'tcp://a:1'))


# A cluster that goes away while it works on the second of two jobs.
LOST = """
import os, pathlib, signal, sys, time
from waggle_tasks import errors
from waggle_tasks.experiments.studies import cluster, pool

scheduler, number, pid = sys.argv[1:]
address = cluster.find(scheduler)
cluster._LOOK_S, cluster._CONNECT_S = 0.5, 2.0
sleep = lambda report, s: time.sleep(s)
jobs = [pool.Job(str(s), sleep, (s,)) for s in (0, 60)]
try:
  for done in cluster.run(jobs, address):
    print(done.job.name)
    cluster._WORKERS_S = 1.0
    os.kill(int(pid), int(number))
except errors.WaggleError as error:
  print(error)
"""


@pytest.mark.slow
@needs_dask
@pytest.mark.parametrize(
  ('victim', 'number', 'said'),
  [
    pytest.param(
      'scheduler',
      signal.SIGKILL,
      'the connection to it is lost',
      marks=pytest.mark.long,
    ),
    pytest.param(
      'scheduler',
      signal.SIGSTOP,
      'for 1 s what listens there answers nothing',
      marks=pytest.mark.long,
    ),
    ('worker', signal.SIGKILL, 'for 1 s it has no workers'),
  ],
)
def test_a_cluster_that_goes_away_is_told_in_one_line_with_how_to_go_on(
  victim: str,
  number: int,
  said: str,
  dask: Callable[..., subprocess.Popen[bytes]],
  tmp_path: pathlib.Path,
  wait_until: Callable[..., None],
) -> None:
  path = tmp_path / 'scheduler.json'
  host = '[::1]' if IPV6 else '127.0.0.1'
  parts = {
    'scheduler': dask(
      'scheduler', f'--host={host}', '--port=0', f'--scheduler-file={path}',
      '--no-dashboard',
    ),
    'worker': dask(
      'worker', f'--scheduler-file={path}', '--nthreads=1', '--no-nanny',
      '--no-dashboard',
    ),
  }  # fmt: skip
  address = listening(path, wait_until)
  done = subprocess.run(
    [
      sys.executable, '-c', LOST, str(path), str(int(number)),
      str(parts[victim].pid),
    ],
    capture_output=True, text=True, timeout=100, check=False,
  )  # fmt: skip
  for part in parts.values():
    part.kill()
  assert done.stderr == ''
  first, line = done.stdout.splitlines()
  assert first == '0'
  assert line.startswith(f'`scheduler` went away: {address}: {said}')
  assert line.endswith(
    'What was flown is kept: when it runs again, the same command goes on with'
    ' the rest'
  )


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


def _work(
  digest: str, versions: dict[str, str], *modules: tuple[str, str]
) -> object:
  job = pool.Job('a', lambda report, value: value, (3,), modules)
  return cluster._work(job, (digest, versions))


def test_what_a_job_leaves_in_its_folder_comes_with_its_result(
  tmp_path: pathlib.Path,
) -> None:
  def work(report: object, text: str, draft: pathlib.Path) -> None:
    draft.mkdir()
    (draft / 'said').write_text(text)

  job = pool.Job('a', work, ('hello',), draft=tmp_path / 'a')
  assert cluster._done(job) == (None, {'said': b'hello'})
  assert not (tmp_path / 'a').exists()


@pytest.fixture
def digest() -> str:
  return provenance.source_digest(provenance.source_hashes())


def test_a_worker_of_the_same_sources_works(digest: str) -> None:
  assert _work(digest, provenance.versions()) == (3, {})


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


@pytest.mark.long
def test_a_worker_of_another_receiver_is_refused(
  digest: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.syspath_prepend(tmp_path)
  path = tmp_path / 'kept_receiver.py'

  def work() -> object:
    files = outside.modules({'kept_receiver': path})
    return _work(digest, provenance.versions(), *files.items())

  error = 'must have the modules of the client: kept_receiver is missing on'
  path.write_text('# first')
  assert work() == (3, {})
  path.write_text('# edited, but the worker still has what it imported')
  with pytest.raises(cluster.ClusterError, match=error):
    work()
  with pytest.raises(cluster.ClusterError, match='nowhere is missing on'):
    _work(digest, provenance.versions(), ('nowhere', 'a'))
