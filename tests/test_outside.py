"""Code of one's own is part of what tells results apart: all of it, or none."""

from collections.abc import Callable, Iterator
import dataclasses
import functools
import importlib.util
import itertools
import json
import pathlib
import subprocess
import sys
import types

import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.record import (
  encoding,
  provenance,
  scenario_fields,
  source_files,
  writer,
)
from waggle_tasks.experiments.studies import (
  pool,
  runner,
  suite_study,
  sweep_cases,
  sweep_study,
)

Write = Callable[[str, str], types.ModuleType]
SCENE = scenario.Scenario()
RECEIVER = """
from waggle_tasks.agents import receiver
{head}

class Mine(receiver.KltReceiver):
  {body}
"""
_NUMBERS = itertools.count()


@pytest.fixture
def home(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[pathlib.Path]:
  """A folder from which modules are imported, each test anew."""
  monkeypatch.syspath_prepend(tmp_path)
  before = {*sys.modules}
  yield tmp_path
  for name in {*sys.modules} - before:
    if str(tmp_path) in str(getattr(sys.modules[name], '__file__', '')):
      del sys.modules[name]


@pytest.fixture
def write(home: pathlib.Path) -> Write:
  """Writes a module, and returns it newly imported."""

  def new(name: str, text: str) -> types.ModuleType:
    path = home / f'{name.replace(".", "/")}.py'
    path.parent.mkdir(exist_ok=True)
    # The size differs each time: an import must not take what it compiled.
    path.write_text(f'{text}\n#{"#" * next(_NUMBERS)}\n', encoding='utf-8')
    importlib.invalidate_caches()
    sys.modules.pop(name, None)
    return importlib.import_module(name)

  return new


@pytest.fixture
def registered(monkeypatch: pytest.MonkeyPatch) -> Callable[[object], None]:
  """Registers a receiver as 'mine'."""

  def register(made: object) -> None:
    monkeypatch.setitem(receivers.RECEIVERS, 'mine', made)

  return register


def identity(name: str = 'mine', scene: scenario.Scenario = SCENE) -> str:
  return identity_lib.of(scene, name, 'a')


def test_what_the_project_brings_has_no_source_outside() -> None:
  for name in receivers.RECEIVERS:
    assert outside.paths(name, [SCENE]) == {}


def test_an_edited_receiver_is_another(
  write: Write, registered: Callable[[object], None]
) -> None:
  text = RECEIVER.format(head='', body='pass')
  registered(write('mine', text).Mine)
  first = identity()
  assert identity() == first
  assert identity() != identity('klt')
  edited = text.replace('pass', 'def step(self, *_):\n    return ()')
  registered(write('mine', edited).Mine)
  assert identity() != first


# How a receiver may depend on a module `helper` that is edited.
HELPED = {
  'a module': ('import helper', 'X = 1'),
  'a name of it': ('from helper import X', 'pass'),
  'when it is called': ('', 'def step(self, *_):\n    import helper'),
  'by its name': ('import importlib', 'H = importlib.import_module("helper")'),
  'through another': ('import between', 'pass'),
  'as its base': ('', 'pass'),
}


@pytest.mark.parametrize('how', HELPED)
def test_what_a_receiver_is_made_of_counts_too(
  how: str, write: Write, registered: Callable[[object], None]
) -> None:
  head, body = HELPED[how]
  helper = RECEIVER.format(head='X = 1', body='pass')
  write('helper', helper)
  write('between', 'from helper import X')
  text = RECEIVER.format(head=head, body=body)
  if how == 'as its base':
    text = 'import helper\nclass Mine(helper.Mine):\n  pass'
  made = write('mine', text).Mine
  registered(made)
  first = identity()
  write('helper', helper.replace('X = 1', 'X = 2'))
  assert identity() != first
  assert {'mine', 'helper'} <= {*outside.paths('mine', [SCENE])}


def test_a_package_is_followed_by_its_relative_imports(
  write: Write, registered: Callable[[object], None], home: pathlib.Path
) -> None:
  (home / 'lab').mkdir()
  (home / 'lab' / '__init__.py').touch()
  write('lab.helper', 'X = 1')
  text = RECEIVER.format(head='from . import helper', body='pass')
  registered(write('lab.mine', text).Mine)
  found = outside.paths('mine', [SCENE])
  assert {*found} == {'lab', 'lab.mine', 'lab.helper'}


def test_a_receiver_that_is_made_by_a_function_is_known_by_it(
  write: Write, registered: Callable[[object], None]
) -> None:
  text = RECEIVER.format(head='', body='pass')
  made = write('mine', text).Mine
  factory = functools.partial(made)
  factory.DEFAULT = made.DEFAULT
  registered(factory)
  first = identity()
  registered(write('mine', text + '# edited').Mine)
  assert identity() != first


def test_other_numbers_of_an_equal_source_are_another(
  write: Write, registered: Callable[[object], None]
) -> None:
  made = write('mine', RECEIVER.format(head='', body='pass')).Mine
  registered(made)
  first = identity()
  default = receivers.configure('max_rmse=0.2', made.DEFAULT)
  made.DEFAULT = default
  assert identity() != first


ROWS = """
from waggle_tasks.arenas import layouts

class Rows:
  def __init__(self, radius_m):
    self.radius_m = radius_m
  def poses(self, count):
    spread = layouts.spread(count)
    return tuple(
      layouts.facing_performer(0.5 * s, -self.radius_m) for s in spread
    )
"""


def test_a_layout_counts_with_its_source_its_numbers_and_its_poses(
  write: Write,
) -> None:
  def scene(text: str, radius_m: float = 1.3) -> scenario.Scenario:
    made = write('rows', text).Rows
    return dataclasses.replace(SCENE, layout=made(radius_m))

  plain = scene(ROWS)
  seen = {identity('klt', SCENE), identity('klt', plain)}
  seen.add(identity('klt', dataclasses.replace(plain, layout=SCENE.layout)))
  assert len(seen) == 2
  seen.add(identity('klt', scene(ROWS, 1.2)))
  seen.add(identity('klt', scene(ROWS.replace('0.5 * s', '0.6 * s'))))
  assert len(seen) == 4
  held = json.loads(encoding.dumps(writer.config(plain, 'klt')))
  assert held['scenario']['layout']['rows:Rows']['radius_m'] == 1.3


def test_a_scenario_and_a_task_of_ones_own_count(
  write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
  text = 'from waggle_tasks import scenario\nclass Own(scenario.Scenario):'
  own = write('own', f'{text}\n  stops_s = 3.0').Own()
  first = identity('klt', own)
  assert first != identity('klt')
  assert identity('klt', write('own', f'{text}\n  stops_s = 4.0').Own()) != (
    first
  )
  task = (
    'import functools\nfrom waggle_tasks import registry\n'
    '@functools.wraps(registry.build)\n'
    'def build(scene):\n  return registry.build(scene)'
  )
  monkeypatch.setattr(registry, 'build', write('task', task).build)
  assert {*outside.paths('klt', [SCENE])} == {'task'}


def test_an_installed_package_is_known_by_the_list_of_its_files(
  write: Write, registered: Callable[[object], None]
) -> None:
  text = RECEIVER.format(head='import numpy, json, os.path', body='pass')
  registered(write('mine', text).Mine)
  found = outside.paths('mine', [SCENE])
  assert {*found} == {'mine', 'numpy', 'numpy/RECORD'}


@pytest.mark.parametrize('space', [{'__name__': '__main__'}, {}])
def test_what_has_no_source_is_refused(
  space: dict[str, object],
  registered: Callable[[object], None],
  tmp_path: pathlib.Path,
) -> None:
  body = 'def step(self, *_):\n    return ()'
  exec(RECEIVER.format(head='', body=body), space)
  registered(space['Mine'])
  cases = sweep_cases.cases({}, scenario_fields.defaults(), 1)
  error = r'^Mine decides results and must come from a file, .*import it$'
  with pytest.raises(source_files.UnknownSourceError, match=error):
    identity()
  for study in (
    sweep_study.Sweep(cases, 'mine'),
    suite_study.Suite(cases, 'mine', run_page.leave),
  ):
    with pytest.raises(source_files.UnknownSourceError, match=error):
      runner.run(study, tmp_path / 'results', pool.run, 'waggle x')
  assert not (tmp_path / 'results').exists()


def test_a_module_that_was_loaded_by_its_path_is_known(
  registered: Callable[[object], None], tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'mine.py'
  body = 'def step(self, *_):\n    return ()'
  path.write_text(RECEIVER.format(head='', body=body))
  spec = importlib.util.spec_from_file_location('loaded', path)
  module = importlib.util.module_from_spec(spec)
  spec.loader.exec_module(module)
  registered(module.Mine)
  assert outside.paths('mine', [SCENE]) == {'loaded': path}


@pytest.mark.slow
def test_one_flight_of_what_has_no_source_is_flown_with_a_note(
  tmp_path: pathlib.Path,
) -> None:
  program = RECEIVER.format(head='', body='pass') + (
    'from waggle_tasks.agents import receivers\n'
    'from waggle_tasks.experiments import main\n'
    'receivers.RECEIVERS["mine"] = Mine\n'
    'main.main(["waggle", "broadcast", "--receiver=mine", "--output=run",'
    ' "--control=no_send", "--observers=1", "--duration_s=0.2"])'
  )
  child = subprocess.run(
    [sys.executable, '-'], input=program, cwd=tmp_path, capture_output=True,
    text=True, check=True,
  )  # fmt: skip
  note = 'provenance.json will not be complete: Mine decides results and must'
  assert child.stderr.startswith(note)
  assert (tmp_path / 'run' / 'result.json').exists()


def test_sources_that_change_meanwhile_are_noticed(
  write: Write, registered: Callable[[object], None], home: pathlib.Path
) -> None:
  registered(write('mine', RECEIVER.format(head='', body='pass')).Mine)
  foreign = outside.paths('mine', [SCENE])
  hashes = provenance.deciding_hashes() | source_files.hashes(foreign)
  provenance.check_unchanged(hashes, 'sweep', foreign)
  (home / 'mine.py').write_text('# edited')
  with pytest.raises(provenance.SourceError, match='must not change'):
    provenance.check_unchanged(hashes, 'sweep', foreign)


PROGRAM = """
import sys
import mine
from waggle_tasks.agents import receivers
from waggle_tasks.experiments import main

receivers.RECEIVERS['mine'] = mine.Mine
if __name__ == '__main__':
  sys.exit(main.main(['waggle', *sys.argv[1:]]))
"""


@pytest.mark.long
@pytest.mark.parametrize(
  'command', ['sweep', pytest.param('suite', marks=pytest.mark.long)]
)
def test_an_edited_receiver_is_flown_anew(
  command: str, tmp_path: pathlib.Path
) -> None:
  (tmp_path / 'program.py').write_text(PROGRAM)
  text = RECEIVER.format(head='', body='pass')
  (tmp_path / 'mine.py').write_text(text)
  case = {'name': 'a', 'task': 'no_send', 'duration_s': 0.2, 'observers': 1}
  (tmp_path / 'own.json').write_text(json.dumps([case]))
  line = {
    'sweep': ['sweep', '--control=no_send', '--duration_s=0.2', '--observers=1',
              '--grid=distance_m=1.3'],
    'suite': ['suite', '--suite=own.json'],
  }[command]  # fmt: skip
  line = [
    sys.executable,
    'program.py',
    *line,
    '--receiver=mine',
    '--output=out',
  ]

  def identities() -> list[str]:
    child = subprocess.run(
      line, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert child.returncode == 0, child.stderr
    text = (tmp_path / 'out' / 'results.jsonl').read_text(encoding='utf-8')
    return [json.loads(row)['identity'] for row in text.splitlines()]

  first = identities()
  assert identities() == first
  (tmp_path / 'mine.py').write_text(f'{text}# edited\n')
  assert identities() != first
