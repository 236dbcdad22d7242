"""`waggle doctor`: what it checks, and that each failure names its mend."""

from collections.abc import Callable
import itertools
import os
import pathlib
import re
import subprocess
import sys
import types

import cv2
from packaging import requirements
import pytest

from waggle_tasks import runtime
from waggle_tasks.experiments.machine import dependencies, gl, health
from waggle_tasks.experiments.record import provenance

DOCTOR = 'from waggle_tasks.experiments import main; sys.exit(main.main())'


def doctor(
  *arguments: str, before: str = '', **changes: str
) -> subprocess.CompletedProcess[str]:
  """Runs `waggle doctor` in a new process, after some code."""
  code = f"import sys; sys.argv[0] = 'waggle'\n{before}\n{DOCTOR}"
  return subprocess.run(
    [sys.executable, '-c', code, 'doctor', *arguments],
    capture_output=True,
    text=True,
    check=False,
    env=os.environ | changes,
  )


def failures(report: str) -> dict[str, str]:
  """Each failed check of a report, with the line that mends it."""
  lines = report.splitlines()
  return {
    line.removeprefix('FAIL  '): after.strip().removeprefix('mend it: ')
    for line, after in itertools.pairwise(lines)
    if line.startswith('FAIL')
  }


def test_a_machine_that_is_well_passes_every_check() -> None:
  child = doctor()
  assert child.returncode == 0, child.stdout
  *checks, verdict = child.stdout.splitlines()
  assert verdict == 'all is well'
  assert all(line.startswith('ok    ') for line in checks)
  report = child.stdout
  for words in (
    'dm-control 1.0.50 (needs ==1.0.50)',
    'mujoco 3.',
    'opencv-python-headless 5.',
    'GL backend ',
    'GL renderer ',
    'a 640x480 frame in ',
    ' GB free in ',
  ):
    assert words in report


@pytest.mark.slow
def test_a_broken_pair_does_not_hide_the_report() -> None:
  before = (
    'from importlib import metadata; version = metadata.version\n'
    "metadata.version = lambda n: '4.0.0' if n == 'mujoco' else version(n)"
  )
  child = doctor(before=before)
  assert child.returncode == 1
  assert failures(child.stdout) == {
    'mujoco 4.0.0 (needs <4,>=3.17)': "pip install 'mujoco<4,>=3.17'"
  }
  assert child.stdout.endswith('1 to mend\n')


@pytest.mark.slow
def test_a_broken_gl_stack_does_not_hide_the_rest_of_the_report() -> None:
  child = doctor(
    MUJOCO_GL='egl', __EGL_VENDOR_LIBRARY_FILENAMES='/no/such.json'
  )
  assert child.returncode == 1
  assert failures(child.stdout) == {
    'rendering, MUJOCO_GL=egl: ImportError: Cannot initialize a headless EGL '
    'display.': 'unset __EGL_VENDOR_LIBRARY_FILENAMES'
  }
  assert ' GB free in ' in child.stdout


@pytest.mark.slow
def test_a_file_cannot_hold_runs() -> None:
  child = doctor(f'--output={__file__}')
  assert child.returncode == 1
  assert failures(child.stdout) == {
    f'{__file__} cannot be written to': 'choose another folder with --output'
  }


@pytest.mark.parametrize(
  ('line', 'version', 'found', 'mend'),
  [
    ('tqdm', '4.1', 'tqdm 4.1', ''),
    ('a>=1,<2', '1.5', 'a 1.5 (needs <2,>=1)', ''),
    ('a>=1,<2', '2.0', 'a 2.0 (needs <2,>=1)', "pip install 'a<2,>=1'"),
    ('a==1', None, 'a is not installed (needs ==1)', "pip install 'a==1'"),
    ('tqdm', None, 'tqdm is not installed', "pip install 'tqdm'"),
    ('a>=1', '2.0rc1', 'a 2.0rc1 (needs >=1)', ''),
    ('a>=1', 'mine', 'a mine (needs >=1)', "pip install 'a>=1'"),
  ],
)
def test_a_version_is_checked_against_its_pin(
  line: str, version: str | None, found: str, mend: str
) -> None:
  assert health.check_requirement(line, version) == health.Check(found, mend)


@pytest.mark.parametrize(
  ('version', 'ok'),
  [('3.10.14', False), ('3.11.0', True), ('3.12.9', True), ('3.13.0', False)],
)
def test_python_is_checked_against_the_packages_range(
  version: str, ok: bool
) -> None:
  check = health.check_python(version, '>=3.11,<3.13')
  assert (check.mend == '') is ok
  assert check.found == f'python {version} (needs >=3.11,<3.13)'


HEADLESS = requirements.Requirement('opencv-python-headless<6,>=5')
OPENCV = ('opencv-python', 'opencv-contrib-python')


