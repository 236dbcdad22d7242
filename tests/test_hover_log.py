"""The hover of a user's own log: read, flown, written, and refused."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import numpy as np
import pytest

from waggle_tasks import plain, scenario
from waggle_tasks.experiments.record import changes, hover_file, scenario_fields
from waggle_tasks.experiments.results import hover_measure
from waggle_tasks.experiments.studies import sweep_cases
from waggle_tasks.tasks import drift, hover, hover_log, hover_presets

Columns = dict[str, np.ndarray]
Waggle = Callable[..., subprocess.CompletedProcess[str]]
HEADER = ','.join(sum(hover_file.COLUMNS.values(), ()))


@pytest.fixture(scope='module')
def log() -> Columns:
  """A minute of a vehicle that hovers and looks back, 40 samples a second."""
  spectrum = hover_presets.PRESETS['lighthouse'].spectrum
  moved, _ = hover_measure.signal(spectrum, 1, 60.0, 40.0)
  headings = (moved[:, 5:] + 180.0 + 180.0) % 360.0 - 180.0
  return {
    'time_s': 100.0 + np.arange(len(moved)) / 40.0,
    'position_m': moved[:, :3] / 1000 + (1.0, -2.0, 0.7),
    'roll_pitch_yaw_deg': np.hstack([moved[:, 3:5], headings]),
  }


def written(log: Columns, path: pathlib.Path) -> pathlib.Path:
  """A log as a file."""
  if path.suffix == '.npz':
    np.savez(path, **log)
  else:
    rows = np.column_stack([*log.values()])
    np.savetxt(path, rows, delimiter=',', header=HEADER, comments='')
  return path


def test_a_log_gives_the_spectrum_that_it_was_drawn_from(log: Columns) -> None:
  found = hover_log.spectrum(**log)
  known = hover_presets.PRESETS['lighthouse'].spectrum
  for axis in ('x_mm', 'y_mm', 'z_mm', 'roll_deg', 'pitch_deg', 'yaw_deg'):
    got, wanted = getattr(found, axis), getattr(known, axis)
    np.testing.assert_allclose(got[2:], wanted[2:], rtol=0.25)
    # Of the slowest waves a minute shows a few.
    np.testing.assert_allclose(got[:2], wanted[:2], rtol=0.6)


def test_a_lost_sample_changes_little(log: Columns) -> None:
  kept = np.delete(np.arange(len(log['time_s'])), [500, 501, 1200])
  whole = hover_log.spectrum(**log)
  found = hover_log.spectrum(**{n: each[kept] for n, each in log.items()})
  np.testing.assert_allclose(found.place_m, whole.place_m, rtol=0.1)


@pytest.mark.parametrize('name', ['log.csv', 'log.npz'])
def test_a_file_gives_what_its_numbers_give(
  name: str, log: Columns, tmp_path: pathlib.Path
) -> None:
  found = hover_file.read(written(log, tmp_path / name))
  assert found == hover_log.spectrum(**log)


def test_columns_may_stand_in_any_order(
  log: Columns, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'log.csv'
  rows = np.column_stack([*log.values()])[:, ::-1]
  names = ', '.join(reversed(HEADER.split(',')))
  np.savetxt(path, rows, delimiter=',', header=names, comments='')
  assert hover_file.read(path) == hover_log.spectrum(**log)


def changed(**values: object) -> Callable[[Columns], Columns]:
  return lambda log: {
    name: values[name](each) if name in values else each
    for name, each in log.items()
  }


def with_value(
  at: tuple[int, ...], value: float
) -> Callable[[np.ndarray], np.ndarray]:
  def put(array: np.ndarray) -> np.ndarray:
    array = array.copy()
    array[at] = value
    return array

  return put


def cut(count: int) -> Callable[[Columns], Columns]:
  return lambda log: {name: each[:count] for name, each in log.items()}


def with_a_hole(log: Columns) -> Columns:
  return {n: np.delete(a, slice(400, 420), axis=0) for n, a in log.items()}


BAD = {
  'short': (cut(799), 'at least 20 s of hover: got 20 s|got 19.9'),
  'empty': (cut(1), r'`time_s` must be \(T,\) numbers'),
  'a gap': (with_a_hole, 'no gap: got 0.525 s without a sample after 109.975'),
  'times fall': (
    changed(time_s=with_value((7,), 50.0)),
    '`time_s` must rise: got 50 after 100.15 s, sample 7',
  ),
  'a time twice': (
    changed(time_s=with_value((7,), 100.15)), '`time_s` must rise'
  ),
  'no number': (
    changed(position_m=with_value((9, 1), np.nan)),
    '`position_m` must be finite numbers: got nan in sample 9',
  ),
  'endless': (
    changed(roll_pitch_yaw_deg=with_value((9, 1), np.inf)),
    '`roll_pitch_yaw_deg` must be finite numbers: got inf in sample 9',
  ),
  'slow': (
    lambda log: {name: each[::4] for name, each in log.items()},
    'at least 20 samples a second: got 10',
  ),
  'a flight': (
    changed(position_m=lambda each: each + np.linspace(0, 2, 2400)[:, None]),
    'of a vehicle that hovers: `x_mm` must be between 0 and 30: got',
  ),
  'two columns': (
    changed(position_m=lambda each: each[:, :2]),
    r'must be \(2400, 3\) numbers, .*: got \(2400, 2\)',
  ),
  'no attitude': (
    changed(roll_pitch_yaw_deg=np.zeros_like),
    r'`roll_pitch_yaw_deg` must change, .*: got \[0.0, 0.0, 0.0\] in all 2400',
  ),
  'windows': (
    changed(time_s=lambda each: each.reshape(6, 400)),
    r'`time_s` must be \(T,\) numbers: got \(6, 400\)',
  ),
}  # fmt: skip


@pytest.mark.parametrize('name', BAD)
def test_a_log_that_shows_no_hover_is_refused(name: str, log: Columns) -> None:
  spoil, error = BAD[name]
  with pytest.raises(hover_log.LogError, match=error):
    hover_log.spectrum(**spoil(log))


FILES = {
  'no.csv': (None, 'must be a CSV file with the columns time_s,.*is no file'),
  'words.csv': (b'hello\n1\n', "its columns must be .*'hello'"),
  'binary.csv': (b'\xff\xfe\x00\x01', 'it cannot be read'),
  'broken.npz': (b'PK\x03\x04broken', 'it cannot be read'),
  'nothing.csv': (b'', 'its columns must be'),
  'alone.csv': (HEADER.encode(), 'it must have lines of numbers: got none'),
  'short.csv': (f'{HEADER}\n1,2\n'.encode(), 'each line must have 7 numbers'),
  'text.csv': (f'{HEADER}\n1,2,3,4,5,6,x\n'.encode(), 'it cannot be read: .*x'),
}


@pytest.mark.filterwarnings('error')
@pytest.mark.parametrize('name', FILES)
def test_a_file_that_is_no_log_is_refused_by_its_name(
  name: str, tmp_path: pathlib.Path
) -> None:
  data, error = FILES[name]
  if data is not None:
    (tmp_path / name).write_bytes(data)
  with pytest.raises(hover_log.LogError, match=error) as raised:
    hover_file.read(tmp_path / name)
  assert name in str(raised.value)


@pytest.mark.parametrize(
  ('gone', 'added', 'error'),
  [
    ('roll_pitch_yaw_deg', None, r"\['roll_pitch_yaw_deg'\] missing"),
    (None, 'battery_v', r"\['battery_v'\] not known"),
  ],
)
def test_columns_that_are_missing_or_not_known_are_named(
  gone: str | None,
  added: str | None,
  error: str,
  log: Columns,
  tmp_path: pathlib.Path,
) -> None:
  columns = {name: each for name, each in log.items() if name != gone}
  if added:
    columns[added] = log['time_s']
  with pytest.raises(hover_log.LogError, match=error):
    hover_file.read(written(columns, tmp_path / 'log.npz'))


def test_a_log_is_a_value_of_its_scenario(
  log: Columns, tmp_path: pathlib.Path
) -> None:
  """As plain data, as flags, in a seed: the file may be gone."""
  path = written(log, tmp_path / 'log.csv')
  text = scenario_fields.parse('hover_log', str(path))
  path.unlink()
  values = {'performer_hover': 'log', 'hover_log': text}
  scene = scenario_fields.make(values)
  assert scene.drift.hover_log == hover_log.spectrum(**log)
  data = json.loads(json.dumps(plain.to_plain(scene)))
  assert plain.from_plain(scenario.Scenario, data) == scene
  told = scenario_fields.flat(data)
  assert scenario_fields.make(told) == scene
  flags = dict(
    flag.removeprefix('--').split('=', 1)
    for flag in scenario_fields.flags(told)
  )
  parsed = {name: scenario_fields.parse(name, v) for name, v in flags.items()}
  assert scenario_fields.make(parsed) == scene
  assert changes.of(scene) == ['performer_hover=log', 'hover_log=own']
  louder = hover_log.spectrum(**{**log, 'position_m': 2 * log['position_m']})
  other = scenario_fields.table()['hover_log'].told(louder)
  first, again, changed_ = (
    sweep_cases.cases(
      {}, {**scenario_fields.defaults(), **values, 'hover_log': each}, 1
    )[0]
    for each in (text, text, other)
  )
  assert first == again
  assert first.scene.seed != changed_.scene.seed


def test_text_that_is_no_hover_is_refused() -> None:
  for text in ('{', '{"x_mm": 3}', '{"mood": 1}'):
    with pytest.raises(ValueError, match='`hover_log'):
      scenario_fields.parse('hover_log', text)
  with pytest.raises(ValueError, match='must not name hover_log'):
    sweep_cases.grid(['hover_log=a.csv,b.csv'])


def test_a_log_is_flown_where_it_is_asked_for(log: Columns) -> None:
  own = hover_log.spectrum(**log)
  flown = drift.Drift(observer_hover='log', hover_log=own)
  sway = flown.observer(np.random.RandomState(0))
  assert sway.attitude(5.0).any()
  assert flown.performer(np.random.RandomState(0)).hover is None
  for wrong in (
    {'observer_hover': 'log'}, {'hover_log': own},
    {'observer_hover': 'mocap', 'hover_log': own},
  ):  # fmt: skip
    with pytest.raises(drift.DriftError, match='`hover_log` must be given whe'):
      drift.Drift(**wrong)


@pytest.mark.slow
def test_the_command_shows_presets_beside_their_sources(waggle: Waggle) -> None:
  child = waggle('drift', '--hover=mocap')
  assert child.returncode == 0, child.stderr
  assert 'air_garage_cflib' in child.stdout
  lines = {tuple(line.split()[:3]): line for line in child.stdout.splitlines()}
  assert '5.60' in lines['x', 'mm', 'source']
  assert len(lines['x', 'mm', 'signal'].split()) == 10
  assert ('z', 'mm', 'source') not in lines


@pytest.mark.slow
def test_the_command_shows_and_draws_a_log(
  log: Columns, waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  pytest.importorskip('matplotlib')
  path = written(log, tmp_path / 'log.csv')
  child = waggle('drift', f'--hover_log={path}', f'--output={tmp_path}/out')
  assert child.returncode == 0, child.stderr
  (line,) = (each for each in child.stdout.splitlines() if each.startswith('{'))
  found = plain.from_plain(hover.Spectrum, json.loads(line))
  assert found == hover_log.spectrum(**log)
  assert (tmp_path / 'out' / 'hover.png').stat().st_size > 10_000
  assert 'pitch' in (tmp_path / 'out' / 'hover.svg').read_text()


@pytest.mark.parametrize(
  ('flag', 'error'),
  [
    ('--hover=mocup', "one of ['mocap', 'lighthouse', 'flow_deck']: got 'mocu"),
    ('--hover_log=no.csv', 'no.csv is no file'),
  ],
)
def test_bad_input_is_one_line(flag: str, error: str, waggle: Waggle) -> None:
  child = waggle('drift', flag)
  assert child.returncode == 2
  (line,) = child.stderr.splitlines()
  assert error in line
