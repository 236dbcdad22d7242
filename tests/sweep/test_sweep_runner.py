"""What a sweep leaves behind, and what the next call makes of it."""

from collections.abc import Iterator, Sequence
import csv
import dataclasses
import json
import pathlib
import re

import pytest

from waggle_tasks import errors
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  folders,
  journal,
  provenance,
  scenario_fields,
)
from waggle_tasks.experiments.results import envelope, sweep_tables
from waggle_tasks.experiments.studies import case_rows, pool

Jobs = Sequence[pool.Job]


class Ended(Exception):  # noqa: N818
  """Something that ends a sweep."""


def ending(after: int, engine: pool.Engine) -> pool.Engine:
  """An engine that ends after so many cases."""

  def run(jobs: Jobs) -> Iterator[pool.Done]:
    for number, done in enumerate(engine(jobs)):
      if number == after:
        raise Ended
      yield done

  return run


@pytest.fixture
def engine(make: object) -> pool.Engine:
  """Flies nothing: every case ends well."""

  def run(jobs: Jobs) -> Iterator[pool.Done]:
    for job in jobs:
      case, _, identity, _ = job.arguments
      yield pool.Done(job, make.row(case, make.well, identity))

  return run


def test_a_sweep_leaves_its_results_and_no_run_folders(flown: object) -> None:
  assert {path.name for path in flown.folder.iterdir()} == {
    '.lock', 'journal.jsonl', 'results.jsonl', 'results.csv', 'provenance.json',
  }  # fmt: skip
  rows = case_rows.read_sweep(flown.folder)
  assert [row.case for row in rows] == [
    'distance_m=0.8 bearing_deg=0.0 #0', 'distance_m=0.8 bearing_deg=40.0 #0',
    'distance_m=1.3 bearing_deg=0.0 #0', 'distance_m=1.3 bearing_deg=40.0 #0',
  ]  # fmt: skip
  for row, case in zip(rows, flown.cases, strict=True):
    assert row.cell == case.cell
    assert row.scenario == case.values
    assert scenario_fields.make(row.scenario) == case.scene
    assert row.receiver == 'view_bank'
    assert row.simulated_s == 1.0
    assert re.fullmatch('[0-9a-f]{64}', row.identity)
    (outcome,) = row.outcomes
    assert outcome.true_distance_m == case.cell['distance_m']
    assert outcome.true_angle_deg == case.cell['bearing_deg']
    assert outcome.right
    assert not outcome.wrong
    assert not outcome.unauthorised
    assert (outcome.expected, outcome.decoded) == (None, None)


def test_the_csv_has_every_field_of_the_scenario(flown: object) -> None:
  text = (flown.folder / 'results.csv').read_text(encoding='utf-8')
  lines = [*csv.DictReader(text.splitlines())]
  assert len(lines) == 4
  for line, case in zip(lines, flown.cases, strict=True):
    for name, value in case.values.items():
      assert line[name] == ('' if value is None else str(value))
    assert line['case'] == case.name
    assert line['observer'] == 'observer_1'
    assert line['right'] == 'True'


def test_the_sweep_says_what_made_it(flown: object) -> None:
  origin = archive.read_json(flown.folder / 'provenance.json')
  assert origin['command'] == 'waggle sweep'
  assert origin['sources'] == provenance.source_hashes()
  assert origin['versions'] == provenance.versions()
  assert origin['renderer'] == case_rows.read_sweep(flown.folder)[0].renderer
  assert origin['began'] <= origin['ended']


def test_two_workers_give_the_same_bytes(flown: object, sweep: object) -> None:
  sweep.fly(workers=2)
  assert sweep.results() == flown.results()


def test_a_second_run_flies_nothing_and_changes_nothing(told: object) -> None:
  before = {p.name: p.read_bytes() for p in told.folder.iterdir()}
  rows = told.run(ending(0, lambda jobs: [*jobs]))
  assert {p.name: p.read_bytes() for p in told.folder.iterdir()} == before
  assert rows == case_rows.read_sweep(told.folder)


