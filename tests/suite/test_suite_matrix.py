"""The paper's outcome, row by row, through the command."""

from collections.abc import Callable
import json
import pathlib
import re
import subprocess

import numpy as np
import pytest

from waggle_tasks import suites

# Where 000010 leads: forward, no turn, two units of 0.2 m.
DISPLACEMENT_M = (0.0, 0.4, 0.0)
# Which observers of the paper's failed groups read the message.
READERS = {
  'span-40': {2, 3, 4},
  'span-40-backward': {2, 3, 4},
  'span-45': {2},
  'distance-1-0': set(),
}

Run = Callable[..., dict[str, dict[str, object]]]


@pytest.fixture
def run(
  waggle: Callable[..., subprocess.CompletedProcess[str]],
  tmp_path: pathlib.Path,
) -> Run:
  """Runs `waggle suite`, which must end as published; rows by case."""

  def suite(*flags: str) -> dict[str, dict[str, object]]:
    done = waggle(
      'suite', '--suite=paper', '--output=results', *flags, cwd=tmp_path
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert 'differs' not in done.stdout
    path = tmp_path / 'results' / 'results.jsonl'
    text = path.read_text(encoding='utf-8')
    rows = [json.loads(line) for line in text.splitlines()]
    return {row['case']: {**row, 'stdout': done.stdout} for row in rows}

  return suite


def moved_m(tmp_path: pathlib.Path, case: str, observer: str) -> np.ndarray:
  """How far from its beginning an observer was, (T, 3)."""
  path = tmp_path / 'results' / 'cases' / case / 'positions.npz'
  with np.load(path) as file:
    return file[observer] - file[observer][0]


@pytest.mark.long
def test_a_row_that_passes_and_one_that_fails_end_to_end(
  run: Run, tmp_path: pathlib.Path
) -> None:
  rows = run('--case=one-observer,span-45', '--workers=2')
  front, wide = rows['one-observer'], rows['span-45']
  assert (front['correct'], front['passed']) == (1, True)
  assert (wide['correct'], wide['passed']) == (1, False)
  left, middle, right = wide['outcomes']
  for outcome in (*front['outcomes'], middle):
    assert outcome['failures'] == []
    assert outcome['decoded'] == '000010'
    # The paper's END and final null of this dance: 92.64 s and 95.64 s.
    assert outcome['end_s'] == pytest.approx(92.64, abs=0.2)
    assert outcome['final_null_s'] == pytest.approx(95.64, abs=0.2)
    assert outcome['start_s'] == outcome['final_null_s']
    assert outcome['hold_s'] >= 2.0
  for case, observer in (('one-observer', 1), ('span-45', 2)):
    way_m = moved_m(tmp_path, case, f'observer_{observer}')
    np.testing.assert_allclose(way_m[-1], DISPLACEMENT_M, atol=0.01)
  for outcome in (left, right):
    (failure,) = outcome['failures']
    assert re.fullmatch(
      r'message: none, motion 2 unknown: RMSE 0\.\d+ >= 0\.17', failure
    )
    assert outcome['start_s'] is outcome['decoded'] is None
    way_m = moved_m(tmp_path, 'span-45', outcome['observer'])
    assert np.abs(way_m).max() < 1e-3
    assert f'  span-45, {outcome["observer"]}: {failure}' in wide['stdout']


@pytest.mark.long
def test_every_row_gives_what_the_paper_published(
  run: Run, tmp_path: pathlib.Path
) -> None:
  rows = run()
  assert [*rows] == [case.name for case in suites.find('paper')]
  for case in suites.find('paper'):
    row = rows[case.name]
    ours = suites.Published(row['correct'], row['passed'])
    assert ours == case.published, case.name
    everybody = set(range(1, case.scene.observers + 1))
    readers = everybody if case.published.correct else set()
    if case.name == 'black-input':
      readers = everybody - {2}
    readers = READERS.get(case.name, readers)
    for number, outcome in enumerate(row['outcomes'], 1):
      expected = case.scene.payload if number in readers else None
      assert outcome['decoded'] == expected, (case.name, number)
      if number not in readers:
        way_m = moved_m(tmp_path, case.name, f'observer_{number}')
        assert np.abs(way_m).max() < 1e-3, (case.name, number)
  stdout = rows['default']['stdout']
  assert 'messages correct: 44/53 (83.02%), paper 44/53' in stdout
  assert 'broadcasts passed: 13/17 (76.47%), paper 13/17' in stdout
  assert 'messages correct: 14/14 (100.00%), paper 14/14' in stdout
  assert stdout.count('broadcasts passed: 3/3 (100.00%), paper 3/3') == 2
