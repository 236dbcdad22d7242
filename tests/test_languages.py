"""Languages: their frames, how alike their symbols look, files, the command."""

from collections.abc import Callable
import dataclasses
import json
import math
import pathlib
import re
import subprocess

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from waggle_tasks import errors, plain, scenario, suites
from waggle_tasks.experiments.record import (
  archive,
  changes,
  language_file,
  scenario_fields,
)
from waggle_tasks.experiments.results import language_measure
from waggle_tasks.experiments.studies import sweep_cases
from waggle_tasks.protocol import (
  agreement,
  alphabets,
  coding,
  gestures,
  languages,
  levels,
  limits,
  schedule,
  sights,
)
from waggle_tasks.protocol.symbols import Symbol

Waggle = Callable[..., subprocess.CompletedProcess[str]]
DOCS = pathlib.Path(__file__).parents[1] / 'docs' / 'link.md'
PAPER = agreement.Agreement().spoken
FOUR = languages.Language(levels.quickest(4, 0.1), coding.Coding('crc4'))
BRISK = languages.LANGUAGES['brisk'].alphabet
# Minimum jerk's root mean square of its share of the way: the square root of
# the integral of (10 s^3 - 15 s^4 + 6 s^5)^2.
PROGRESS_RMS = math.sqrt(181 / 462)

alphabets_ = st.one_of(
  st.builds(
    levels.Levels,
    st.sampled_from(levels.COUNTS),
    st.floats(0.02, 0.6),
    st.floats(0.1, 10.0),
    st.floats(0.1, 10.0),
  ),
  st.builds(
    alphabets.Gestures,
    st.sampled_from([BRISK.codebook, PAPER.alphabet.codebook]),
    st.floats(0.0, 2.0),
  ),
)


@pytest.mark.slow
@given(alphabets_, st.data())
def test_a_frame_of_any_word_goes_on_where_it_was_and_ends_at_home(
  alphabet: languages.alphabets.Alphabet, data: st.DataObject
) -> None:
  symbols = st.integers(0, alphabet.size - 1)
  word = data.draw(st.lists(symbols, min_size=1, max_size=8))
  slots = alphabets.lay_out(alphabet, [Symbol.START, *word, Symbol.END], 1.5)
  assert len(slots) == len(word) + 2
  assert slots[0].begin_s == 1.5
  begins_s = [each.begin_s for each in slots]
  np.testing.assert_allclose(np.diff(begins_s[1:]), alphabet.slot_s)
  place_m = np.zeros(2)
  for slot in slots:
    path = slot.gesture
    np.testing.assert_allclose(path.motion(0.0)[0], place_m, atol=1e-9)
    place_m, speed, _ = path.motion(path.duration_s)
    np.testing.assert_allclose(place_m, path.end_m, atol=1e-9)
    np.testing.assert_allclose(speed, 0.0, atol=1e-6)
    times_s = np.linspace(0.0, path.duration_s, 101)
    way_m = np.abs(np.diff(alphabets.places(path, times_s), axis=0)).max()
    assert way_m <= limits.peaks(path).speed_mps * times_s[1] + 1e-9
    heights_m = alphabets.places(path, times_s)[:, 1]
    assert heights_m.min() >= alphabet.lowest_m - 1e-9
    assert heights_m.max() <= alphabet.highest_m + 1e-9
  np.testing.assert_allclose(place_m, 0.0, atol=1e-9)


@given(alphabets_, st.data())
def test_each_stroke_ends_in_the_state_of_its_symbol(
  alphabet: languages.alphabets.Alphabet, data: st.DataObject
) -> None:
  state = data.draw(st.integers(0, alphabet.states - 1))
  symbol = data.draw(st.integers(0, alphabet.size - 1))
  there_m = alphabet.stroke(state, symbol).end_m
  after = alphabet.after(symbol)
  np.testing.assert_allclose(
    alphabet.stroke(after, 0).motion(0.0)[0], there_m, atol=1e-9
  )
  np.testing.assert_allclose(
    alphabet.end(after).motion(0.0)[0], there_m, atol=1e-9
  )
  np.testing.assert_allclose(
    alphabet.stroke(0, 0).motion(0.0)[0], alphabet.start.end_m, atol=1e-9
  )


