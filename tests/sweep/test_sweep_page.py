"""The page of a sweep: what a reader finds on it."""

import pathlib
import re

import pytest

from waggle_tasks.experiments.pages import heat_map, sweep_output, sweep_page
from waggle_tasks.experiments.record import provenance, scenario_fields
from waggle_tasks.experiments.results import envelope, figures
from waggle_tasks.experiments.studies import case_rows

ORIGIN = {
  'command': 'waggle sweep --grid=distance_m=0.6,1.3',
  'renderer': 'painter',
  'versions': {'mujoco': '3.17.0'},
  'source_digest': 'abc123',
}


def fate(case: object, number: int) -> dict[str, object]:
  del number
  if case.cell['bearing_deg'] < 60 or case.repeat:
    return {}
  return {
    'decoded': '111111',
    'failures': ('message: read 111111, sent <000010>',),
  }


@pytest.fixture(scope='module')
def rows(make: object) -> list[case_rows.SweepRow]:
  """Two of twelve are wrong."""
  return make.rows(
    'distance_m=0.6,1.3', 'bearing_deg=0,30,60', repeats=2, fate=fate,
    observers=1, noise_sigma=5.0, duration_s=200.0,
  )  # fmt: skip


@pytest.fixture(scope='module')
def page(rows: list[case_rows.SweepRow]) -> str:
  return sweep_page.draw(rows, 'mine', ORIGIN)


def words(markup: str) -> str:
  """What a reader sees of it, on one line."""
  return ' '.join(re.sub('<[^>]*>', ' ', markup).split())


def test_the_headline_numbers_come_first(page: str) -> None:
  head = words(page.split('</header>')[0])
  assert '✗ 2 wrong messages' in head
  assert '✗ 2 unauthorised motions' in head
  assert 'right: 10/12 exposures (83.33%)' in head


def test_the_map_has_a_rectangle_and_its_count_for_each_cell(
  rows: list[case_rows.SweepRow],
) -> None:
  (panel,) = envelope.panels(rows)
  drawn = heat_map.draw(panel)
  assert drawn.count('<rect') == 6
  assert re.findall(r'>(\d/\d)<', drawn) == ['2/2', '2/2', '1/2'] * 2
  text = words(drawn)
  assert 'distance, m' in text
  assert 'viewing angle, degrees' in text


def test_every_cell_has_its_limits(page: str) -> None:
  table = page.split('Every cell')[1]
  assert '0.6 30 2/2 15.8% to 100.0% 0 0' in words(table)
  assert '1.3 60 1/2 1.3% to 98.7% 1 1' in words(table)


def test_a_table_of_the_only_map_has_no_more_to_its_name(make: object) -> None:
  page = sweep_page.draw(make.rows('distance_m=1,2'), 'mine', None)
  assert '<h2>Every cell</h2>' in page
  maps = make.rows(
    'distance_m=1,2', 'bearing_deg=0,30', 'noise_sigma=0,5', observers=1
  )
  page = sweep_page.draw(maps, 'mine', None)
  assert '<h2>Every cell: noise sigma = 5</h2>' in page


def test_a_case_that_several_observers_failed_has_one_command(
  make: object,
) -> None:
  lost = {'decoded': None, 'failures': ('message: none',)}
  rows = make.rows('distance_m=1,2', observers=5, fate=lambda *_: lost)
  page = sweep_page.draw(rows, 'mine', None)
  assert page.count('<pre>waggle broadcast') == 2
  failed = words(page.split('What failed')[1].split('Every cell')[0])
  for number in range(1, 6):
    assert failed.count(f'observer_{number} : message: none') == 2


def test_a_failure_has_its_reason_and_the_command_that_repeats_it(
  page: str, rows: list[case_rows.SweepRow]
) -> None:
  assert 'message: read 111111, sent &lt;000010&gt;' in page
  commands = re.findall('<pre>(waggle broadcast .*?)</pre>', page)
  wrong = [row for row in rows if row.outcomes[0].wrong]
  for command, row in zip(commands, wrong, strict=True):
    _, _, receiver, *given = command.split()
    assert receiver == '--receiver=view_bank'
    pairs = [flag.removeprefix('--').split('=') for flag in given]
    read = {name: scenario_fields.parse(name, text) for name, text in pairs}
    assert scenario_fields.defaults() | read == row.scenario


def test_the_page_says_what_made_it(page: str) -> None:
  foot = words(page)
  for word in (ORIGIN['command'], 'painter', 'mujoco 3.17.0', 'abc123'):
    assert word in foot


def test_the_page_needs_nothing_but_itself(page: str) -> None:
  assert not re.search(r'(src|href)=|https?://|@import', page)


def test_a_perfect_sweep_has_nothing_that_failed(make: object) -> None:
  page = sweep_page.draw(make.rows('distance_m=1,2'), 'mine', None)
  assert '✓ 0 wrong messages' in words(page)
  assert 'What failed' not in page
  assert 'How it was made' not in page


def test_without_matplotlib_all_but_the_pictures_is_written(
  rows: list[case_rows.SweepRow],
  tmp_path: pathlib.Path,
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(figures, 'can_draw', lambda: False)
  sweep_output.write(tmp_path / 'out', rows)
  names = {path.name for path in (tmp_path / 'out').iterdir()}
  assert names == {'summary.txt', 'index.html'}


@pytest.mark.slow
def test_a_whole_sweeps_page_holds_its_provenance(
  told: object, tmp_path: pathlib.Path
) -> None:
  del tmp_path
  rows = told.run()
  page = sweep_output.write(told.folder, rows).read_text(encoding='utf-8')
  digest = provenance.source_digest(provenance.source_hashes())
  assert digest in page
  for name in ('index.html', 'summary.txt', *case_rows.FIGURES):
    (told.folder / name).unlink(missing_ok=True)
