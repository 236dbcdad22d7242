"""`waggle broadcast`, end to end: a dance is flown, seen, read and followed.

Also what it leaves behind, and that the same scenario repeats byte for byte.
"""

from collections.abc import Callable
import dataclasses
import itertools
import json
import pathlib
import subprocess

import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import archive, encoding, writer
from waggle_tasks.protocol import flight

Waggle = Callable[..., subprocess.CompletedProcess[str]]
OBSERVERS = ('observer_1', 'observer_2', 'observer_3')
FRAME = 'NULL START NULL 0 NULL 0 NULL 0 NULL 0 NULL 1 NULL 0 NULL END NULL'


@dataclasses.dataclass(frozen=True)
class Run:
  """A finished run: what it said, and its folder."""

  child: subprocess.CompletedProcess[str]
  folder: pathlib.Path

  def json(self, name: str) -> dict[str, object]:
    return json.loads((self.folder / name).read_text(encoding='utf-8'))

  def events(self, observer: str) -> list[dict[str, object]]:
    text = (self.folder / 'events.jsonl').read_text(encoding='utf-8')
    lines = [json.loads(line) for line in text.splitlines()]
    return [line for line in lines if line['observer'] == observer]


@pytest.fixture(scope='module')
def run(new_waggle: Waggle, tmp_path_factory: pytest.TempPathFactory) -> Run:
  """The main job, as a newcomer runs it."""
  home = tmp_path_factory.mktemp('home')
  return Run(new_waggle('broadcast', cwd=home), home / 'runs' / 'broadcast-1')


@pytest.fixture(scope='module')
def flown(run: Run) -> archive.Run:
  """The same run read back, with the truth of it."""
  return archive.load(run.folder)


@pytest.mark.slow
def test_it_passes_and_says_so(run: Run) -> None:
  assert run.child.returncode == 0, run.child.stderr
  lines = run.child.stdout.splitlines()
  header, _, *rows = itertools.takewhile(str.strip, lines)
  for word in ('observer', 'decoded', 'END', 'final null', 'start', 'arrival'):
    assert word in header
  assert [row.split()[:3] for row in rows] == [
    [name, '000010', '000010'] for name in OBSERVERS
  ]
  assert 'Group passed: 3 of 3 observers decoded 000010.' in lines
  assert str(pathlib.Path('runs/broadcast-1')) in lines[-1]
  assert 's simulated' in run.child.stderr  # The progress bar.


@pytest.mark.slow
def test_it_keeps_the_times_of_the_paper(run: Run) -> None:
  result = run.json('result.json')
  assert (result['passed'], result['correct']) == (True, 3)
  assert [each['observer'] for each in result['outcomes']] == [*OBSERVERS]
  for each in result['outcomes']:
    assert each['expected'] == each['decoded'] == '000010'
    assert each['end_s'] == pytest.approx(92.6, abs=0.2)
    assert each['final_null_s'] - each['end_s'] == pytest.approx(3.0, abs=0.05)
    assert each['start_s'] == each['final_null_s']
    assert 0 < each['arrival_s'] - each['start_s'] < 3.5
    assert each['hold_s'] >= 2.0
    assert each['error_m'] < 0.015
    assert each['failures'] == []


@pytest.mark.slow
@pytest.mark.parametrize('name', OBSERVERS)
def test_each_log_tells_a_whole_frame_then_a_start_and_an_arrival(
  name: str, run: Run
) -> None:
  events = run.events(name)
  assert ' '.join(each['symbol'] for each in events[:17]) == FRAME
  assert [each['kind'] for each in events[17:]] == ['navigation'] * 2
  final, start, arrival = events[16:]
  assert final['message'] == start['payload'] == arrival['payload'] == '000010'
  assert (start['deed'], arrival['deed']) == ('navigation start', 'arrival')
  assert start['time_s'] == final['time_s']
  # Every image up to the final null was read, and none after it.
  assert start['images'] == arrival['images'] == start['time_s'] * 25 + 1
  assert len(start['provenance']) == 64
  times_s = [each['time_s'] for each in events]
  assert times_s == sorted(times_s)


@pytest.mark.slow
def test_every_motion_was_accepted_by_the_papers_limits(run: Run) -> None:
  for name in OBSERVERS:
    scores = [each.get('recognition') for each in run.events(name)]
    motions = [each for each in scores if each]
    assert len(motions) == 8
    for each in motions:
      assert each['reason'] == ''
      assert each['rmse'] < 0.17
      assert each['margin'] > 0.075
      assert each['closure'] < 0.18
      assert each['span_px'] >= 28


@pytest.mark.slow
def test_three_observers_read_images_of_their_own(run: Run) -> None:
  chains = {run.events(name)[17]['provenance'] for name in OBSERVERS}
  assert len(chains) == 3


