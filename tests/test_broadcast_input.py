"""`waggle broadcast` and bad input: one clear line, and nothing left behind."""

from collections.abc import Callable
import json
import pathlib
import re
import signal
import subprocess
import sys

import pytest

from waggle_tasks.experiments.record import scenario_fields

# Runs many command lines in one process, each from fresh flags.
DRIVER = """
import contextlib, io, json, os, shutil, sys
from absl import flags
from waggle_tasks.experiments import main
before = {*os.listdir()}
for line in json.load(sys.stdin):
  out, err = io.StringIO(), io.StringIO()
  with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
    status = main.main(['waggle', 'broadcast', *line])
  for name in flags.FLAGS:
    flags.FLAGS[name].unparse()
  left = sorted({*os.listdir()} - before)
  for name in left:
    shutil.rmtree(name)
  print(json.dumps([status, out.getvalue(), err.getvalue(), left]))
"""

CASES = {
  '--payload=0000': '`payload` must be 6 characters of 0 and 1',
  '--payload=00002x': '`payload` must be 6 characters of 0 and 1',
  '--payload=': '`payload` must be 6 characters of 0 and 1',
  '--observers=0': '`observers` must be between 1 and 64: got 0',
  '--observers=-2': '`observers` must be between 1 and 64: got -2',
  '--observers=two': 'flag --observers=two: invalid literal',
  '--distance_m=-1.3': '`distance_m` must be between 0.2 and 4: got -1.3',
  '--distance_m=1e9': '`distance_m` must be between 0.2 and 4',
  '--half_span_deg=181': '`half_span_deg` must be between 0 and 180: got 181',
  '--layout=ring': "`layout` must be one of ['arc', 'line']: got 'ring'.",
  '--layout=lien': "got 'lien'. Did you mean line?",
  '--receiver=ktl': "got 'ktl'. Did you mean klt?",
  '--control=no_sned': "got 'no_sned'. Did you mean no_send",
  '--camera=fast': "`camera` must be one of ['incremental', 'full']",
  '--floor=grass': '`floor` must be one of',
  '--observer=3': 'unknown flag --observer. Did you mean --observers',
  '--config=none/config.json': 'none/config.json is no file',
  '--seed=-1': '`seed` must be between 0 and 4294967295: got -1',
  '--late_frames=26': '`late_frames` must be between 0 and 25: got 26',
  '--dropped_share=2': '`dropped_share` must be between 0 and 1: got 2.0',
  '--jitter_m=1': '`jitter_m` must be between 0 and 0.1: got 1.0',
  '--half_width_m=0': '`half_width_m` must be between 0.01 and 1.2',
  '--start_height_m=9': '`start_height_m` must be between 0.01 and 2',
  '--gesture_s=0': 'duration_s` must be between 0.1 and 60: got 0.0',
  '--performer_hover=mocup': "got 'mocup'. Did you mean mocap",
  '--observer_hover=mocap --hover_amplitude=-1': (
    '`hover_amplitude` must be between 0 and 2: got -1.0'
  ),
  '--observer_hover=log': '`hover_log` must be given where',
  '--hover_log=none.csv': 'none.csv is no file',
  '--observer_hover=mocap --layout=line --spacing_m=0.25': (
    'observer_1 and observer_2 must start at least'
  ),
  '--half_span_deg=180': 'observer_1 and observer_3 must start at least',
  '--layout=line --spacing_m=0.1': 'observer_1 and observer_2 must start',
  '--layout=line --observers=64': '`pose` of observer_1 must lie in the room',
  '--control=black_input --black_observer=4': '`black_observer` must be',
  'now': "takes only flags, --name=value: got 'now'.",
  '--output=mine': '`output` must not exist yet: mine does',
  '--output=mine/of.txt': '`output` must not exist yet: mine/of.txt does',
  '--output=mine/of.txt/run': '`output` must be writable: ',
  '--output=/proc/run': '`output` must be writable: ',
}
NUMBERS = (
  'distance_m',
  'half_span_deg',
  'spacing_m',
  'jitter_m',
  'stop_s',
  'duration_s',
  'brightness',
  'hover_amplitude',
  'initial_hover_s',
  'settle_s',
  'gap_s',
  'lead_in_s',
  'half_width_m',
  'start_height_m',
  'gesture_s',
  'heading_step_deg',
  'distance_unit_m',
)
NOT_FINITE = [
  f'--{name}={value}' for name in NUMBERS for value in ('nan', 'inf')
]
Answer = tuple[int, str, str, list[str]]
Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope='module')
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Answer]:
  """Status, output, error and what lies in the folder, for each line."""
  folder = tmp_path_factory.mktemp('bad')
  (folder / 'mine').mkdir()
  (folder / 'mine' / 'of.txt').write_text('mine')
  lines = [*CASES, *NOT_FINITE]
  child = subprocess.run(
    [sys.executable, '-c', DRIVER],
    input=json.dumps([line.split() for line in lines]),
    capture_output=True,
    text=True,
    check=True,
    cwd=folder,
  )
  rows = [json.loads(row) for row in child.stdout.splitlines()]
  assert (folder / 'mine' / 'of.txt').read_text() == 'mine'
  return dict(zip(lines, rows, strict=True))


