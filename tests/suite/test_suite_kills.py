"""A suite ended at any moment goes on, and ends with the same bytes."""

from collections.abc import Callable, Iterator
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys

import pytest

from waggle_tasks.experiments.record import folders
from waggle_tasks.experiments.studies import pool

Launched = subprocess.Popen[bytes]
Session = Callable[[int], dict[int, str]]


@pytest.fixture
def launched(fresh: object, session: Session) -> Iterator[Launched]:
  """`waggle suite` on its way in a process, first of its own session."""
  here = fresh.folder.parent
  (here / 'own.json').write_text(json.dumps(fresh.rows), encoding='utf-8')
  module = 'waggle_tasks.experiments.suite'
  flags = ['--suite=own.json', f'--output={fresh.folder}', '--workers=1']
  with (here / 'said').open('wb') as said:
    process = subprocess.Popen(
      [sys.executable, '-m', module, *flags],
      stdout=said,
      stderr=said,
      cwd=here,
      start_new_session=True,
    )
  yield process
  for pid in session(process.pid):
    os.kill(pid, signal.SIGKILL)
  process.wait()


@pytest.mark.long
def test_a_worker_killed_in_mid_case_leaves_no_trace_in_the_results(
  launched: Launched,
  fresh: object,
  reference: object,
  session: Session,
  wait_until: Callable[..., None],
  tmp_path: pathlib.Path,
) -> None:
  wait_until((fresh.folder / '.drafts' / 'dance').exists)
  pids = session(launched.pid).items()
  (worker,) = [pid for pid, words in pids if 'spawn_main' in words]
  os.kill(worker, signal.SIGKILL)
  assert not fresh.home('dance').exists()
  # 1: the dance is cut short, so that its observer fails.
  said = tmp_path / 'said'
  assert launched.wait(timeout=120) == 1, said.read_text(encoding='utf-8')
  assert fresh.results() == reference.results()


@pytest.mark.parametrize(
  'number',
  [signal.SIGTERM, signal.SIGHUP],
)
@pytest.mark.long
def test_a_suite_that_is_asked_to_end_leaves_no_drafts(
  launched: Launched,
  fresh: object,
  session: Session,
  wait_until: Callable[..., None],
  number: signal.Signals,
) -> None:
  wait_until((fresh.folder / '.drafts' / 'dance').exists)
  os.kill(launched.pid, number)
  assert launched.wait(timeout=60) == 130
  wait_until(lambda: not session(launched.pid), 15)
  left = {path.name for path in fresh.folder.iterdir()}
  assert left == {'.lock', 'cases'}


@pytest.mark.slow
def test_a_suite_killed_in_its_middle_ends_as_if_it_had_not_been(
  launched: Launched,
  fresh: object,
  reference: object,
  session: Session,
  wait_until: Callable[..., None],
) -> None:
  wait_until((fresh.folder / '.drafts' / 'pair').exists)
  os.kill(launched.pid, signal.SIGKILL)
  launched.wait()
  wait_until(lambda: not session(launched.pid), 15)  # No worker outlives it.
  assert fresh.home('dance').exists()
  assert not fresh.home('pair').exists()
  assert not (fresh.folder / 'results.jsonl').exists()
  before = fresh.written()
  fresh.run()
  assert fresh.results() == reference.results()
  assert fresh.written().items() >= before.items()


@pytest.mark.parametrize(
  'name', ['.results.jsonl.draft', '.results.csv.draft', '.index.html.draft']
)
def test_a_suite_killed_while_it_wrote_a_table_goes_on(
  finished: object, reference: object, name: str
) -> None:
  (finished.folder / 'results.jsonl').unlink()
  (finished.folder / name).write_text('half a li')
  finished.run()
  assert (finished.folder / 'results.jsonl').exists()
  drafts = finished.results().keys() - reference.results().keys()
  assert drafts <= {name}


@pytest.fixture
def file_limit(
  monkeypatch: pytest.MonkeyPatch,
) -> Iterator[Callable[[int | None], None]]:
  """Makes a disk that is full after so many bytes of a file.

  A write beyond them fails half-way, in this process and in its workers.
  """
  monkeypatch.setenv('MESA_SHADER_CACHE_DISABLE', 'true')  # Others need it.
  soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)

  def limit(size: int | None) -> None:
    new = soft if size is None else size
    resource.setrlimit(resource.RLIMIT_FSIZE, (new, hard))

  yield limit
  limit(None)


@pytest.mark.slow
def test_a_disk_full_in_a_case_is_one_line_and_the_next_run_ends_well(
  fresh_blink: object,
  blink_reference: object,
  file_limit: Callable[[int | None], None],
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  flown, started = [], pool._give
  monkeypatch.setattr(
    pool, '_give', lambda *given: (flown.append(given[1]), started(*given))
  )
  file_limit(8192)  # Less than a provenance.json.
  error = r'^`output` must be writable: blink could not be .*too large; .*kept$'
  with pytest.raises(folders.OutputError, match=error):
    fresh_blink.run(workers=1)
  file_limit(None)
  assert len(flown) == 1  # Another flight would not make room.
  assert not [*(fresh_blink.folder / 'cases').iterdir()]
  assert not (fresh_blink.folder / '.drafts').exists()
  assert not (fresh_blink.folder / 'results.jsonl').exists()
  fresh_blink.run()
  assert fresh_blink.results() == blink_reference.results()


@pytest.mark.parametrize('size', [0, 2048])
def test_a_disk_full_at_the_end_leaves_no_half_table_and_the_next_run_ends_well(
  finished: object,
  reference: object,
  file_limit: Callable[[int | None], None],
  size: int,
) -> None:
  for name in ('results.jsonl', 'results.csv'):
    (finished.folder / name).unlink()
  file_limit(size)  # Less than the lines of three cases.
  with pytest.raises(folders.OutputError, match=r'must be writable.*too large'):
    finished.run()
  file_limit(None)
  assert not (finished.folder / 'results.jsonl').exists()
  finished.run()
  assert finished.results() == reference.results()