@pytest.mark.slow
def test_the_run_folder_holds_everything_and_nothing_is_beside_it(
  run: Run,
) -> None:
  files = {path.name for path in run.folder.iterdir()}
  needed = {'config.json', 'events.jsonl', 'result.json', 'provenance.json'}
  assert files >= needed
  home = run.folder.parents[1]
  assert [path.name for path in home.iterdir()] == ['runs']
  assert [path.name for path in (home / 'runs').iterdir()] == [run.folder.name]
  config = run.json('config.json')
  assert config['receiver'] == 'klt'
  expected = writer.config(scenario.Scenario(), 'klt')
  assert config == json.loads(encoding.dumps(expected))
  origin = run.json('provenance.json')
  assert origin['command'] == 'waggle broadcast'
  assert origin['versions']['dm-control'] == '1.0.50'
  assert origin['renderer']
  assert 'waggle_tasks.agents.klt' in origin['sources']


@pytest.mark.slow
def test_everybody_moved_by_the_message_and_not_before_its_own_null(
  flown: archive.Run,
) -> None:
  for outcome in flown.result.outcomes:
    positions_m = flown.positions_m[outcome.observer]
    moved_m = positions_m - positions_m[0]
    waiting = flown.times_s <= outcome.final_null_s
    assert np.linalg.norm(moved_m[waiting], axis=1).max() < 1e-3
    np.testing.assert_allclose(moved_m[-1], (0.0, 0.4, 0.0), atol=0.015)
    np.testing.assert_allclose(positions_m[:, 2], 1.3, atol=1e-3)


@pytest.mark.slow
def test_who_arrived_keeps_its_place(flown: archive.Run) -> None:
  for outcome in flown.result.outcomes:
    positions_m = flown.positions_m[outcome.observer]
    held = flown.times_s >= outcome.arrival_s
    assert np.count_nonzero(held) > 2.0 * 25
    apart_m = np.linalg.norm(positions_m[held] - positions_m[-1], axis=1)
    assert apart_m.max() < flight.ARRIVAL_ERROR_M


@pytest.mark.slow
def test_nobody_came_near_another(flown: archive.Run) -> None:
  places_m = [*flown.positions_m.values()]
  for one, other in itertools.combinations(places_m, 2):
    assert np.linalg.norm(one - other, axis=1).min() > 0.16


SHORT_FLAGS = (
  '--half_width_m=0.12',
  '--start_height_m=0.25',
  '--gesture_s=2',
  '--initial_hover_s=3.2',
  '--settle_s=0.6',
  '--lead_in_s=1.8',
)


@pytest.mark.slow
def test_flags_make_another_dance_and_every_process_the_same_bytes(
  waggle: Waggle, tmp_path: pathlib.Path, short: dict[str, object]
) -> None:
  """Up to where START and the first bit are read: the rest is as they are."""
  given = (
    *SHORT_FLAGS,
    '--observers=1',
    '--payload=100010',
    '--jitter_m=0.01',
    '--seed=3',
    '--duration_s=14',
    '--output=of/mine',
  )
  child = waggle('broadcast', *given, cwd=tmp_path)
  assert child.returncode == 1, child.stderr
  made = Run(child, tmp_path / 'of' / 'mine')
  symbols = [each['symbol'] for each in made.events('observer_1')]
  assert symbols[:4] == ['NULL', 'START', 'NULL', '1']
  scene = registry.find(
    'broadcast', observers=1, payload='100010', jitter_m=0.01, seed=3,
    duration_s=14.0, **short,
  )  # fmt: skip
  expected = json.loads(encoding.dumps(writer.config(scene, 'klt')))
  assert made.json('config.json') == expected
  for _ in range(2):  # Once more in one process.
    played = rollout_lib.run(scene, 'klt')
    lines = ''.join(f'{line}\n' for line in writer.event_lines(played))
    assert (made.folder / 'events.jsonl').read_bytes() == lines.encode()
  command = made.json('provenance.json')['command']
  assert '--payload=100010' in command
  assert '--gesture_s=2.0' in command


def test_a_group_that_fails_exits_with_1_and_is_recorded(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle('broadcast', '--duration_s=4', '--output=run', cwd=tmp_path)
  assert child.returncode == 1
  assert 'Group FAILED: 0 of 3 observers decoded 000010.' in child.stdout
  made = Run(child, tmp_path / 'run')
  result = made.json('result.json')
  assert (result['passed'], result['correct']) == (False, 0)
  why = 'message: none, still waited for start at the end'
  for number, each in enumerate(result['outcomes'], 1):
    assert each['failures'] == [why]
    assert f'observer_{number}: {why}' in child.stdout
