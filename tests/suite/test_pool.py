"""Worker processes that die, fall silent or lose their parent."""

from collections.abc import Callable, Iterator
import importlib
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import time
import types

import pytest

from waggle_tasks.experiments.studies import pool

HERE = pathlib.Path(__file__).parent
PARENT = """
import pathlib, sys
sys.path.insert(0, {here!r})
import pool_jobs
from waggle_tasks.experiments.studies import pool

if __name__ == '__main__':
  job = pool.Job('long', pool_jobs.chatter, (pathlib.Path({tries!r}), 60.0))
  quick = pool.Job('quick', pool_jobs.double, (1,))
  try:
    for news in pool.run([job, quick], 2):
      print(news.job.name, type(news).__name__, flush=True)
  except KeyboardInterrupt:
    sys.exit('interrupted')
"""


@pytest.fixture
def jobs(monkeypatch: pytest.MonkeyPatch) -> types.ModuleType:
  """The module of jobs, which workers can import by the same name."""
  monkeypatch.syspath_prepend(HERE)
  return importlib.import_module('pool_jobs')


@pytest.fixture
def parent(
  tmp_path: pathlib.Path, session: Callable[[int], dict[int, str]]
) -> Iterator[subprocess.Popen[str]]:
  """A process, first of its own session, with one busy and one idle worker."""
  text = PARENT.format(here=str(HERE), tries=str(tmp_path / 'tries'))
  script = tmp_path / 'parent.py'
  script.write_text(text, encoding='utf-8')
  process = subprocess.Popen(
    [sys.executable, str(script)],
    stdout=subprocess.PIPE,
    stderr=subprocess.PIPE,
    text=True,
    start_new_session=True,
  )
  awaited = {'quick Done\n', 'long Advance\n'}
  while awaited and (line := process.stdout.readline()):
    awaited.discard(line)
  assert not awaited
  yield process
  for pid in session(process.pid):
    os.kill(pid, signal.SIGKILL)
  process.communicate()


def finished(news: list[pool.Advance | pool.Done]) -> dict[str, object]:
  """What each job returned; every job is done exactly once."""
  done = [each for each in news if isinstance(each, pool.Done)]
  out = {each.job.name: each.value for each in done}
  assert len(out) == len(done)
  return out


def lives(pid: str) -> bool:
  try:
    os.kill(int(pid), 0)
  except ProcessLookupError:
    return False
  return True


def lines(path: pathlib.Path) -> list[str]:
  return path.read_text(encoding='utf-8').splitlines()


@pytest.mark.slow
@pytest.mark.parametrize('workers', [1, 2, 5])
def test_every_job_is_done_once_and_reports_before_it_is_done(
  jobs: types.ModuleType, workers: int
) -> None:
  todo = [pool.Job(f'job-{k}', jobs.double, (k,)) for k in range(4)]
  news = list(pool.run(todo, workers))
  assert finished(news) == {f'job-{k}': 2 * k for k in range(4)}
  for job in todo:
    first, second, last = [each for each in news if each.job is job]
    assert (first.amount, second.amount) == (0.25, 0.75)
    assert isinstance(last, pool.Done)
  assert not multiprocessing.active_children()


@pytest.mark.slow
def test_one_worker_does_jobs_in_their_order(jobs: types.ModuleType) -> None:
  todo = [pool.Job(name, jobs.double, (1,)) for name in 'cab']
  assert [*finished(list(pool.run(todo, 1)))] == ['c', 'a', 'b']


def test_nothing_to_do_is_done_at_once() -> None:
  assert list(pool.run([], 2)) == []


@pytest.mark.slow
def test_a_worker_that_dies_is_replaced_and_its_job_tried_again(
  jobs: types.ModuleType, tmp_path: pathlib.Path
) -> None:
  tries = tmp_path / 'tries'
  todo = [
    pool.Job('unlucky', jobs.die, (tries, 1)),
    *(pool.Job(f'other-{k}', jobs.double, (k,)) for k in range(3)),
  ]
  done = finished(list(pool.run(todo, 2)))
  assert done == {'unlucky': 'alive', 'other-0': 0, 'other-1': 2, 'other-2': 4}
  first, second = lines(tries)
  assert first != second