def check(answer: Answer, words: str) -> None:
  status, out, err, left = answer
  assert status == 2
  assert out == ''
  (said,) = err.splitlines()
  assert said.startswith('waggle broadcast: ')
  assert words in said
  assert left == []


@pytest.mark.parametrize('line', CASES)
def test_bad_input_is_one_line_with_exit_status_2(
  line: str, answers: dict[str, Answer]
) -> None:
  check(answers[line], CASES[line])


@pytest.mark.parametrize('line', NOT_FINITE)
def test_what_is_not_a_finite_number_is_refused(
  line: str, answers: dict[str, Answer]
) -> None:
  check(answers[line], ' must be ')


COMMAND = [sys.executable, '-m', 'waggle_tasks.experiments.main', 'broadcast']


@pytest.mark.slow
def test_help_shows_a_flag_for_every_choice(waggle: Waggle) -> None:
  child = waggle('broadcast', '--help')
  assert child.returncode == 0, child.stderr
  for name in ('receiver', 'output', *NUMBERS):
    assert f'--{name}=' in child.stdout
  for name, default in scenario_fields.defaults().items():
    flag = f'--[no]{name} ' if isinstance(default, bool) else f'--{name}='
    assert flag in child.stdout
  assert '--observers=3 ' in child.stdout
  assert '--payload=000010 ' in child.stdout
  assert max(map(len, child.stdout.splitlines())) <= 80


@pytest.mark.slow
def test_a_machine_that_cannot_render_is_told_so_and_nothing_is_left(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  no_gl = {'MUJOCO_GL': 'egl', '__EGL_VENDOR_LIBRARY_FILENAMES': '/no/such'}
  child = waggle('broadcast', '--output=run', cwd=tmp_path, **no_gl)
  assert child.returncode == 2
  (said,) = child.stderr.splitlines()
  assert 'cannot render with MUJOCO_GL=egl' in said
  assert 'mend it: unset __EGL_VENDOR_LIBRARY_FILENAMES' in said
  assert [*tmp_path.iterdir()] == []


BRIEF = ('--control=no_send', '--observers=1', '--duration_s=2')


@pytest.mark.slow
@pytest.mark.parametrize(
  ('output', 'statuses', 'left'),
  [
    ((), [0, 0], ['broadcast-1', 'broadcast-2']),
    pytest.param(
      ('--output=runs/mine',), [0, 2], ['mine'], marks=pytest.mark.long
    ),
  ],
)
def test_two_at_once_never_fly_for_the_same_folder(
  output: tuple[str, ...],
  statuses: list[int],
  left: list[str],
  tmp_path: pathlib.Path,
) -> None:
  children = [
    subprocess.Popen(
      [*COMMAND, *BRIEF, f'--seed={seed}', *output],
      stdout=subprocess.DEVNULL,
      stderr=subprocess.PIPE,
      text=True,
      cwd=tmp_path,
    )
    for seed in range(2)
  ]
  said = [child.communicate(timeout=120)[1] for child in children]
  assert sorted(child.returncode for child in children) == statuses, said
  assert sorted(p.name for p in (tmp_path / 'runs').iterdir()) == left
  for child, err in zip(children, said, strict=True):
    if child.returncode == 2:
      (line,) = err.splitlines()  # No bar: it did not fly.
      assert line.startswith('waggle broadcast: `output` must not ')


@pytest.mark.slow
@pytest.mark.parametrize(
  ('number', 'status'),
  [
    (signal.SIGINT, 130),
    pytest.param(signal.SIGTERM, None, marks=pytest.mark.long),
    pytest.param(signal.SIGHUP, None, marks=pytest.mark.long),
  ],
)
def test_an_interrupted_run_leaves_no_half_written_file(
  number: signal.Signals, status: int | None, tmp_path: pathlib.Path
) -> None:
  child = subprocess.Popen(
    [*COMMAND, '--output=run'],
    stdout=subprocess.DEVNULL,
    stderr=subprocess.PIPE,
    text=True,
    cwd=tmp_path,
  )
  said = ''
  while not re.search(r' [1-9]\d*/104 s simulated', said):
    said += child.stderr.read(1)  # Until the episode is under way.
    assert child.poll() is None, said
  child.send_signal(number)
  _, err = child.communicate(timeout=60)
  assert child.returncode != 0
  if status is not None:
    assert child.returncode == status
    assert err.splitlines()[-1].endswith('waggle broadcast: interrupted')
  assert [*tmp_path.iterdir()] == []
