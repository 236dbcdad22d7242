"""The GL default and the check of versions, before MuJoCo is imported."""

import os
import subprocess
import sys

from packaging import requirements
import pytest

from waggle_tasks import runtime


@pytest.mark.parametrize(
  ('environ', 'platform', 'backend'),
  [
    ({}, 'linux', 'egl'),
    ({'DISPLAY': ''}, 'linux', 'egl'),
    ({'DISPLAY': ':0'}, 'linux', None),
    ({'WAYLAND_DISPLAY': 'wayland-0'}, 'linux', None),
    ({'MUJOCO_GL': 'osmesa'}, 'linux', None),
    ({'MUJOCO_GL': ''}, 'linux', None),
    ({}, 'darwin', None),
    ({}, 'win32', None),
  ],
)
def test_egl_is_chosen_only_where_there_is_no_display_and_no_setting(
  environ: dict[str, str], platform: str, backend: str | None
) -> None:
  assert runtime.default_gl(environ, platform) == backend


@pytest.mark.parametrize(
  'version', ['3.17', '3.17.0', '3.17.1rc1', '3.99.12', None, '', 'unknown']
)
def test_versions_that_work_or_cannot_be_judged_pass(
  version: str | None,
) -> None:
  assert runtime.version_problem(version, '1.0.50') is None


@pytest.mark.parametrize('version', ['4.0.0', '4.0.0rc1', '10.1', '3.14.0'])
def test_a_broken_pair_is_one_sentence_with_the_pip_line(version: str) -> None:
  sentence = runtime.version_problem(version, '1.0.50')
  assert sentence == (
    f'dm-control 1.0.50 cannot run on the installed mujoco {version}: '
    "mend it with `pip install 'mujoco>=3.17,<4'`."
  )


def test_the_pip_line_is_the_pin_of_the_package() -> None:
  declared = map(
    requirements.Requirement, runtime.metadata.requires('waggle-tasks')
  )
  (pin,) = (need for need in declared if need.name == 'mujoco')
  mend = requirements.Requirement(runtime.MUJOCO_PIN)
  assert mend.specifier == pin.specifier


def run_python(code: str, **changes: str) -> subprocess.CompletedProcess[str]:
  """Runs code in a new process whose environment names no GL, no display."""
  hidden = ('MUJOCO_GL', 'DISPLAY', 'WAYLAND_DISPLAY')
  environ = {k: v for k, v in os.environ.items() if k not in hidden}
  return subprocess.run(
    [sys.executable, '-c', code],
    capture_output=True,
    text=True,
    check=False,
    env=environ | changes,
  )


@pytest.mark.skipif(sys.platform != 'linux', reason='EGL is chosen on Linux')
@pytest.mark.parametrize(
  ('changes', 'backend'),
  [({}, 'egl'), ({'MUJOCO_GL': 'glfw'}, 'glfw'), ({'DISPLAY': ':7'}, 'None')],
)
def test_importing_the_package_sets_the_backend(
  changes: dict[str, str], backend: str
) -> None:
  code = 'import os, waggle_tasks; print(os.environ.get("MUJOCO_GL"))'
  assert run_python(code, **changes).stdout.strip() == backend


def test_importing_the_package_imports_no_simulator() -> None:
  code = (
    'import sys, waggle_tasks\n'
    'print([m for m in ("numpy", "mujoco", "dm_control") if m in sys.modules])'
  )
  assert run_python(code).stdout.strip() == '[]'


BROKEN = """
from importlib import metadata
version = metadata.version
metadata.version = lambda n: '4.0.0' if n == 'mujoco' else version(n)
"""


@pytest.mark.parametrize(
  'line',
  [
    "import waggle_tasks; waggle_tasks.load('no_send')",
    'from waggle_tasks.arenas import flight_room',
    'from waggle_tasks.entities import performer',
  ],
)
def test_what_simulates_refuses_a_broken_pair(line: str) -> None:
  child = run_python(f'{BROKEN}\n{line}')
  last = child.stderr.splitlines()[-1]
  assert child.returncode == 1
  assert last.endswith(
    'cannot run on the installed mujoco 4.0.0: mend it with `pip install '
    "'mujoco>=3.17,<4'`."
  )


def test_what_reads_works_on_a_broken_pair() -> None:
  child = run_python(f'{BROKEN}\nimport waggle_tasks; waggle_tasks.Scenario()')
  assert (child.returncode, child.stderr) == (0, '')


def test_a_broken_pair_is_an_import_error_naming_mujoco() -> None:
  child = run_python(
    f'{BROKEN}\ntry:\n  from waggle_tasks import registry\n'
    'except ImportError as error:\n  print(error.name)'
  )
  assert child.stdout.strip() == 'mujoco'


def test_the_command_starts_on_a_broken_pair_and_says_so_in_one_line() -> None:
  child = run_python(
    f'{BROKEN}\nimport sys\nfrom waggle_tasks.experiments import main\n'
    "sys.exit(main.main(['waggle', 'broadcast']))"
  )
  assert child.returncode == 2
  (line,) = child.stderr.splitlines()
  assert line.startswith('waggle broadcast: dm-control ')


@pytest.mark.slow
def test_the_imported_mujoco_is_believed_and_not_the_installed_one() -> None:
  child = run_python(
    "import waggle_tasks, mujoco\nmujoco.__version__ = '4.0.0'\n"
    "waggle_tasks.load('no_send')"
  )
  assert child.returncode == 1
  last = child.stderr.splitlines()[-1]
  assert 'cannot run on the installed mujoco 4.0.0: mend it with' in last
