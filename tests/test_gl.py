"""Rendering in a child process, and what is said when it fails."""

import contextlib
import pathlib
import subprocess
import sys
import threading
import types

from dm_control._render import executor
from OpenGL import GL
import pytest

from waggle_tasks import registry
from waggle_tasks.experiments.episodes import rollout, tape
from waggle_tasks.experiments.machine import gl
from waggle_tasks.experiments.record import provenance

APT = 'apt-get install libegl1 libgl1 libgl1-mesa-dri'


@pytest.mark.parametrize(
  ('code', 'error'),
  [
    ('import os; os.abort()', 'the rendering process was ended by SIGABRT'),
    ('import time; time.sleep(60)', 'no frame within 0.5 s'),
    ('', 'the rendering process said: nothing'),
    ("print('no JSON')", 'the rendering process said: nothing'),
    ("print('[1]')", 'the rendering process said: nothing'),
    ('import nowhere', 'the rendering process said: ModuleNotFoundError: No'),
    ('print(\'noise\\n{"error": "no GPU"}\')', 'no GPU'),
  ],
)
def test_however_the_child_ends_the_error_says_so(
  code: str, error: str, tmp_path: pathlib.Path
) -> None:
  script = tmp_path / 'script.py'
  script.write_text(code, encoding='utf-8')
  timeout_s = 0.5 if 'sleep' in code else 30.0
  assert gl.render_once(timeout_s, script).error.startswith(error)


def test_a_module_beside_the_script_hides_no_other(
  tmp_path: pathlib.Path,
) -> None:
  (tmp_path / 'json.py').write_text('raise SystemExit("hidden")')
  script = tmp_path / 'script.py'
  script.write_text('import json; print(json.dumps({"renderer": "GPU"}))')
  assert gl.render_once(30.0, script) == gl.Rendering(renderer='GPU')


def test_this_machine_renders() -> None:
  result = gl.render_once()
  assert result.error == ''
  assert result.backend in ('egl', 'glfw', 'osmesa')
  assert result.renderer
  assert 0 < result.frame_s < 5


@pytest.mark.parametrize(
  ('environ', 'error', 'line'),
  [
    ({'MUJOCO_GL': 'egl'}, "'NoneType' has no 'eglQueryString'", APT),
    ({'MUJOCO_GL': 'egl'}, 'Cannot initialize a headless EGL display.', APT),
    ({'MUJOCO_GL': 'glfw'}, 'gladLoadGL error', 'export MUJOCO_GL=egl'),
    ({'MUJOCO_GL': 'osmesa'}, "no 'glGetError'", 'export MUJOCO_GL=egl'),
    ({'MUJOCO_GL': 'nope'}, 'must be one of', 'export MUJOCO_GL=egl'),
    ({'DISPLAY': ':99'}, 'gladLoadGL error', 'export MUJOCO_GL=egl'),
    (
      {'MUJOCO_GL': 'egl', 'LIBGL_DRIVERS_PATH': '/nowhere'},
      'Cannot initialize a headless EGL display.',
      'unset LIBGL_DRIVERS_PATH',
    ),
    (
      {'MUJOCO_GL': 'egl'},
      'The PYOPENGL_PLATFORM environment variable is set to glx',
      'unset PYOPENGL_PLATFORM',
    ),
    (
      {'MUJOCO_GL': 'egl'},
      'MUJOCO_EGL_DEVICE_ID must be an integer between 0 and 0',
      'unset MUJOCO_EGL_DEVICE_ID',
    ),
  ],
)
def test_each_failure_gets_the_line_that_mends_it(
  environ: dict[str, str], error: str, line: str
) -> None:
  assert gl.mend(environ, error, 'linux') == line


@pytest.mark.parametrize(
  ('environ', 'line'),
  [
    ({'MUJOCO_GL': 'egl'}, 'unset MUJOCO_GL'),
    ({'MUJOCO_GL': 'glfw'}, 'pip install --force-reinstall glfw'),
    ({}, 'pip install --force-reinstall glfw'),
  ],
)
def test_nobody_is_sent_to_a_library_that_their_system_has_not(
  environ: dict[str, str], line: str
) -> None:
  assert gl.mend(environ, 'gladLoadGL error', 'darwin') == line


@pytest.mark.slow
def test_a_machine_that_renders_has_no_problem() -> None:
  assert gl.problem() is None


@pytest.mark.parametrize(
  ('name', 'value', 'words'),
  [
    ('MUJOCO_GL', 'nope', "got 'nope'.); mend it: export MUJOCO_GL=egl"),
    ('MUJOCO_GL', 'disable', 'No OpenGL rendering backend is available.); '),
    ('MUJOCO_EGL_DEVICE_ID', '99', 'mend it: unset MUJOCO_EGL_DEVICE_ID'),
    ('PYOPENGL_PLATFORM', 'glx', 'mend it: unset PYOPENGL_PLATFORM'),
  ],
)
def test_a_setting_that_cannot_render_is_named_in_one_line(
  name: str, value: str, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setenv('MUJOCO_GL', 'egl')
  monkeypatch.setenv(name, value)
  line = gl.problem()
  assert line.startswith('cannot render with MUJOCO_GL=')
  assert words in line
  assert '\n' not in line


def test_a_renderer_that_draws_in_a_thread_of_its_own_has_its_name(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  offloading = executor.OffloadingRenderExecutor()

  def say(name: int) -> bytes | None:
    here = threading.current_thread() is offloading.thread
    return b'softpipe' if here and name == GL.GL_RENDERER else None

  @contextlib.contextmanager
  def make_current() -> object:
    with offloading.execution_context() as context:
      yield context

  monkeypatch.setattr(GL, 'glGetString', say)
  context = types.SimpleNamespace(make_current=make_current)
  physics = types.SimpleNamespace(contexts=types.SimpleNamespace(gl=context))
  assert provenance.renderer_name(physics) == 'softpipe'
  offloading.terminate()


@pytest.mark.slow
def test_results_say_which_renderer_drew_them() -> None:
  scene = registry.find('no_send', observers=1, duration_s=0.2)
  name = gl.render_once().renderer
  assert rollout.run(scene, 'klt').renderer == name
  (taped,) = tape.record(scene, lambda amount: None)
  assert taped.renderer == name


def test_osmesa_has_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
  monkeypatch.setenv('MUJOCO_GL', 'osmesa')
  monkeypatch.delenv('PYOPENGL_PLATFORM', raising=False)
  there = gl.render_once()
  if there.error:
    pytest.skip(f'needs OSMesa: {there.error}')
  code = (
    'from waggle_tasks import registry\n'
    'from waggle_tasks.experiments.episodes import rollout\n'
    "scene = registry.find('no_send', observers=1, duration_s=0.2)\n"
    "print(rollout.run(scene, 'klt').renderer)"
  )
  said = subprocess.check_output([sys.executable, '-c', code], text=True)
  assert said.strip() == there.renderer
