"""What a run leaves behind: all of it, or nothing."""

import contextlib
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.agents import observer_agent, receiver, recogniser
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import encoding, folders, writer
from waggle_tasks.protocol import frame, payload
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety


def left_in(folder: pathlib.Path) -> list[str]:
  """Everything below a folder, hidden things too."""
  return sorted(str(p.relative_to(folder)) for p in folder.rglob('*'))


def test_a_folder_appears_once_it_is_complete(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'run'
  with folders.new_folder(path) as draft:
    assert draft.is_dir()
    (draft / 'a.txt').write_text('a')
    assert not path.exists()
    (draft / 'b.txt').write_text('b')
  assert left_in(tmp_path) == ['run', 'run/a.txt', 'run/b.txt']


def test_its_parents_are_made(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'of' / 'mine' / 'run'
  with folders.new_folder(path):
    pass
  assert path.is_dir()


@pytest.mark.parametrize('error', [KeyboardInterrupt, ValueError, SystemExit])
@pytest.mark.parametrize('path', ['run', 'of/mine/run'])
def test_an_interrupted_run_leaves_nothing(
  error: type[BaseException], path: str, tmp_path: pathlib.Path
) -> None:
  def work() -> None:
    with folders.new_folder(tmp_path / path) as draft:
      (draft / 'half.txt').write_text('ha')
      raise error

  with pytest.raises(error):
    work()
  assert left_in(tmp_path) == []


@pytest.mark.parametrize('kind', ['folder', 'file', 'link', 'dangling link'])
def test_what_exists_is_never_overwritten(
  kind: str, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'run'
  match kind:
    case 'folder':
      path.mkdir()
      (path / 'mine.txt').write_text('mine')
    case 'file':
      path.write_text('mine')
    case 'link':
      path.symlink_to(tmp_path)
    case 'dangling link':
      path.symlink_to(tmp_path / 'nowhere')
  before = left_in(tmp_path)
  with (
    pytest.raises(folders.OutputError) as caught,
    folders.new_folder(path),
  ):
    raise AssertionError('the work must not begin')
  assert str(caught.value) == f'`output` must not exist yet: {path} does'
  assert left_in(tmp_path) == before


def test_what_appears_meanwhile_is_not_overwritten_either(
  tmp_path: pathlib.Path,
) -> None:
  path = tmp_path / 'run'

  def work() -> None:
    with folders.new_folder(path) as draft:
      (draft / 'new.txt').write_text('new')
      path.mkdir()
      (path / 'mine.txt').write_text('mine')

  with pytest.raises(folders.OutputError, match='`output` must be writable'):
    work()
  assert left_in(tmp_path) == ['run', 'run/mine.txt']


@pytest.mark.parametrize(
  'path', ['/proc/run', '/dev/null/run', f'{__file__}/run', '/proc/a/b/run']
)
def test_a_place_that_cannot_be_written_is_named_before_the_work(
  path: str,
) -> None:
  with (
    pytest.raises(folders.OutputError) as caught,
    folders.new_folder(pathlib.Path(path)),
  ):
    raise AssertionError('the work must not begin')
  assert str(caught.value).startswith('`output` must be writable: ')
  assert str(pathlib.Path(path).parent.parent) in str(caught.value)


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
def test_a_folder_without_permission_is_named(tmp_path: pathlib.Path) -> None:
  tmp_path.chmod(0o500)
  error = f'`output` must be writable: {tmp_path} is not'
  with (
    pytest.raises(folders.OutputError, match=error),
    folders.new_folder(tmp_path / 'run'),
  ):
    raise AssertionError('the work must not begin')


def test_two_runs_beside_each_other_do_not_meet(
  tmp_path: pathlib.Path,
) -> None:
  with folders.new_folder(tmp_path / 'a') as first:
    (first / 'a.txt').write_text('a')
    with folders.new_folder(tmp_path / 'b') as second:
      (second / 'b.txt').write_text('b')
  assert left_in(tmp_path) == ['a', 'a/a.txt', 'b', 'b/b.txt']


def test_a_run_that_was_killed_does_not_block_its_name(
  tmp_path: pathlib.Path,
) -> None:
  path = tmp_path / 'run'
  work = f"""
import os, pathlib
from waggle_tasks.experiments.record import folders
with folders.new_folder(pathlib.Path({str(path)!r})) as draft:
  (draft / 'half.txt').write_text('ha')
  os.kill(os.getpid(), 9)
"""
  child = subprocess.run([sys.executable, '-c', work], check=False)
  assert child.returncode == -signal.SIGKILL
  assert len(left_in(tmp_path)) == 3
  with folders.new_folder(path) as draft:
    (draft / 'whole.txt').write_text('whole')
  assert left_in(tmp_path) == ['run', 'run/whole.txt']


def test_a_name_that_another_run_is_writing_is_refused_before_the_work(
  tmp_path: pathlib.Path,
) -> None:
  path = tmp_path / 'run'
  error = f'`output` must not be in use: another run is writing {path}'

  def second() -> None:
    with folders.new_folder(path):
      raise AssertionError('the work must not begin')

  with folders.new_folder(path) as draft:
    with pytest.raises(folders.OutputError, match=re.escape(error)):
      second()
    (draft / 'mine.txt').write_text('mine')
  assert left_in(tmp_path) == ['run', 'run/mine.txt']


def test_the_next_free_folder_is_counted(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.chdir(tmp_path)
  for number in (1, 3, 4):
    with folders.next_folder('broadcast') as (draft, path):
      (draft / 'a.txt').write_text('a')
    assert path == pathlib.Path('runs', f'broadcast-{number}')
    (tmp_path / 'runs' / 'broadcast-2').touch()
  with folders.next_folder('suite') as (_, path):
    assert path == pathlib.Path('runs/suite-1')


def test_runs_that_begin_together_get_folders_of_their_own(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.chdir(tmp_path)
  with contextlib.ExitStack() as stack:
    begun = [
      stack.enter_context(folders.next_folder('broadcast')) for _ in range(4)
    ]
    for number, (draft, path) in enumerate(begun, 1):
      assert path == pathlib.Path('runs', f'broadcast-{number}')
      (draft / f'{number}.txt').touch()
  found = [name for name in left_in(tmp_path / 'runs') if '/' in name]
  assert found == [f'broadcast-{n}/{n}.txt' for n in range(1, 5)]


def test_an_interrupted_run_leaves_the_next_number_free(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.chdir(tmp_path)

  def work() -> None:
    with folders.next_folder('broadcast'):
      raise KeyboardInterrupt

  with pytest.raises(KeyboardInterrupt):
    work()
  assert left_in(tmp_path) == []


@pytest.mark.parametrize('path', ['new/..', '..', '/'])
def test_what_is_no_name_is_refused_before_the_work(path: str) -> None:
  with (
    pytest.raises(folders.OutputError, match='`output` must end in a name'),
    folders.new_folder(pathlib.Path(path)),
  ):
    raise AssertionError('the work must not begin')


FORWARD = payload.Payload.from_bits('000010')
SCORES = recogniser.Recognition(
  Symbol.UNKNOWN, 'RMSE 0.1758 >= 0.17', Symbol.ZERO, 0.1758, 0.2, 0.01, 90.0
)


def rollout() -> rollout_lib.Rollout:
  """Two observers, one of which starts and is refused."""
  state = frame.State.START
  first = receiver.Event(3.0, Symbol.NULL, state)
  unknown = receiver.Event(
    12.0, Symbol.UNKNOWN, state, SCORES, rejection='expected a bit'
  )
  last = receiver.Event(95.6, Symbol.NULL, state, message=FORWARD)
  start = observer_agent.Navigation(
    95.6, observer_agent.Deed.START, (0.0, -0.9, 1.3), FORWARD, 2391, 'ab'
  )
  refusal = safety.Refusal(95.6, 'observer_1', 'too near')
  return rollout_lib.Rollout(
    times_s=np.arange(3) * 0.04,
    positions_m={'performer': np.zeros((3, 3))},
    contacts=(),
    events={
      'observer_1': (first, last, start, refusal),
      'observer_2': (first, unknown),
    },
    renderer='none',
  )


def test_events_are_lines_of_json_in_order_of_time() -> None:
  lines = [json.loads(line) for line in writer.event_lines(rollout())]
  assert [(line['time_s'], line['observer']) for line in lines] == [
    (3.0, 'observer_1'),
    (3.0, 'observer_2'),
    (12.0, 'observer_2'),
    (95.6, 'observer_1'),
    (95.6, 'observer_1'),
    (95.6, 'observer_1'),
  ]
  kinds = [line['kind'] for line in lines]
  assert kinds == ['event'] * 4 + ['navigation', 'refusal']
  null, _, unknown, last, start, refusal = lines
  assert (null['symbol'], null['recognition']) == ('NULL', None)
  assert unknown['symbol'] == 'UNKNOWN'
  assert unknown['recognition']['reason'] == 'RMSE 0.1758 >= 0.17'
  assert unknown['recognition']['best'] == '0'
  assert unknown['recognition']['rmse'] == 0.1758
  assert unknown['rejection'] == 'expected a bit'
  assert last['message'] == start['payload'] == '000010'
  assert start['deed'] == 'navigation start'
  assert start['target_m'] == [0.0, -0.9, 1.3]
  assert (start['images'], start['provenance']) == (2391, 'ab')
  assert refusal['reason'] == 'too near'


def test_event_lines_repeat_byte_for_byte() -> None:
  assert [*writer.event_lines(rollout())] == [*writer.event_lines(rollout())]


@pytest.mark.parametrize('value', [math.nan, math.inf, np.array([math.nan])])
def test_what_json_cannot_hold_is_refused(value: object) -> None:
  with pytest.raises(ValueError, match='JSON compliant'):
    encoding.dumps({'value': value})
  with pytest.raises(ValueError, match='JSON compliant'):
    encoding.pretty({'value': value})


def test_a_configuration_holds_every_choice() -> None:
  scene = scenario.Scenario(seed=7, jitter_m=0.01)
  held = json.loads(encoding.dumps(writer.config(scene, 'klt')))
  assert held['receiver'] == 'klt'
  fields = held['scenario']
  assert {*fields} == {*scenario.Scenario.__dataclass_fields__}
  assert (fields['seed'], fields['jitter_m']) == (7, 0.01)
  assert fields['payload'] == '000010'
  assert fields['pauses']['gap_s'] == 2.0
  assert fields['units']['distance_unit_m'] == 0.2
  assert fields['appearance']['shadows'] is False
  symbols = [each['symbol'] for each in fields['codebook']['gestures']]
  assert sorted(symbols) == ['0', '1', 'END', 'START']


def test_a_layout_of_ones_own_is_written_with_its_name() -> None:
  scene = scenario.Scenario(layout=layouts.Line(1.5, 0.7))
  held = writer.config(scene, 'klt')['scenario']['layout']
  fields = {'separation_m': 1.5, 'spacing_m': 0.7}
  assert held == {'waggle_tasks.arenas.layouts:Line': fields}


def test_the_name_of_a_file_is_kept_until_it_is_written(
  tmp_path: pathlib.Path,
) -> None:
  path = tmp_path / 'all.json'

  def second() -> None:
    with folders.claimed(path, 'json'):
      raise AssertionError('the work must not begin')

  with folders.claimed(path, 'json'):
    with pytest.raises(folders.OutputError, match='`json` must not be in use'):
      second()
    files.put(path, '{}')
  with pytest.raises(folders.OutputError, match='`json` must be a new file'):
    second()
  assert left_in(tmp_path) == ['all.json']