@pytest.mark.parametrize('after', [0, 1, 3])
def test_a_sweep_ended_after_some_cases_goes_on_there(
  sweep: object, told: object, engine: pool.Engine, after: int
) -> None:
  with pytest.raises(Ended):
    sweep.run(ending(after, engine))
  assert len(journal.read(sweep.journal)) == after
  assert not (sweep.folder / 'results.jsonl').exists()
  flown = []

  def noting(jobs: Jobs) -> Iterator[pool.Done]:
    flown.extend(jobs)
    yield from engine(jobs)

  sweep.run(noting)
  assert len(flown) == 4 - after
  assert sweep.results() == told.results()


def test_a_line_torn_by_the_end_is_flown_again(
  sweep: object, told: object, engine: pool.Engine
) -> None:
  with pytest.raises(Ended):
    sweep.run(ending(3, engine))
  sweep.journal.write_bytes(sweep.journal.read_bytes()[:-40])
  sweep.run()
  assert sweep.results() == told.results()
  assert len(journal.read(sweep.journal)) == 4


def test_tables_that_were_touched_are_written_again(
  sweep: object, told: object
) -> None:
  sweep.run()
  for name in ('results.jsonl', 'results.csv'):
    (sweep.folder / name).write_text('half a li')
    (sweep.folder / f'.{name}.draft').write_text('half a li')
  sweep.run()
  assert sweep.results() == told.results()


def test_more_repeats_keep_what_was_flown(
  sweep: object, engine: pool.Engine
) -> None:
  sweep.run()
  more = dataclasses.replace(sweep, repeats=3)
  flown = []

  def noting(jobs: Jobs) -> Iterator[pool.Done]:
    flown.extend(job.name for job in jobs)
    yield from engine(jobs)

  rows = more.run(noting)
  assert len(rows) == 12
  assert len(flown) == 8
  # A whole repeat of every cell comes before the next.
  assert [name[-1] for name in flown] == ['1'] * 4 + ['2'] * 4