@pytest.mark.parametrize('name', language_file.NAMES)
def test_a_frame_of_every_language_is_flown_by_ideal_vehicles(
  name: str,
) -> None:
  slots = language_measure.frame(language_file.find(name), '101101')
  limits.check_schedule(schedule.Schedule(slots))


@given(
  st.sampled_from([PAPER, FOUR, *languages.LANGUAGES.values()]),
  st.text('01', min_size=1, max_size=64),
)
def test_a_frame_has_a_stroke_for_each_symbol_of_its_code(
  language: languages.Language, bits: str
) -> None:
  size = language.alphabet.size
  slots = language_measure.frame(language, bits)
  assert len(slots) == language.coding.count(len(bits), size) + 2
  assert slots[0].begin_s == language.initial_hover_s
  word = language.coding.symbols(bits, size)
  assert language.coding.read(word, len(bits), size).bits == bits


@pytest.mark.parametrize(('count', 'reach_m'), [(4, 0.1), (8, 0.14), (16, 0.3)])
def test_levels_are_as_far_apart_as_their_spacing_says(
  count: int, reach_m: float
) -> None:
  alphabet = levels.quickest(count, reach_m)
  found = sights.nearest(alphabet)
  wanted_m = alphabet.spacing_m * PROGRESS_RMS
  assert found.distance_m == pytest.approx(wanted_m, rel=0.002)
  assert found.angle_deg is None  # From everywhere.


def test_gestures_are_nearest_from_their_side() -> None:
  found = sights.nearest(PAPER.alphabet)
  assert found.symbols == ('END', 'rest')
  assert found.angle_deg == 85
  narrow = sights.nearest(PAPER.alphabet, 60)
  assert narrow.distance_m > 3 * found.distance_m


def with_one(
  one_m: tuple[tuple[float, float], ...], one_s: float, start_m: float = 0.2
) -> alphabets.Gestures:
  """Gestures of which START takes 2 s, with another one for 1."""
  up, side = (0.0, start_m), 0.4
  ways = {
    Symbol.START: (((0, 0), up, (0, 0)), 2.0),
    Symbol.ZERO: (((0, 0), (-0.1, -0.1), (0.1, -0.1), (0, 0)), one_s),
    Symbol.ONE: (one_m, one_s),
    Symbol.END: (((0, 0), (-side, 0), (side, 0), (0, 0)), 6.0),
  }
  book = gestures.Codebook(
    tuple(gestures.Gesture(symbol, *way) for symbol, way in ways.items())
  )
  return alphabets.Gestures(book, 0.1)


def tip(half_width_m: float, height_m: float) -> tuple:
  """An inverted V from its left tip to its right one, and the way back."""
  return (0, 0), (half_width_m, height_m), (2 * half_width_m, 0), (0, 0)


def test_an_inverted_v_from_its_tip_is_start_from_the_side() -> None:
  """Its size says nothing: START is what tells the scale."""
  found = sights.nearest(with_one(tip(0.05, 0.1), 3.0))
  assert found.symbols == ('START', '1')
  assert abs(found.angle_deg) == 85
  assert found.distance_m < 0.015
  slower = sights.nearest(with_one(tip(0.05, 0.1), 4.5))  # Not in its time.
  assert slower.distance_m > 2 * found.distance_m


def test_a_view_from_the_side_shows_no_more_than_one_from_the_front() -> None:
  across = np.array([[[0.0, 0, 0], [0.2, 0.1, 0]]])
  front, side = sights.project(across, np.radians([0, 90]), 1.3)
  np.testing.assert_allclose(front[0, 1], [0.2, -0.1])
  np.testing.assert_allclose(side[0, 1], [0.0, -0.1 * 1.3 / 1.1], atol=1e-9)