@pytest.fixture
def installed(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., None]:
  """Makes another distribution seem to be installed."""

  def install(name: str, version: str) -> None:
    home = tmp_path / f'{name.replace("-", "_")}-{version}.dist-info'
    home.mkdir()
    (home / 'METADATA').write_text(f'Name: {name}\nVersion: {version}\n')
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv('PYTHONPATH', str(tmp_path))

  return install


@pytest.mark.parametrize('name', [*OPENCV, 'opencv-contrib-python-headless'])
@pytest.mark.parametrize('version', ['4.14.0.92', '5.0.0.93'])
def test_two_packages_that_bring_one_module_are_named(
  name: str, version: str, installed: Callable[..., None]
) -> None:
  installed(name, version)
  check = health.check_dependency(HEADLESS)
  assert f'{name} {version}' in check.found
  assert check.found.endswith('overwrite each other: both bring cv2')
  both = re.search(r'pip uninstall -y (.+) && pip install (.+)', check.mend)
  assert {*both[1].split()} == {name, HEADLESS.name}
  assert both[2] == "'opencv-python-headless<6,>=5'"


@pytest.mark.slow
def test_nothing_flies_with_two_packages_of_one_module(
  installed: Callable[..., None], waggle: Callable[..., object]
) -> None:
  installed('opencv-python', '4.14.0.92')
  child = waggle('broadcast')
  assert child.returncode == 2
  (line,) = child.stderr.splitlines()
  assert line.startswith('waggle broadcast: opencv-python 4.14.0.92 and ')
  assert '; mend it: pip uninstall -y opencv-python ' in line
  child = waggle('doctor')
  assert child.returncode == 1
  assert len(failures(child.stdout)) == 1


@pytest.mark.parametrize('name', OPENCV)
def test_another_package_that_brings_the_same_module_will_do(
  name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
  only = {name: '5.0.0.93'}
  monkeypatch.setattr(runtime, 'installed', only.get)
  assert health.check_dependency(HEADLESS).mend == ''
  only[name] = '4.14.0.92'
  check = health.check_dependency(HEADLESS)
  assert check.found == f'{name} 4.14.0.92 (needs <6,>=5)'
  assert check.mend.startswith(f'pip uninstall -y {name} && pip install ')


def test_a_module_is_believed_and_not_what_was_installed(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(cv2, '__version__', '4.14.0')
  provenance.versions.cache_clear()
  try:
    assert provenance.versions()[HEADLESS.name] == '4.14.0'
  finally:
    provenance.versions.cache_clear()
  with pytest.raises(
    dependencies.DependencyError,
    match=r'headless 4\.14\.0 \(needs .+\), imported from .+; mend it: pip un',
  ):
    health.require()


@pytest.mark.parametrize(
  ('module', 'said'),
  [
    (None, 'cv2 cannot be imported: ModuleNotFoundError: '),
    (types.ModuleType('cv2'), 'cv2 is a folder that holds no module'),
  ],
)
def test_a_module_that_is_not_whole_is_named(
  module: types.ModuleType | None, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setitem(sys.modules, 'cv2', module)
  check = health.check_dependency(HEADLESS)
  assert check.found.startswith(f'opencv-python-headless: {said}')
  assert check.mend.startswith('pip uninstall -y opencv-python-headless && ')


def test_what_was_never_installed_is_said_so() -> None:
  need = requirements.Requirement('no-such-thing>=1')
  assert health.check_dependency(need) == health.Check(
    'no-such-thing is not installed (needs >=1)',
    "pip install 'no-such-thing>=1'",
  )


def test_every_declared_dependency_is_checked_and_no_extra() -> None:
  checked = [check.found.split()[0] for check in health.check_versions()]
  assert checked[:2] == ['waggle-tasks', 'python']
  assert {'dm-control', 'mujoco', 'numpy', 'absl-py'} <= {*checked}
  assert 'pytest' not in checked


def test_a_package_that_is_not_installed_is_said_so(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.setattr(dependencies, 'DISTRIBUTION', 'no-such-distribution')
  (check,) = health.check_versions()
  assert check == health.Check(
    'no-such-distribution is not installed', 'pip install -e .'
  )


def test_gl_is_not_blamed_for_versions(monkeypatch: pytest.MonkeyPatch) -> None:
  broken = gl.Rendering(error='AttributeError: flex_vertedge')
  monkeypatch.setattr(gl, 'render_once', lambda timeout_s: broken)
  (check,) = health.check_rendering(1.0, versions_ok=False)
  assert check.mend == 'mend the versions above, then look again'


@pytest.mark.parametrize('name', ['', 'not/made/yet'])
def test_disk_is_looked_at_where_the_folder_would_be_made(
  name: str, tmp_path: pathlib.Path
) -> None:
  check = health.check_disk(tmp_path / name)
  assert check.mend == ''
  assert check.found.endswith(f' GB free in {tmp_path}')
  assert not (tmp_path / 'not').exists()


def test_a_full_disk_is_to_mend(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(health, 'FREE_GB', 1e9)
  check = health.check_disk(tmp_path)
  assert 'GB free in' in check.found
  assert check.mend.startswith('free some room')
