"""Which room may import which, and what only launchers may do."""

import ast
import dataclasses
import pathlib
import pkgutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[1]

SIMULATOR = frozenset({'dm_control', 'dm_env', 'mujoco'})
# Modules beside the rooms that hold plain values and may be used by all.
OPEN = (
  '_version', 'appearance', 'doors', 'errors', 'eyes', 'msh', 'runtime',
  'sensor',
)  # fmt: skip


@dataclasses.dataclass(frozen=True)
class Room:
  """A folder, and what its files may import besides the standard library."""

  folder: str
  rooms: frozenset[str] = frozenset()
  others: frozenset[str] = frozenset()
  pattern: str = '**/*.py'

  def files(self) -> list[pathlib.Path]:
    return sorted((ROOT / self.folder).glob(self.pattern))


PARTS = frozenset({'protocol', 'entities', 'arenas'})
ROOMS = {
  'protocol': Room('waggle_tasks/protocol', others=frozenset({'numpy'})),
  'entities': Room(
    'entities',
    frozenset({'protocol'}),
    SIMULATOR | {'numpy', 'cv2', 'OpenGL', 'av'},
  ),
  'arenas': Room('arenas', frozenset({'protocol'}), SIMULATOR | {'numpy'}),
  'agents': Room(
    'agents', frozenset({'protocol'}), frozenset({'numpy', 'cv2', 'xxhash'})
  ),
  'tasks': Room('waggle_tasks/tasks', PARTS, SIMULATOR | {'numpy'}),
  'rl': Room(
    'waggle_tasks/rl',
    PARTS | {'tasks'},
    frozenset({'numpy', 'gymnasium', 'pettingzoo'}),
  ),
  '': Room('waggle_tasks', PARTS | {'tasks'}, SIMULATOR | {'numpy'}, '*.py'),
}
FILES = [
  pytest.param(name, room, path, id=str(path.relative_to(ROOT)))
  for name, room in ROOMS.items()
  for path in room.files()
  if path.name != '__main__.py'  # A launcher: it leads to all.
]


def imported(tree: ast.AST) -> set[str]:
  """Every dotted name that a file imports."""
  names = set()
  for node in ast.walk(tree):
    if isinstance(node, ast.Import):
      names |= {alias.name for alias in node.names}
    elif isinstance(node, ast.ImportFrom):
      assert node.level == 0, f'a relative import in line {node.lineno}'
      names |= {f'{node.module}.{alias.name}' for alias in node.names}
  return names


def is_allowed(name: str, home: str, room: Room) -> bool:
  """Whether a file of a room may import a dotted name."""
  top, _, rest = name.partition('.')
  if top in sys.stdlib_module_names:
    return True
  if top != 'waggle_tasks':
    return top in room.others
  part = rest.partition('.')[0]
  beside = (
    not (ROOT / part).is_dir() and not (ROOT / 'waggle_tasks' / part).is_dir()
  )
  if beside:  # A module of waggle_tasks itself.
    return part in OPEN or home in ('', 'tasks', 'rl')
  return part == home or part in room.rooms


@pytest.mark.parametrize(('home', 'room', 'path'), FILES)
def test_a_room_imports_only_what_the_table_allows(
  home: str, room: Room, path: pathlib.Path
) -> None:
  names = imported(ast.parse(path.read_text(encoding='utf-8')))
  if path == ROOT / 'waggle_tasks' / '__init__.py':
    # Its public names are of all rooms; they are imported when asked for.
    room = dataclasses.replace(room, rooms=room.rooms | {'agents'})
  assert {n for n in names if not is_allowed(n, home, room)} == set()


@pytest.mark.parametrize('module', OPEN)
def test_modules_open_to_all_import_no_room_but_protocol(module: str) -> None:
  path = ROOT / 'waggle_tasks' / f'{module}.py'
  names = imported(ast.parse(path.read_text(encoding='utf-8')))
  # The room that sees least of the project sets what they may import.
  agents = ROOMS['agents']
  assert {n for n in names if not is_allowed(n, 'agents', agents)} == set()