@pytest.mark.slow
def test_a_job_that_kills_every_worker_is_given_up_by_name(
  jobs: types.ModuleType, tmp_path: pathlib.Path
) -> None:
  todo = [pool.Job('deadly', jobs.die, (tmp_path / 'tries', 9))]
  with pytest.raises(
    pool.WorkerError,
    match=r'^deadly failed 2 times, at last: its process was ended by SIGKILL$',
  ):
    list(pool.run(todo, 1))
  assert len(lines(tmp_path / 'tries')) == 2
  assert not multiprocessing.active_children()


@pytest.mark.slow
@pytest.mark.parametrize('torn', [False, True])
def test_a_worker_that_leaves_even_within_a_message_is_told_by_name(
  torn: bool, jobs: types.ModuleType
) -> None:
  todo = [pool.Job('gone', jobs.leave, (torn,))]
  with pytest.raises(
    pool.WorkerError, match=r'^gone failed 2 times, at last: its process died$'
  ):
    list(pool.run(todo, 1))
  assert not multiprocessing.active_children()


@pytest.mark.slow
def test_a_job_that_raises_is_given_up_with_its_reason(
  jobs: types.ModuleType,
) -> None:
  todo = [pool.Job('bad', jobs.fail, ()), pool.Job('good', jobs.double, (1,))]
  error = r'(?s)^bad failed 2 times, at last: .*ValueError: no such luck'
  with pytest.raises(pool.WorkerError, match=error):
    list(pool.run(todo, 2))
  assert not multiprocessing.active_children()


@pytest.mark.slow
def test_a_silent_worker_is_replaced_and_a_busy_one_is_not(
  jobs: types.ModuleType, tmp_path: pathlib.Path
) -> None:
  hung, busy = tmp_path / 'hung', tmp_path / 'busy'
  todo = [
    pool.Job('hung', jobs.hang, (hung, 1)),
    pool.Job('busy', jobs.chatter, (busy, 4.5)),
  ]
  done = finished(list(pool.run(todo, 2, silence_s=3.0)))
  assert done == {'hung': 'awake', 'busy': 'done'}
  first, _ = lines(hung)
  assert not lives(first)
  assert len(lines(busy)) == 1


@pytest.mark.slow
def test_a_job_that_always_hangs_is_given_up_with_its_reason(
  jobs: types.ModuleType, tmp_path: pathlib.Path
) -> None:
  todo = [pool.Job('hung', jobs.hang, (tmp_path / 'tries', 9))]
  with pytest.raises(
    pool.WorkerError,
    match=r'^hung failed 2 times, at last: no sign of life for 0.5 s$',
  ):
    list(pool.run(todo, 1, silence_s=0.5))
  assert not multiprocessing.active_children()


@pytest.mark.slow
def test_an_error_of_who_listens_ends_the_workers(
  jobs: types.ModuleType, tmp_path: pathlib.Path
) -> None:
  todo = [
    pool.Job(name, jobs.chatter, (tmp_path / name, 60.0)) for name in 'ab'
  ]

  def listen() -> None:
    for _ in pool.run(todo, 2):
      if len(list(tmp_path.iterdir())) == 2:
        raise KeyError('full disk')

  with pytest.raises(KeyError, match='full disk'):
    listen()
  assert not multiprocessing.active_children()
  for name in 'ab':
    (pid,) = lines(tmp_path / name)
    assert not lives(pid)


def test_workers_end_when_their_parent_is_killed(
  parent: subprocess.Popen[str],
  session: Callable[[int], dict[int, str]],
  wait_until: Callable[..., None],
) -> None:
  words = session(parent.pid).values()
  assert sum('spawn_main' in each for each in words) == 2
  os.kill(parent.pid, signal.SIGKILL)
  wait_until(lambda: not session(parent.pid), 15)


def test_ctrl_c_ends_all_without_a_word_from_the_workers(
  parent: subprocess.Popen[str], session: Callable[[int], dict[int, str]]
) -> None:
  os.killpg(parent.pid, signal.SIGINT)  # As a terminal does.
  _, said = parent.communicate(timeout=30)
  assert said == 'interrupted\n'
  deadline_s = time.monotonic() + 10
  while session(parent.pid) and time.monotonic() < deadline_s:
    time.sleep(0.1)  # The last to go is Python's own resource tracker.
  assert not session(parent.pid)
