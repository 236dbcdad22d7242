"""`waggle suite` as its user sees it: its tables, its files, its errors."""

from collections.abc import Callable
import functools
import json
import pathlib
import re
import subprocess

import pytest

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def suite(waggle: Waggle, tmp_path: pathlib.Path) -> Waggle:
  """Runs `waggle suite` in a folder of its own."""
  return functools.partial(waggle, 'suite', cwd=tmp_path)


@pytest.mark.slow
def test_a_control_of_the_paper_is_flown_and_set_beside_it(
  suite: Waggle, tmp_path: pathlib.Path
) -> None:
  done = suite('--suite=controls', '--case=no-send', '--output=out/deep')
  assert done.returncode == 0, done.stderr
  head, rule, row, total = done.stdout.splitlines()[:4]
  assert re.split(r' {2,}', head) == [
    'controls: configuration', 'N', 'correct', 'paper', 'group', 'paper',
  ]  # fmt: skip
  assert set(rule) == {'-', ' '}
  assert re.split(r' {2,}', row) == [
    'Static, no send, 10 s', '3', '0/3', '0/3', 'Pass', 'Pass',
  ]  # fmt: skip
  assert total.startswith('broadcasts passed: 1/1 (100.00%), paper 1/1; 95 %')
  assert re.search(
    r'1 cases?, 10 s simulated, \d+ s of wall time .*out/deep', done.stdout
  )
  folder = tmp_path / 'out' / 'deep'
  (line,) = (folder / 'results.jsonl').read_text('utf-8').splitlines()
  row = json.loads(line)
  assert (row['case'], row['group']) == ('no-send', 'controls')
  assert row['published'] == {'correct': 0, 'passed': True}
  assert (row['correct'], row['passed'], row['expecting']) == (0, True, 0)
  assert row['scenario']['control'] == 'no_send'
  table = (folder / 'results.csv').read_text('utf-8').splitlines()
  assert table[0].startswith('group,case,receiver,observer,expected,decoded,')
  assert len(table) == 1 + 3
  origin = folder / 'cases' / 'no-send' / 'provenance.json'
  command = json.loads(origin.read_text('utf-8'))['command']
  assert (
    command == 'waggle suite --suite=controls --receiver=klt --case=no-send'
  )


@pytest.mark.slow
def test_flags_of_a_scenario_change_every_case(
  suite: Waggle, tmp_path: pathlib.Path
) -> None:
  changes = '--duration_s=0.08', '--dynamics=rotors', '--estimator=mocap'
  done = suite('--suite=controls', '--case=no-send', *changes)
  assert done.returncode == 0, done.stderr
  (folder,) = (tmp_path / 'runs').iterdir()
  assert folder.name == (
    'controls-klt-no-send-duration_s=0.08-dynamics=rotors-estimator=mocap'
  )
  (line,) = (folder / 'results.jsonl').read_text('utf-8').splitlines()
  scene = json.loads(line)['scenario']
  assert (scene['dynamics'], scene['estimator']) == ('rotors', 'mocap')
  assert scene['control'] == 'no_send'
  origin = folder / 'cases' / 'no-send' / 'provenance.json'
  command = json.loads(origin.read_text('utf-8'))['command']
  assert set(changes) < set(command.split())
  refused = suite('--suite=controls', '--wind_mps=1')
  assert refused.returncode == 2
  assert '`wind_mps` must not be given with `dynamics`' in refused.stderr


@pytest.mark.slow
def test_a_suite_of_ones_own_is_a_json_file(
  suite: Waggle, tmp_path: pathlib.Path
) -> None:
  rows = [
    {'name': 'still', 'task': 'no_send', 'duration_s': 0.04, 'group': 'quiet'},
    {'name': 'cut', 'observers': 1, 'duration_s': 0.04, 'label': 'Cut short'},
  ]
  # With the mark that editors on Windows put in front.
  (tmp_path / 'mine.json').write_text(json.dumps(rows), encoding='utf-8-sig')
  done = suite('--suite=mine.json', '--receiver=klt:hold_s=2.5', '--workers=1')
  assert done.returncode == 1, done.stderr  # The second reads nothing.
  assert 'quiet: configuration' in done.stdout
  assert 'own: configuration' in done.stdout
  assert re.search(
    r'^Cut short +1 +0/1 +- +Fail +-$', done.stdout, re.MULTILINE
  )
  assert 'cut, observer_1: message: none, no null was ever' in done.stdout
  folder = tmp_path / 'runs' / 'mine-klt:hold_s=2.5'
  lines = (folder / 'results.jsonl').read_text('utf-8').splitlines()
  assert [json.loads(line)['receiver'] for line in lines] == [
    'klt:hold_s=2.5'
  ] * 2


