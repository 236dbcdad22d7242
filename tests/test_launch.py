"""How a launcher's help, errors and exit status reach the user."""

from collections.abc import Callable
import os
import pathlib
import subprocess
import sys

import pytest

TOY = '''"""Does what --do says.

A second paragraph.
"""

import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch

DO = flags.DEFINE_enum('do', 'nothing', ['nothing', 'fail'], 'What to do.')
WIDTH = launch.define_positive_float('width_m', 1.5, 'Width of the toy, m.')
COUNT = flags.DEFINE_integer('count', None, 'Toys.', lower_bound=1)
LOUD = flags.DEFINE_boolean('loud', False, 'Whether to shout.')
LONG = flags.DEFINE_string('a_name_as_long_as_it_gets', 'x', 'word ' * 30)


def main(argv):
  exec(BODY)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
'''

Launch = Callable[..., subprocess.CompletedProcess[str]]
NO_GL = {'MUJOCO_GL': 'egl', '__EGL_VENDOR_LIBRARY_FILENAMES': '/no/such.json'}


@pytest.fixture
def toy(tmp_path: pathlib.Path) -> Launch:
  """Runs a launcher whose `main` has the given body."""

  def launch(
    body: str, *arguments: str, **changes: str
  ) -> subprocess.CompletedProcess[str]:
    path = tmp_path / 'toy.py'
    path.write_text(TOY.replace('exec(BODY)', body), encoding='utf-8')
    return subprocess.run(
      [sys.executable, str(path), *arguments],
      capture_output=True,
      text=True,
      check=False,
      env=os.environ | changes,
    )

  return launch


def test_help_shows_flags_in_order_with_defaults_and_rules(toy: Launch) -> None:
  child = toy('pass', '--help')
  assert child.returncode == 0
  assert child.stdout == (
    'usage: waggle toy [--flag=value ...]\n'
    '\n'
    'Does what --do says.\n'
    '\n'
    'A second paragraph.\n'
    '\n'
    'flags:\n'
    '  --do=nothing              <nothing|fail>: What to do.\n'
    '  --width_m=1.5             Width of the toy, m. Positive.\n'
    '  --count=                  Toys. (a positive integer)\n'
    '  --[no]loud                Whether to shout. (default: false)\n'
    '  --a_name_as_long_as_it_gets=x\n'
    '                            word word word word word word word word word '
    'word\n'
    '                            word word word word word word word word word '
    'word\n'
    '                            word word word word word word word word word '
    'word\n'
  )


@pytest.mark.parametrize(
  ('body', 'status'),
  [('pass', 0), ('return 0', 0), ('return 1', 1)],
)
def test_exit_status_is_what_main_returns(
  toy: Launch, body: str, status: int
) -> None:
  child = toy(body)
  assert (child.returncode, child.stderr) == (status, '')


def test_main_reads_its_flags(toy: Launch) -> None:
  child = toy(
    'print(DO.value, WIDTH.value, COUNT.value, LOUD.value)',
    '--do=fail',
    '--width_m',
    '2',
    '--loud',
  )
  assert child.stdout == 'fail 2.0 None True\n'


def test_given_flags_are_those_of_the_command_line(toy: Launch) -> None:
  child = toy('print(launch.given_flags())', '--width_m', '2', '--do=nothing')
  assert child.stdout == "['--do=nothing', '--width_m=2.0']\n"


@pytest.mark.parametrize(
  ('body', 'line', 'status'),
  [
    ("raise errors.WaggleError('`n` must be 1: got 2.')", '`n` must be 1', 2),
    ('raise KeyboardInterrupt', 'interrupted', 130),
  ],
)
def test_what_a_user_did_is_one_line_on_stderr(
  toy: Launch, body: str, line: str, status: int
) -> None:
  child = toy(f"print('before'); {body}")
  assert child.returncode == status
  assert child.stdout == 'before\n'
  (said,) = child.stderr.splitlines()
  assert said.startswith(f'waggle toy: {line}')


@pytest.mark.parametrize(
  ('argument', 'line'),
  [
    ('--do=dance', 'flag --do=dance: value should be one of <nothing|fail>'),
    (
      '--count=two',
      "flag --count=two: invalid literal for int() with base 10: 'two'; "
      'it takes a positive integer',
    ),
    ('--count=0', 'flag --count=0: 0 is not a positive integer'),
    ('--widht_m=2', 'unknown flag --widht_m. Did you mean --width_m?'),
  ],
)
def test_a_bad_flag_never_reaches_main(
  toy: Launch, argument: str, line: str
) -> None:
  child = toy("print('main ran')", argument)
  assert (child.returncode, child.stdout) == (2, '')
  (said,) = child.stderr.splitlines()
  assert said.startswith(f'waggle toy: {line}')
  assert said.count('positive integer') <= 1


def test_a_mistake_of_ours_keeps_its_traceback(toy: Launch) -> None:
  child = toy("raise ZeroDivisionError('ours')")
  assert child.returncode == 1
  assert child.stderr.startswith('Traceback')
  assert child.stderr.endswith('ZeroDivisionError: ours\n')


@pytest.mark.slow
def test_a_machine_that_cannot_render_is_told_so_in_one_line(
  toy: Launch,
) -> None:
  child = toy('from dm_control import mujoco', **NO_GL)
  assert child.returncode == 2
  (said,) = child.stderr.splitlines()
  assert said == (
    'waggle toy: cannot render with MUJOCO_GL=egl (ImportError: Cannot '
    'initialize a headless EGL display.); mend it: unset '
    '__EGL_VENDOR_LIBRARY_FILENAMES'
  )


@pytest.mark.slow
def test_a_renderer_without_a_display_ends_with_the_line_that_mends_it(
  toy: Launch,
) -> None:
  body = (
    'from dm_control import mujoco; '
    "mujoco.Physics.from_xml_string('<mujoco/>').render(8, 8)"
  )
  child = toy(body, MUJOCO_GL='glfw', DISPLAY='', WAYLAND_DISPLAY='')
  assert child.returncode == 2
  assert 'Traceback' not in child.stderr
  assert child.stderr.endswith(
    'waggle toy: cannot render with MUJOCO_GL=glfw (FatalError: gladLoadGL '
    'error); mend it: export MUJOCO_GL=egl\n'
  )


@pytest.mark.parametrize(
  'body',
  [
    "raise ZeroDivisionError('ours')",
    "raise ImportError('no such thing', name='scipy')",
    "from OpenGL import GL; raise ZeroDivisionError('after it')",
  ],
)
def test_where_nothing_renders_a_mistake_of_ours_keeps_its_traceback(
  toy: Launch, body: str
) -> None:
  child = toy(body, MUJOCO_GL='disabled')
  assert child.returncode == 1
  assert child.stderr.startswith('Traceback')
  assert 'cannot render' not in child.stderr


def test_a_graphics_library_that_is_not_there_is_told_in_one_line(
  toy: Launch, no_gl: dict[str, str]
) -> None:
  child = toy('import OpenGL', **no_gl)
  assert child.returncode == 2
  (said,) = child.stderr.splitlines()
  assert said.startswith('waggle toy: cannot render with MUJOCO_GL=disabled')


def test_help_needs_no_gl(toy: Launch) -> None:
  child = toy('from dm_control import mujoco', '--help', **NO_GL)
  assert (child.returncode, child.stderr) == (0, '')
