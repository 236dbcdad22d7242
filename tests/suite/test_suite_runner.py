"""What a suite leaves behind, and what the next call makes of it."""

from collections.abc import Iterator
import csv
import dataclasses
import fcntl
import json
import pathlib
import re
import shutil
import time

import pytest

from waggle_tasks import suites
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.record import folders, provenance
from waggle_tasks.experiments.studies import case_rows, pool, suite_case

FILES = {
  'config.json', 'events.jsonl', 'result.json', 'provenance.json', 'seal.json',
  'index.html', 'traces.npz', 'positions.npz',
}  # fmt: skip


def test_every_case_leaves_its_files_and_its_line(reference: object) -> None:
  folders = {p.name: p for p in (reference.folder / 'cases').iterdir()}
  assert folders.keys() == {'silent', 'pair', 'dance'}
  for folder in folders.values():
    assert {path.name for path in folder.iterdir()} == FILES
  rows = reference.lines()
  assert [row['case'] for row in rows] == ['silent', 'pair', 'dance']
  assert [row['passed'] for row in rows] == [True, True, False]
  assert [row['expecting'] for row in rows] == [0, 0, 1]
  assert [row['simulated_s'] for row in rows] == [1.0, 4.0, 9.2]
  assert [len(row['outcomes']) for row in rows] == [1, 2, 1]
  assert all(row['published'] is None for row in rows)
  assert not (reference.folder / '.drafts').exists()


def test_the_rows_returned_are_the_lines_of_the_file(finished: object) -> None:
  assert [case_rows.table(row) for row in finished.run()] == finished.lines()


def test_the_csv_has_a_line_for_each_observer(reference: object) -> None:
  path = reference.folder / 'results.csv'
  with path.open(encoding='utf-8', newline='') as file:
    lines = list(csv.DictReader(file))
  assert [(each['case'], each['observer']) for each in lines] == [
    ('silent', 'observer_1'), ('pair', 'observer_1'), ('pair', 'observer_2'),
    ('dance', 'observer_1'),
  ]  # fmt: skip
  silent, dance = lines[0], lines[-1]
  assert (silent['group_passed'], silent['failures']) == ('True', '')
  assert (silent['expected'], silent['decoded']) == ('', '')
  assert (dance['group_passed'], dance['expected']) == ('False', '000010')
  assert dance['failures'].startswith('message: none, ')


def test_a_case_says_what_made_it(reference: object) -> None:
  origin = json.loads(
    (reference.home('pair') / 'provenance.json').read_text(encoding='utf-8')
  )
  assert origin['command'] == f'{reference.command} --case=pair'
  assert origin['sources'] == provenance.source_hashes()
  assert origin['versions'] == provenance.versions()
  assert origin['renderer']
  assert origin['began'] <= origin['ended']
  name = 'waggle_tasks.experiments.studies.runner'
  assert re.fullmatch('[0-9a-f]{64}', origin['sources'][name])


def test_a_second_run_flies_nothing_and_changes_nothing(
  finished: object, capsys: pytest.CaptureFixture[str]
) -> None:
  results, written = finished.results(), finished.written()
  finished.run()
  assert finished.results() == results
  assert finished.written() == written
  assert 'anew' not in capsys.readouterr().out


@pytest.mark.slow
def test_serial_and_parallel_runs_give_the_same_bytes(
  reference: object, fresh: object
) -> None:
  fresh.run(workers=2)
  assert fresh.results() == reference.results()


@pytest.mark.slow
def test_a_part_of_the_suite_is_kept_by_the_whole(
  reference: object, fresh: object
) -> None:
  dataclasses.replace(fresh, rows=fresh.rows[:1]).run()
  before = fresh.written()
  fresh.run()
  assert fresh.results() == reference.results()
  assert fresh.written().items() >= before.items()


# Folders that cannot be used.


def test_a_folder_that_is_being_written_is_refused(blink: object) -> None:
  before = blink.results()
  with (blink.folder / '.lock').open('w') as lock:
    fcntl.flock(lock, fcntl.LOCK_EX)
    with pytest.raises(
      folders.OutputError,
      match=r'`output` must not be in use: another run is writing .*results$',
    ):
      blink.run()
  assert blink.results() == before


@pytest.mark.parametrize('name', ['notes.txt', 'config.json', '.git'])
def test_a_folder_with_other_things_is_refused_and_left_alone(
  fresh_blink: object, name: str
) -> None:
  folder = fresh_blink.folder
  folder.mkdir()
  (folder / name).write_text('mine')
  error = f'`output` must be new or hold results of a suite: {folder} holds'
  with pytest.raises(folders.OutputError, match=re.escape(f'{error} {name}')):
    fresh_blink.run()
  assert [path.name for path in folder.iterdir()] == [name]


def test_a_file_in_the_place_of_the_folder_is_refused(
  fresh_blink: object,
) -> None:
  fresh_blink.folder.write_text('mine')
  with pytest.raises(folders.OutputError, match='`output` must be writable: '):
    fresh_blink.run()
  assert fresh_blink.folder.read_text() == 'mine'


# The progress bar.


@pytest.mark.slow
def test_a_case_reports_exactly_the_frames_that_it_simulates(
  tmp_path: pathlib.Path, reference: object
) -> None:
  # Half of the time between two reports, and twice that time.
  jobs = [
    pool.Job(
      case.name, suite_case.fly,
      (case, 'klt', 'identity', reference.command, run_page.leave),
      draft=tmp_path / case.name,
    )
    for case in suites.from_rows(reference.rows[:2])
  ]  # fmt: skip
  told = {}
  for news in pool.run(jobs, 1):
    if isinstance(news, pool.Advance):
      told[news.job.name] = news.amount
  assert told == pytest.approx({'silent': 1.0, 'pair': 4.0})


@pytest.mark.slow
def test_a_case_that_is_tried_again_does_not_upset_the_bar(
  fresh_blink: object,
  blink_reference: object,
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  drafts = fresh_blink.folder / '.drafts'

  def retry(
    jobs: list[pool.Job], workers: int
  ) -> Iterator[pool.Advance | pool.Done]:
    del workers
    (job,) = jobs
    for _ in range(3):  # Two workers died near the end.
      time.sleep(0.6)  # So long that the bar is drawn.
      yield pool.Advance(job, 1.0)
    shutil.copytree(blink_reference.home('blink'), drafts / 'blink')
    yield pool.Done(job, None)

  monkeypatch.setattr(pool, 'run', retry)
  fresh_blink.run()
  assert fresh_blink.results() == blink_reference.results()


@pytest.mark.slow
def test_the_bar_names_the_case_and_ends_with_all_seconds(
  fresh: object, capsys: pytest.CaptureFixture[str]
) -> None:
  dataclasses.replace(fresh, rows=fresh.rows[1:]).run(workers=1)
  err = capsys.readouterr().err
  assert 'dance' in err
  assert '13/13 s simulated' in err.splitlines()[-1]