@pytest.mark.slow
def test_workers_that_cannot_render_say_so_in_one_line(
  suite: Waggle, tmp_path: pathlib.Path
) -> None:
  rows = [{'name': 'still', 'task': 'no_send', 'duration_s': 0.04}]
  (tmp_path / 'own.json').write_text(json.dumps(rows))
  done = suite('--suite=own.json', '--workers=1', MUJOCO_GL='disabled')
  assert done.returncode == 2
  said = done.stderr.splitlines()[-1]
  assert said.startswith('waggle suite: still failed 2 times, at last: cannot')
  assert said.endswith('mend it: export MUJOCO_GL=egl')


@pytest.mark.slow
def test_two_finished_folders_are_set_side_by_side_without_gl(
  suite: Waggle, reference: object, no_gl: dict[str, str]
) -> None:
  folder = str(reference.folder)
  done = suite(f'--compare={folder}', folder, **no_gl)
  assert done.returncode == 0, done.stderr
  assert re.search(r'(?m) 1 +0/1 +0/1 +Fail +Fail$', done.stdout)
  assert (
    'own, broadcasts: 0 passed only first, 0 only second; McNemar exact p = 1'
    in done.stdout
  )


# Bad input.
OWN = {
  'broken.json': '[{"name": "a"',
  'table.json': '{"name": "a"}',
  'empty.json': '[]',
  'field.json': '[{"name": "a", "distanc_m": 1}]',
  'value.json': '[{"name": "a"}, {"name": "b", "observers": 99}]',
  'text.json': '"abc"',
}
FLAGS = {
  '--suite=papr': r"`suite` must be one of \['standard', 'supplemental',"
  r" 'controls', 'paper'\]: got 'papr'. Did you mean paper",
  '--case=span-40,spn-45': "got 'spn-45'. Did you mean span-45",
  '--suite=standard --case=no-send': "`case` must be .*: got 'no-send'",
  '--suite=none.json': r'`suite` must be a readable JSON file: none\.json',
  '--suite=broken.json': '`suite` must be a readable JSON file: broken',
  '--suite=table.json': '`suite` must be a JSON list of cases: table',
  '--suite=text.json': '`suite` must be a JSON list of cases: text',
  '--suite=empty.json': 'one case the least',
  '--suite=field.json': r'case 1 \(a\): `distanc_m` must .*mean distance_m',
  '--suite=value.json': r'case 2 \(b\): `observers` must be between 1 and',
  '--workers=0': '`workers` must be between 1 and 1024: got 0',
  '--workers=-1': '`workers` must be between 1 and 1024: got -1',
  '--workers=two': 'flag --workers=two: .*an integer',
  '--receiver=kl': "`receiver` must be .*: got 'kl'. Did you mean klt",
  '--receiver=klt:hold=3': "got 'hold'. Did you mean hold_s",
  'paper': "takes only flags, --name=value: got 'paper'",
  '--scheduler=tcp://127.0.0.1:1': '`scheduler` (must be|needs an extra)',
  '--compare=WHOLE': '--compare takes two folders: got 1',
  '--compare=WHOLE WHOLE WHOLE': '--compare takes two folders: got 3',
  '--compare=WHOLE none': 'must name folders of finished suites: none',
  '--compare=WHOLE cut': 'must name folders of finished suites: cut',
  '--compare=number WHOLE': 'must name folders of finished suites: number',
  '--compare=WHOLE bare': 'must name folders of finished suites: bare',
  '--compare=WHOLE more': 'silent',
}


@pytest.fixture(scope='module')
def answers(
  tmp_path_factory: pytest.TempPathFactory,
  reference: object,
  ask: Callable[..., list],
) -> dict[str, tuple[int | str, str]]:
  """Exit status, or what was raised, and output of each line of `FLAGS`."""
  here = tmp_path_factory.mktemp('bad')
  for name, text in OWN.items():
    (here / name).write_text(text, encoding='utf-8')
  first, *others = reference.lines()
  # Of another scenario, although of the same name.
  more = {**first, 'observers': 2, 'outcomes': first['outcomes'] * 2}
  for name, rows in {
    'cut': [first, *others], 'number': [3], 'bare': [{'case': 'silent'}],
    'more': [more, *others],
  }.items():  # fmt: skip
    text = '\n'.join(map(json.dumps, rows))
    (here / name).mkdir()
    (here / name / 'results.jsonl').write_text(
      text[:-9] if name == 'cut' else text, encoding='utf-8'
    )
  argvs = []
  for line in FLAGS:
    argv = line.replace('WHOLE', str(reference.folder)).split()
    if not any(word.startswith(('--suite', '--case')) for word in argv):
      # Should it run all the same, it is over soon.
      argv = ['--suite=controls', '--case=no-send', *argv]
    argvs.append(['suite', '--output=out', *argv])
  return dict(zip(FLAGS, ask(argvs, here), strict=True))


@pytest.mark.parametrize('line', FLAGS)
def test_bad_input_is_one_line(
  answers: dict[str, tuple[int | str, str]], line: str
) -> None:
  status, said, _ = answers[line]
  assert status == 2, said
  assert said.count('\n') == 1
  assert said.startswith('waggle suite: ')
  assert re.search(FLAGS[line], said)