# Rooms of `experiments`, each with what it may import: those below it.
LAUNCHERS = 'launchers'
FLOORS = (
  'machine', 'record', 'episodes', 'studies', 'results', 'pages', 'video',
  'bench_parts', 'claim_parts', 'flags', LAUNCHERS,
)  # fmt: skip
NEVER = {
  'machine': {'record'},
  'record': {'episodes'},
  'pages': {'episodes', 'video'},
  'claim_parts': {'episodes', 'bench_parts', 'video'},
}
EXPERIMENTS = 'waggle_tasks.experiments.'


def floor_of(name: str) -> str:
  """The room of a dotted name inside of `experiments`."""
  part = name.removeprefix(EXPERIMENTS).partition('.')[0]
  return part if part in FLOORS else LAUNCHERS


def runs_up(home: str, name: str) -> bool:
  """Whether a file of a room of `experiments` must not import a name."""
  if not name.startswith(EXPERIMENTS):
    return False
  there = floor_of(name)
  if there == home:
    return False
  lower = FLOORS.index(there) < FLOORS.index(home)
  return not lower or there in NEVER.get(home, ())


@pytest.mark.parametrize(
  'path',
  [
    pytest.param(path, id=str(path.relative_to(ROOT)))
    for path in sorted((ROOT / 'experiments').rglob('*.py'))
  ],
)
def test_no_import_of_the_experiments_runs_up(path: pathlib.Path) -> None:
  home = path.relative_to(ROOT / 'experiments').parts[0]
  home = home if home in FLOORS else LAUNCHERS
  names = imported(ast.parse(path.read_text(encoding='utf-8')))
  assert {name for name in names if runs_up(home, name)} == set()
  absl = {name for name in names if name.startswith('absl')}
  assert not absl or home in ('flags', LAUNCHERS)


def test_every_room_has_a_floor() -> None:
  folders = {
    path.name
    for path in (ROOT / 'experiments').iterdir()
    if (path / '__init__.py').exists()
  }
  assert folders == {*FLOORS} - {LAUNCHERS}


@pytest.mark.parametrize(
  ('home', 'name'),
  [
    ('record', 'pages.run_page'),
    ('studies', 'launch'),
    ('results', 'pages.markup'),
    ('pages', 'episodes.rollout'),
    ('machine', 'record.folders'),
    ('studies', 'flags.receiver_flag'),
  ],
)
def test_an_import_that_runs_up_is_seen(home: str, name: str) -> None:
  assert runs_up(home, EXPERIMENTS + name)


@pytest.mark.parametrize(
  ('home', 'line'),
  [
    ('agents', 'from waggle_tasks.entities import crazyflie'),
    ('agents', 'from waggle_tasks import scenario'),
    ('agents', 'import mujoco'),
    ('agents', 'from dm_control import composer'),
    ('protocol', 'import cv2'),
    ('protocol', 'from waggle_tasks.arenas import layouts'),
    ('entities', 'from waggle_tasks.arenas import layouts'),
    ('arenas', 'import waggle_tasks.tasks.broadcast'),
    ('tasks', 'from waggle_tasks.agents import navigator'),
    ('tasks', 'from waggle_tasks.experiments import launch'),
    ('', 'from waggle_tasks import agents'),
  ],
)
def test_the_table_refuses_a_way_round_it(home: str, line: str) -> None:
  (name,) = imported(ast.parse(line))
  assert not is_allowed(name, home, ROOMS[home])


class LauncherOnly(ast.NodeVisitor):
  """Collects what only launchers do: flags, printing, files, the clock."""

  CALLS = frozenset({'print', 'open', 'input'})
  METHODS = frozenset({'open', 'write_text', 'write_bytes', 'mkdir', 'imwrite'})
  MODULES = frozenset({'time', 'datetime', 'argparse', 'absl', 'tqdm'})

  def __init__(self) -> None:
    self.found: list[str] = []

  def visit_Call(self, node: ast.Call) -> None:
    function = node.func
    if isinstance(function, ast.Name) and function.id in self.CALLS:
      self.found.append(f'line {node.lineno}: {function.id}()')
    if isinstance(function, ast.Attribute) and function.attr in self.METHODS:
      self.found.append(f'line {node.lineno}: .{function.attr}()')
    self.generic_visit(node)

  def visit_Import(self, node: ast.Import) -> None:
    self._modules(node.lineno, [alias.name for alias in node.names])

  def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
    self._modules(node.lineno, [node.module or ''])

  def _modules(self, line: int, names: list[str]) -> None:
    for name in names:
      if name.partition('.')[0] in self.MODULES:
        self.found.append(f'line {line}: import {name}')