REFUSED = {
  'levels too near': (
    lambda: languages.Language(levels.quickest(16, 0.05)),
    '`alphabet` must have symbols that look at least 8 mm apart from every view'
    ' up to 60 degrees: 0 and 1 are 3.9 mm apart from every view',
  ),
  'gestures too small': (
    lambda: languages.Language(
      alphabets.Gestures(gestures.v_codebook(0.01, 0.02, 1.0), 0.1)
    ),
    'are .* mm apart from 60 degrees',
  ),
  'a smaller start': (
    lambda: languages.Language(with_one(tip(0.008, 0.04), 3.0, start_m=0.05)),
    'START and 1 are .* mm apart from -?60 degrees',
  ),
  'parity': (
    lambda: languages.Language(
      levels.quickest(4, 0.1), coding.Coding(parity=3)
    ),
    '`parity` must be between 0 and 2 in an alphabet of 4 symbols',
  ),
  'parity of bits': (
    lambda: languages.Language(BRISK, coding.Coding(parity=1)),
    '`parity` must be between 0 and 0 in an alphabet of 2 symbols',
  ),
  'no coding': (
    lambda: languages.Language(BRISK, 'crc4'),
    "`coding` must be a Coding: got 'crc4'",
  ),
  'no alphabet': (
    lambda: languages.Language('levels'),
    "`alphabet` must be Levels or Gestures: got 'levels'",
  ),
  'confirmation': (
    lambda: languages.Language(BRISK, confirm_s=0.0),
    '`confirm_s` must be between 0.1 and 10: got 0',
  ),
  'count': (
    lambda: levels.Levels(5),
    r'`count` must be one of \[2, 4, 8, 16\]',
  ),
  'reach': (lambda: levels.Levels(4, 0.7), '`reach_m` must be between 0.02'),
  'rest': (
    lambda: alphabets.Gestures(BRISK.codebook, -0.1),
    '`rest_s` must be between 0 and 60: got -0.1',
  ),
  'rest that is none': (
    lambda: alphabets.Gestures(BRISK.codebook, math.nan),
    '`rest_s` must be a finite number: got nan',
  ),
  'no codebook': (
    lambda: alphabets.Gestures('vees', 0.1),
    "`codebook` must be a gestures.Codebook: got 'vees'",
  ),
}


@pytest.mark.parametrize('name', REFUSED)
def test_what_cannot_be_spoken_or_read_is_refused(name: str) -> None:
  make, error = REFUSED[name]
  with pytest.raises(errors.WaggleError, match=error):
    make()


@pytest.mark.parametrize(
  ('alphabet', 'dynamics', 'motion'),
  [
    (levels.Levels(4, 0.3, 1.0, 0.5), 'ideal', 'gesture START'),
    (levels.Levels(4, 0.3, 0.3, 2.0), 'ideal', 'gesture START'),
    (BRISK, 'rotors', 'gesture 0'),
  ],
)
def test_a_language_that_cannot_be_flown_is_refused_by_its_motion(
  alphabet: sights.Alphabet, dynamics: str, motion: str
) -> None:
  language = languages.Language(alphabet)
  error = f'^`{motion}` must .*; in .* s it can'
  with pytest.raises(limits.LimitError, match=error):
    scenario.Scenario(language=language, dynamics=dynamics)
  told = language_measure.measure(language).refusals[dynamics]
  assert told.startswith(f'`{motion}` must')


OWN = [FOUR, *languages.LANGUAGES.values(), PAPER]


