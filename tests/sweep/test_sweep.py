"""`waggle sweep` as its user sees it: its tables, its files, its errors."""

from collections.abc import Callable
import json
import pathlib
import re
import shutil
import subprocess

import pytest

from waggle_tasks.experiments.results import figures
from waggle_tasks.experiments.studies import case_rows

Waggle = Callable[..., subprocess.CompletedProcess[str]]
BRIEF = ('--control=no_send', '--duration_s=0.04', '--observers=1')


@pytest.mark.slow
def test_a_grid_is_flown_and_mapped(
  here: Waggle, tmp_path: pathlib.Path
) -> None:
  done = here(
    'sweep', '--grid', 'distance_m=0.8,1.3', '--grid=noise_sigma=0,5',
    '--repeats=2', '--payload=random', '--workers=1', *BRIEF,
  )  # fmt: skip
  assert done.returncode == 0, done.stderr
  head, _, *rows = done.stdout.splitlines()[:4]
  assert re.split(' {2,}', head) == [r'distance_m \ noise_sigma', '0', '5']
  assert [re.split(' {2,}', row)[:2] for row in rows] == [
    ['0.8', '2/2 16-100'], ['1.3', '2/2 16-100'],
  ]  # fmt: skip
  assert 'wrong messages: 0 in 8 exposures; at most 31.234%' in done.stdout
  folder = tmp_path / 'runs' / 'sweep-klt-distance_m-noise_sigma'
  assert f'8 cases, {folder.relative_to(tmp_path)}/index.html' in done.stdout
  lines = (folder / 'results.jsonl').read_text().splitlines()
  assert len({json.loads(line)['scenario']['seed'] for line in lines}) == 8
  said = done.stdout.split('\n\n8 cases')[0]
  assert (folder / 'summary.txt').read_text() == f'{said}\n'
  origin = json.loads((folder / 'provenance.json').read_text())
  assert '--grid=distance_m=0.8,1.3 --grid=noise_sigma=0,5' in origin['command']
  # The page and the rest come back from the data.
  (folder / 'index.html').unlink()
  again = here('report', str(folder))
  assert again.returncode == 0, again.stderr
  assert (folder / 'index.html').exists()


@pytest.mark.slow
def test_a_summary_flies_nothing_and_needs_no_gl(
  here: Waggle, told: object, no_gl: dict[str, str]
) -> None:
  folder = shutil.copytree(told.folder, waggle_folder(told))
  before = {p.name: p.read_bytes() for p in folder.iterdir()}
  done = here('sweep', '--summary', str(folder), **no_gl)
  assert done.returncode == 0, done.stderr
  assert 'right: 4/4 exposures' in done.stdout
  after = {p.name: p.read_bytes() for p in folder.iterdir()}
  assert after.items() >= before.items()
  assert {'summary.txt', 'index.html'} <= after.keys()


def waggle_folder(told: object) -> pathlib.Path:
  return told.folder.parent / 'copy'


@pytest.mark.slow
def test_several_sweeps_make_one_map_in_a_new_folder(
  here: Waggle, tmp_path: pathlib.Path, make: object
) -> None:
  for name, sigma in (('a', 0.0), ('b', 5.0)):
    rows = make.rows('distance_m=1,2', observers=1, noise_sigma=sigma)
    tables = map(case_rows.table, rows)
    text = ''.join(f'{json.dumps(table)}\n' for table in tables)
    (tmp_path / name).mkdir()
    (tmp_path / name / 'results.jsonl').write_text(text)
  done = here('sweep', '--summary', 'a', 'b', '--output=both')
  assert done.returncode == 0, done.stderr
  assert done.stdout.startswith(r'distance_m \ noise_sigma')
  assert 'right: 4/4 exposures' in done.stdout
  names = {path.name for path in (tmp_path / 'both').iterdir()}
  assert {'summary.txt', 'index.html'} <= names
  printed = here('sweep', '--summary', 'a', 'b')
  assert printed.stdout == done.stdout.split('\n4 cases')[0]
  assert [path.name for path in (tmp_path / 'a').iterdir()] == ['results.jsonl']


def test_a_wrong_message_is_exit_status_1(
  here: Waggle, tmp_path: pathlib.Path, make: object
) -> None:
  rows = make.rows(observers=1, fate=lambda c, n: {'decoded': '111111'})
  (tmp_path / 'results.jsonl').write_text(
    json.dumps(case_rows.table(rows[0])) + '\n'
  )
  done = here('sweep', '--summary', '.')
  assert done.returncode == 1, done.stderr
  assert 'wrong messages: 1 in 1 exposures; at most 100.000%' in done.stdout


# Bad input.
FLAGS = {
  '--grid=distanc_m=1': '`grid` must be one of .* Did you mean distance_m',
  '--grid=distance_m=1,far': '`distance_m` must be of type float',
  '--grid=distance_m=1,9': 'cell distance_m=9.0: `distance_m` must be between',
  '--grid=observers=1,40': 'cell observers=40: observer_1 and observer_2 must',
  '--grid=seed=1': '`grid` must not name seed',
  '--repeats=0': '`repeats` must be between 1 and 1000000: got 0',
  '--repeats=two': 'flag --repeats=two: .*an integer',
  '--payload=randm': '`payload` must be 6 characters of 0 and 1',
  '--distance_m=9': '`distance_m` must be between 0.2 and 4: got 9.0',
  '--workers=0': '`workers` must be between 1 and 1024: got 0',
  '--receiver=kl': "`receiver` must be .*: got 'kl'. Did you mean klt",
  '--gird=distance_m=1': 'unknown flag --gird. Did you mean --grid',
  'folder': "takes only flags, --name=value: got 'folder'",
  '--summary': '--summary takes at least one FOLDER: got none',
  '--summary none': 'none holds no results of a sweep',
  '--scheduler=tcp://127.0.0.1:1': '`scheduler` (must be|needs an extra)',
}


@pytest.fixture(scope='module')
def answers(
  tmp_path_factory: pytest.TempPathFactory, ask: Callable[..., list]
) -> dict[str, tuple[int | str, str, list[str]]]:
  """Exit status, output and what is left of each line of `FLAGS`."""
  lines = [['sweep', *BRIEF, *line.split()] for line in FLAGS]
  return dict(
    zip(FLAGS, ask(lines, tmp_path_factory.mktemp('bad')), strict=True)
  )


@pytest.mark.parametrize('line', FLAGS)
def test_bad_input_is_one_line_and_leaves_nothing(
  answers: dict[str, tuple[int | str, str, list[str]]], line: str
) -> None:
  status, said, left = answers[line]
  assert status == 2, said
  assert said.count('\n') == 1
  assert said.startswith('waggle sweep: ')
  assert re.search(FLAGS[line], said)
  assert left == []


def test_the_note_about_pictures_tells_how_to_get_them() -> None:
  assert "pip install 'waggle-tasks[analysis]'" in figures.MISSING
