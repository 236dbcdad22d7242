"""What a user gets: one import name, one command, all the data."""

from collections.abc import Iterator
import email
import importlib
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

import pytest

import waggle_tasks

ROOT = pathlib.Path(__file__).parents[1]
FOLDERS = ('entities', 'arenas', 'agents', 'experiments')
BUILD = """
import sys
from setuptools import build_meta
print(build_meta.build_wheel(sys.argv[1]))
"""


@pytest.fixture(scope='module')
def wheel(
  tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[zipfile.ZipFile]:
  """A wheel of the tree, with new data and a new subpackage in every folder."""
  tree = tmp_path_factory.mktemp('tree')
  for folder in ('waggle_tasks', *FOLDERS):
    shutil.copytree(
      ROOT / folder,
      tree / folder,
      ignore=shutil.ignore_patterns('__pycache__'),
    )
    new = tree / folder / 'new_package'
    new.mkdir()
    (new / '__init__.py').write_text('"""New."""\n')
    (new / 'model.xml').write_text('<mujoco/>')
    (tree / folder / 'table.json').write_text('{}')
  for path in ROOT.iterdir():
    if path.is_file():
      shutil.copy(path, tree)
  output = tmp_path_factory.mktemp('wheel')
  subprocess.run(
    [sys.executable, '-c', BUILD, str(output)],
    cwd=tree,
    check=True,
    capture_output=True,
  )
  (path,) = output.glob('*.whl')
  with zipfile.ZipFile(path) as archive:
    yield archive


def expected() -> set[str]:
  """Where each file of the tree belongs under the one import name."""
  places = {'waggle_tasks': 'waggle_tasks'}
  places |= {folder: f'waggle_tasks/{folder}' for folder in FOLDERS}
  names = set()
  for folder, place in places.items():
    for path in (ROOT / folder).rglob('*'):
      kinds = '.py', '.xml', '.json', '.css', '.js', '.npz', '.typed'
      if path.suffix in kinds:
        names.add(f'{place}/{path.relative_to(ROOT / folder).as_posix()}')
    names |= {
      f'{place}/new_package/__init__.py',
      f'{place}/new_package/model.xml',
      f'{place}/table.json',
    }
  return names


def read(wheel: zipfile.ZipFile, name: str) -> str:
  """The text of a file of the wheel's metadata."""
  (path,) = (n for n in wheel.namelist() if n.endswith(f'.dist-info/{name}'))
  return wheel.read(path).decode()


def test_only_waggle_tasks_reaches_site_packages(
  wheel: zipfile.ZipFile,
) -> None:
  top = {name.partition('/')[0] for name in wheel.namelist()}
  version = waggle_tasks.__version__
  assert top == {'waggle_tasks', f'waggle_tasks-{version}.dist-info'}


def test_all_code_and_data_travel_and_nothing_else(
  wheel: zipfile.ZipFile,
) -> None:
  packed = {n for n in wheel.namelist() if n.startswith('waggle_tasks/')}
  assert packed == expected()


def test_the_license_travels(wheel: zipfile.ZipFile) -> None:
  assert 'Apache License' in read(wheel, 'licenses/LICENSE')


def test_there_is_one_command(wheel: zipfile.ZipFile) -> None:
  assert read(wheel, 'entry_points.txt').split('\n') == [
    '[console_scripts]',
    'waggle = waggle_tasks.experiments.main:main',
    '',
  ]


def test_the_pins_that_work_are_declared(wheel: zipfile.ZipFile) -> None:
  declared = email.message_from_string(read(wheel, 'METADATA'))
  assert declared['Name'] == 'waggle-tasks'
  assert declared['Version'] == waggle_tasks.__version__
  assert declared['Requires-Python'] == '>=3.11,<3.13'
  needs = declared.get_all('Requires-Dist')
  for pin in (
    'dm-control==1.0.50',
    'mujoco<4,>=3.17',
    'opencv-python-headless<6,>=5',
  ):
    assert pin in needs
  assert declared.get_all('Provides-Extra') == [
    'video', 'cluster', 'analysis', 'rl', 'events', 'test', 'docs', 'dev',
  ]  # fmt: skip


def test_the_description_needs_no_file_beside_it(
  wheel: zipfile.ZipFile,
) -> None:
  declared = email.message_from_string(read(wheel, 'METADATA'))
  text = declared.get_payload()
  assert '# waggle_tasks' in text
  for target in re.findall(r'\]\(([^)]*)\)', text):
    assert target.startswith(('https://', '#')), target
  assert 'docs/envelope.md has the commands' in ' '.join(text.split())
  assert 'START climbs and returns' in ' '.join(text.split())
  assert '<!--' not in text


def test_the_classifiers_name_the_versions_that_are_allowed(
  wheel: zipfile.ZipFile,
) -> None:
  declared = email.message_from_string(read(wheel, 'METADATA'))
  named = {each.rpartition(' ')[2] for each in declared.get_all('Classifier')}
  assert named >= {'3.11', '3.12'}


def test_the_wheel_is_imported_from_where_it_lies(
  wheel: zipfile.ZipFile, tmp_path: pathlib.Path
) -> None:
  site = tmp_path / 'site'
  wheel.extractall(site)
  code = (
    f'import sys; sys.path.insert(0, {str(site)!r})\n'
    'from waggle_tasks.agents import new_package\n'
    'print(new_package.__file__)'
  )
  child = subprocess.run(
    [sys.executable, '-c', code],
    cwd=tmp_path,
    capture_output=True,
    text=True,
    check=True,
  )
  assert pathlib.Path(child.stdout.strip()).is_relative_to(site)


@pytest.mark.parametrize('folder', FOLDERS)
def test_a_folder_is_imported_under_the_one_name(folder: str) -> None:
  module = importlib.import_module(f'waggle_tasks.{folder}')
  assert pathlib.Path(module.__file__) == ROOT / folder / '__init__.py'


def test_the_citation_names_the_version_of_the_package() -> None:
  lines = (ROOT / 'CITATION.cff').read_text(encoding='utf-8').splitlines()
  assert f'version: {waggle_tasks.__version__}' in lines
