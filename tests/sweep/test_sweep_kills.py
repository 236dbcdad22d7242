"""A sweep ended at any moment goes on, and ends with the same bytes."""

from collections.abc import Callable, Iterator
import os
import pathlib
import signal
import subprocess
import sys

import pytest

from waggle_tasks.experiments.record import journal

Launched = subprocess.Popen[bytes]
Session = Callable[[int], dict[int, str]]
FLAGS = (
  '--grid=distance_m=0.8,1.3', '--grid=bearing_deg=0,40', '--control=no_send',
  '--duration_s=1', '--observers=1', '--receiver=view_bank',
)  # fmt: skip


def command(folder: pathlib.Path, workers: int) -> list[str]:
  module = 'waggle_tasks.experiments.sweep'
  given = [*FLAGS, f'--output={folder}', f'--workers={workers}']
  return [sys.executable, '-m', module, *given]


@pytest.fixture(params=[pytest.param(1, marks=pytest.mark.long), 2])
def launched(
  request: pytest.FixtureRequest, sweep: object, session: Session
) -> Iterator[Launched]:
  """`waggle sweep` on its way, first of its own session."""
  with (sweep.folder.parent / 'said').open('wb') as said:
    process = subprocess.Popen(
      command(sweep.folder, request.param),
      stdout=said,
      stderr=said,
      start_new_session=True,
    )
  yield process
  for pid in session(process.pid):
    os.kill(pid, signal.SIGKILL)
  process.wait()


def tables(sweep: object) -> dict[str, bytes]:
  names = ('results.jsonl', 'results.csv')
  return {name: (sweep.folder / name).read_bytes() for name in names}


@pytest.mark.slow
def test_a_killed_sweep_ends_as_if_it_had_not_been(
  launched: Launched,
  sweep: object,
  flown: object,
  session: Session,
  wait_until: Callable[..., None],
) -> None:
  wait_until(lambda: journal.read(sweep.journal))
  os.kill(launched.pid, signal.SIGKILL)
  launched.wait()
  wait_until(lambda: not session(launched.pid), 15)  # No worker outlives it.
  kept = journal.read(sweep.journal)
  assert 1 <= len(kept) < 4
  assert not (sweep.folder / 'results.jsonl').exists()
  done = subprocess.run(
    command(sweep.folder, 1), capture_output=True, check=False
  )
  assert done.returncode == 0, done.stderr.decode()
  assert journal.read(sweep.journal)[: len(kept)] == kept
  assert len(journal.read(sweep.journal)) == 4
  assert tables(sweep) == tables(flown)


@pytest.mark.long
def test_a_killed_worker_leaves_no_trace_in_the_results(
  launched: Launched,
  sweep: object,
  flown: object,
  session: Session,
  wait_until: Callable[..., None],
  tmp_path: pathlib.Path,
) -> None:
  wait_until(lambda: journal.read(sweep.journal))
  pids = session(launched.pid).items()
  worker = next(pid for pid, words in pids if 'spawn_main' in words)
  os.kill(worker, signal.SIGKILL)
  assert launched.wait(timeout=120) == 0, (tmp_path / 'said').read_text()
  assert tables(sweep) == tables(flown)