def test_results_of_other_sources_are_flown_anew(
  sweep: object, engine: pool.Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
  sweep.run()
  here = provenance.deciding_hashes()
  monkeypatch.setattr(provenance, 'deciding_hashes', lambda: here | {'x': '0'})
  with pytest.raises(Ended):
    sweep.run(ending(2, engine))
  assert len(journal.read(sweep.journal)) == 4 + 2


def test_sources_that_change_meanwhile_are_refused(
  sweep: object, monkeypatch: pytest.MonkeyPatch
) -> None:
  here = provenance.deciding_hashes()
  seen = [here, here | {'x': '0'}]
  monkeypatch.setattr(provenance, 'deciding_hashes', lambda: seen.pop(0))
  error = 'sources must not change while a sweep runs: run it again'
  with pytest.raises(provenance.SourceError, match=error):
    sweep.run()
  assert not (sweep.folder / 'results.jsonl').exists()


def test_a_folder_of_something_else_is_refused(sweep: object) -> None:
  sweep.folder.mkdir()
  (sweep.folder / 'cases').mkdir()
  error = 'new or hold results of a sweep: .* holds cases'
  with pytest.raises(folders.OutputError, match=error):
    sweep.run()


def test_the_bar_counts_cases_and_seconds(
  sweep: object,
  engine: pool.Engine,
  capsys: pytest.CaptureFixture[str],
) -> None:
  with pytest.raises(Ended):
    sweep.run(ending(1, engine))
  capsys.readouterr()
  sweep.run()
  said = capsys.readouterr().err
  assert '4/4 cases' in said
  assert '3/3 s simulated' in said


# Reading results back.


def test_an_unfinished_sweep_is_read_from_its_journal(
  sweep: object, engine: pool.Engine
) -> None:
  with pytest.raises(Ended):
    sweep.run(ending(2, engine))
  assert len(case_rows.read_sweep(sweep.folder)) == 2


@pytest.mark.parametrize(
  ('text', 'error'),
  [
    (None, 'holds no results of a sweep'),
    ('', 'holds no results of a sweep'),
    ('{"case": ', 'cannot be read'),
    ('3', 'line 1, is damaged: `row` must be a table of SweepRow: got 3'),
    (json.dumps({'case': 'a', 'group': 'own'}), 'does not know; .*`row.group`'),
    (json.dumps({'case': 'a'}), 'is damaged: `row.cell` must be given'),
  ],
)
def test_what_holds_no_results_is_refused(
  tmp_path: pathlib.Path, text: str | None, error: str
) -> None:
  if text is not None:
    (tmp_path / 'results.jsonl').write_text(text)
  with pytest.raises(archive.ArchiveError, match=error):
    case_rows.read_sweep(tmp_path)


def old(row: case_rows.SweepRow) -> dict[str, object]:
  """A row as a program wrote it that knew less."""
  table = case_rows.table(row)
  del table['scenario']['clock_rate'], table['scenario']['late_frames']
  del table['format']
  return table


def put(folder: pathlib.Path, rows: Sequence[object]) -> pathlib.Path:
  folder.mkdir()
  tables = [
    case_rows.table(row) if isinstance(row, case_rows.SweepRow) else row
    for row in rows
  ]
  text = ''.join(f'{json.dumps(table)}\n' for table in tables)
  (folder / 'results.jsonl').write_text(text)
  return folder


def test_an_old_sweep_and_a_new_one_make_one_map(
  make: object, tmp_path: pathlib.Path
) -> None:
  rows = make.rows('distance_m=0.8,1.3')
  before = put(tmp_path / 'old', [old(row) for row in rows])
  after = make.rows('distance_m=0.8,1.3', clock_rate=0.1)
  both = [
    *case_rows.read_sweep(before),
    *case_rows.read_sweep(put(tmp_path / 'new', after)),
  ]
  assert envelope.factors(both) == ['distance_m', 'clock_rate']
  first = sweep_tables.report(both, None).splitlines()[0]
  assert first.split() == ['distance_m', '\\', 'clock_rate', '0.02', '0.1']


def test_a_scenario_that_is_not_known_is_refused_with_the_field(
  make: object, tmp_path: pathlib.Path
) -> None:
  (row,) = make.rows()
  row.scenario['rain_mm'] = 3.0
  error = 'does not know: a scenario with `rain_mm`'
  with pytest.raises(archive.ArchiveError, match=error):
    case_rows.read_sweep(put(tmp_path / 'new', [row]))


@pytest.mark.parametrize(
  ('change', 'error'),
  [
    (
      {'format': 3, 'wind': 1},
      'line 1, must be 1 to 2 .* got 3',
    ),
    ({'wind': 1}, 'a newer one may have written it: `row.wind` must be one of'),
    ({'outcomes': [{}]}, r'`row.outcomes\[0\].observer` must be given'),
    ({'outcomes': 3}, '`row.outcomes` must be a list: got 3'),
    ({'scenario': 3}, '`row.scenario` must be a table of dict: got 3'),
  ],
)
def test_a_row_of_something_else_says_what_is_wrong(
  make: object, tmp_path: pathlib.Path, change: object, error: str
) -> None:
  (row,) = make.rows()
  with pytest.raises(errors.WaggleError, match=error):
    case_rows.read_sweep(put(tmp_path / 'new', [case_rows.table(row) | change]))


def test_a_journal_of_a_newer_program_is_refused(
  make: object, sweep: object
) -> None:
  sweep.folder.mkdir()
  with journal.opened(sweep.journal) as log:
    log.append(case_rows.table(make.rows()[0]) | {'format': 3})
  error = 'journal.jsonl must be 1 to 2 for this program'
  with pytest.raises(encoding.FormatError, match=error):
    sweep.run()