@pytest.mark.parametrize('language', OWN)
def test_a_language_is_plain_data_and_back(
  language: languages.Language, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'own.json'
  path.write_text(json.dumps(plain.to_plain(language)))
  assert language_file.find(str(path)) == language


def test_the_file_of_the_documents_is_the_value_beside_it(
  tmp_path: pathlib.Path,
) -> None:
  (text,) = re.findall(r'```json\n(.*?)```', DOCS.read_text(), re.DOTALL)
  (tmp_path / 'four.json').write_text('\ufeff' + text, encoding='utf-8')
  assert language_file.read(tmp_path / 'four.json') == FOUR


FILES = {
  'none.json': (None, 'readable JSON file: .*No such file'),
  'broken.json': ('{"alphabet":', 'readable JSON file: .*Expecting value'),
  'deep.json': ('[' * 100_000, 'readable JSON file: '),
  'list.json': ('[]', 'must be a table of Language: got'),
  'empty.json': ('{}', '`alphabet` must be given'),
  'field.json': (
    '{"alphabet": {"count": 4}, "codng": {}}',
    '`codng` must be one of the fields .* Did you mean coding',
  ),
  'inner.json': (
    '{"alphabet": {"waggle_tasks.protocol.levels:Levels": {"counts": 4}}}',
    '`alphabet.counts` must be one of the fields .* Did you mean count',
  ),
  'class.json': (
    '{"alphabet": {"waggle_tasks.protocol.levels:Stroke": {"symbol": "0"}}}',
    '`alphabet` must be a table of Levels or a table of Gestures',
  ),
  'kind.json': (
    '{"alphabet": {"count": 4}, "confirm_s": "long"}',
    '`confirm_s` must be a finite number',
  ),
  'nan.json': ('{"alphabet": {"count": 4, "reach_m": NaN}}', 'finite number'),
  'near.json': ('{"alphabet": {"count": 16, "reach_m": 0.05}}', '8 mm apart'),
  'parity.json': (
    '{"alphabet": {"count": 4}, "coding": {"parity": 3}}',
    '`parity` must be between 0 and 2',
  ),
  'check.json': (
    '{"alphabet": {"count": 4}, "coding": {"check": "crc5"}}',
    '`coding.check` must be one of .* Did you mean',
  ),
}


@pytest.mark.parametrize('name', FILES)
def test_a_file_that_is_no_language_is_refused_by_its_name(
  name: str, tmp_path: pathlib.Path
) -> None:
  data, error = FILES[name]
  if data is not None:
    (tmp_path / name).write_text(data)
  with pytest.raises(languages.LanguageError, match=error) as raised:
    scenario_fields.parse('language', str(tmp_path / name))
  assert name in str(raised.value)
  assert '\n' not in str(raised.value)


def test_a_language_of_ones_own_is_a_value_of_its_scenario(
  tmp_path: pathlib.Path,
) -> None:
  """As plain data, as flags, in a seed, in a suite: the file may be gone."""
  path = tmp_path / 'four.json'
  path.write_text(json.dumps(plain.to_plain(FOUR)))
  text = scenario_fields.parse('language', str(path))
  path.unlink()
  scene = scenario_fields.make({'language': text})
  assert scene == scenario.Scenario(language=FOUR)
  told = scenario_fields.flat(json.loads(json.dumps(plain.to_plain(scene))))
  assert scenario_fields.make(told) == scene
  (flag,) = scenario_fields.flags(told)
  again = scenario_fields.parse('language', flag.removeprefix('--language='))
  assert scenario_fields.make({'language': again}) == scene
  assert changes.of(scene) == ['language=own']
  (case,) = suites.from_rows(
    [{'name': 'four', 'language': plain.to_plain(FOUR)}]
  )
  assert case.scene == scene
  usual = scenario_fields.defaults()
  own, known = (
    sweep_cases.cases({}, {**usual, 'language': each}, 1)[0].scene
    for each in (text, 'swift')
  )
  assert own.language == FOUR
  assert own.seed != known.seed
  grid = sweep_cases.grid(['language=brisk,swift'])
  assert grid == {'language': ['brisk', 'swift']}


def test_a_grid_takes_names_of_languages_alone(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'four.json'
  path.write_text(json.dumps(plain.to_plain(FOUR)))
  with pytest.raises(sweep_cases.SweepError, match='names for language: fly'):
    sweep_cases.grid([f'language=swift,{path}'])


@pytest.mark.parametrize(
  ('text', 'error'),
  [
    ('{', '`language` must be a value as JSON'),
    (
      '{"alphabet": {"count": 16, "reach_m": 0.05}}',
      '`language.alphabet` must',
    ),
    (
      '',
      r"`language` must be one of \['paper', 'brisk', 'gentle', 'rapid',"
      r" 'swift'\]: got ''",
    ),
    ('swfit', "got 'swfit'. Did you mean swift"),
  ],
)
def test_text_that_is_no_language_is_refused(text: str, error: str) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    scenario_fields.make({'language': scenario_fields.parse('language', text)})


@pytest.mark.slow
def test_the_command_shows_every_language_as_the_documents_have_it(
  waggle: Waggle, no_gl: dict[str, str], tmp_path: pathlib.Path
) -> None:
  child = waggle('languages', cwd=tmp_path, **no_gl)
  assert child.returncode == 0, child.stderr
  head, _, *lines = child.stdout.split('\n\n')[0].splitlines()
  assert [line.split()[0] for line in lines] == [
    'paper',
    'brisk',
    'gentle',
    'rapid',
    'swift',
  ]
  names = re.split(r'\s{2,}', head)
  rows = [dict(zip(names, re.split(r'\s{2,}', x), strict=True)) for x in lines]
  for row in rows:
    language = language_file.find(row['language'])
    slots = language.fly(
      [[Symbol.START, *[0] * int(row['symbols']), Symbol.END]]
    )
    accepted_s = slots[-1].end_s + language.confirm_s
    assert float(row['with hover']) == pytest.approx(accepted_s, abs=0.006)
    whole_s = accepted_s - slots[0].begin_s
    assert float(row['s']) == pytest.approx(whole_s, abs=0.006)
    assert float(row['bit/s']) == pytest.approx(6 / whole_s, abs=0.006)
    speeds = [
      np.abs(path.motion(at_s)[1]).max()
      for path in language.alphabet.motions
      for at_s in np.linspace(0.0, path.duration_s, 301)
    ]
    assert float(row['m/s']) == pytest.approx(max(speeds), abs=0.006)
    apart_m = sights.nearest(language.alphabet).distance_m
    assert float(row['apart mm']) == pytest.approx(1000 * apart_m, abs=0.06)
  assert [row['rotors'] for row in rows] == ['yes', 'no', 'yes', 'yes', 'yes']
  assert 'brisk, rotors: `gesture 0` must accelerate sideways' in child.stdout
  documents = DOCS.read_text(encoding='utf-8')
  assert all(line in documents for line in (head, *lines))
  assert [*tmp_path.iterdir()] == []


@pytest.mark.slow
def test_the_command_shows_and_draws_a_language_of_ones_own(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  pytest.importorskip('matplotlib')
  path = tmp_path / 'four.json'
  path.write_text(json.dumps(plain.to_plain(FOUR)))
  child = waggle('languages', str(path), 'brisk', f'--output={tmp_path}/out')
  assert child.returncode == 0, child.stderr
  assert f'\n{path} ' in child.stdout
  drawn = (tmp_path / 'out' / 'languages.svg').read_text(encoding='utf-8')
  assert 'four.json, side, 85 degrees' in drawn
  assert (tmp_path / 'out' / 'languages.png').stat().st_size > 10_000


@pytest.mark.slow
@pytest.mark.parametrize(
  ('arguments', 'error'),
  [
    (['swfit'], "`language` must be one of .* got 'swfit'. Did you mean swift"),
    (['none.json'], 'readable JSON file: none.json: .*No such file'),
    (['near.json'], 'near.json: `alphabet` must have symbols that look at'),
    (['swift', '--output=near.json/x'], '`output` must be writable'),
  ],
)
def test_the_command_refuses_in_one_line(
  arguments: list[str], error: str, waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  (tmp_path / 'near.json').write_text(FILES['near.json'][0])
  child = waggle('languages', *arguments, cwd=tmp_path)
  assert (child.returncode, child.stdout) == (2, '')
  (line,) = child.stderr.splitlines()
  assert re.search(error, line)
  assert [each.name for each in tmp_path.iterdir()] == ['near.json']


@pytest.mark.slow
def test_a_language_of_ones_own_is_danced_read_and_followed(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'four.json'
  path.write_text(json.dumps(plain.to_plain(FOUR)))
  child = waggle(
    'broadcast', '--language=four.json', '--observers=1', '--payload=101101',
    '--output=run', cwd=tmp_path,
  )  # fmt: skip
  assert child.returncode == 0, child.stdout + child.stderr
  assert 'Group passed: 1 of 1 observers decoded 101101.' in child.stdout
  path.unlink()
  scene = archive.read_scenario(tmp_path / 'run' / 'config.json')
  assert scene.language == FOUR
  assert dataclasses.replace(scene, language='swift') != scene


@pytest.mark.slow
def test_a_suite_has_a_folder_for_a_language_of_ones_own(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  """Its text is longer than names of folders may be."""
  (tmp_path / 'four.json').write_text(json.dumps(plain.to_plain(PAPER)))
  rows = [{'name': 'a', 'observers': 1, 'control': 'no_send', 'duration_s': 1}]
  (tmp_path / 'mine.json').write_text(json.dumps(rows))
  child = waggle(
    'suite', '--suite=mine.json', '--language=four.json', cwd=tmp_path
  )
  assert child.returncode == 0, child.stdout + child.stderr
  (folder,) = (tmp_path / 'runs').glob('mine-joint-language=*')
  assert len(folder.name) < 40