@pytest.mark.parametrize(('home', 'room', 'path'), FILES)
def test_flags_printing_files_and_clock_live_in_launchers(
  home: str, room: Room, path: pathlib.Path
) -> None:
  del home, room
  visitor = LauncherOnly()
  visitor.visit(ast.parse(path.read_text(encoding='utf-8')))
  assert visitor.found == []


@pytest.mark.parametrize(
  'line',
  [
    'print(1)',
    "open('x')",
    'pathlib.Path(x).write_text(y)',
    'import time',
    'from absl import flags',
  ],
)
def test_the_launchers_list_sees_each_of_them(line: str) -> None:
  visitor = LauncherOnly()
  visitor.visit(ast.parse(line))
  assert len(visitor.found) == 1


def run_python(code: str) -> str:
  """Runs code in a new process and returns what it printed."""
  child = subprocess.run(
    [sys.executable, '-c', code], capture_output=True, text=True, check=False
  )
  assert child.returncode == 0, child.stderr
  return child.stdout.strip()


# What needs a simulator only to measure, film or fly.
SIMULATING = frozenset({'episodes', 'bench_parts'})
SIMULATING_MODULES = frozenset({
  'studies.board_flight', 'studies.board_study', 'studies.ladder_flight',
  'studies.ladder_study', 'studies.link_study', 'studies.replay_flight',
  'studies.runner',
  'studies.spoilers', 'studies.suite_case', 'studies.suite_study',
  'studies.sweep_flight', 'studies.sweep_study', 'studies.talk_study',
  'video.board_films', 'video.board_pictures', 'video.eye_shots', 'video.film',
  'video.lens', 'video.shots',
})  # fmt: skip
IMPORT_ALL = """
import importlib, sys
from absl import flags

for name in sys.argv[1:]:
  importlib.import_module(name)
  for flag in [*flags.FLAGS]:  # Two launchers may use the same names.
    delattr(flags.FLAGS, flag)
  found = {'dm_control', 'dm_env', 'mujoco', 'OpenGL'} & {*sys.modules}
  if found:
    sys.exit(f'{name} imports {sorted(found)}')
"""


def test_what_flies_nothing_imports_no_simulator_and_no_gl() -> None:
  folder = ROOT / 'experiments'
  names = [
    '.'.join(path.relative_to(folder).with_suffix('').parts)
    for path in sorted(folder.rglob('*.py'))
    if path.name != '__init__.py'
  ]
  reading = [
    f'waggle_tasks.experiments.{name}'
    for name in names
    if name.partition('.')[0] not in SIMULATING
    if name not in SIMULATING_MODULES
  ]
  plain = [f'waggle_tasks.{name}' for name in ('scenarios', 'suites')]
  child = subprocess.run(
    [sys.executable, '-c', IMPORT_ALL, *plain, *reading],
    capture_output=True,
    text=True,
    check=False,
  )
  assert (child.returncode, child.stderr) == (0, '')


def test_importing_every_agent_module_reaches_no_simulator() -> None:
  modules = [
    f'waggle_tasks.agents.{module.name}'
    for module in pkgutil.iter_modules([str(ROOT / 'agents')])
  ]
  lines = '\n'.join(f'import {name}' for name in ['waggle_tasks', *modules])
  reached = run_python(
    f'{lines}\nimport sys\n'
    "print({'dm_control', 'mujoco', 'waggle_tasks.entities'} & {*sys.modules})"
  )
  assert reached == 'set()'


def test_no_file_is_longer_than_300_lines() -> None:
  folders = 'waggle_tasks', 'entities', 'arenas', 'agents', 'experiments'
  lines = {
    str(path.relative_to(ROOT)): len(path.read_bytes().splitlines())
    for folder in folders
    for path in (ROOT / folder).rglob('*.py')
  }
  assert not {name for name, count in lines.items() if count > 300}
