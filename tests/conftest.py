"""Fixtures that several test modules share.

`waggle_tasks` is imported before dm_control, which takes the GL backend as it
finds it.
"""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

import cv2
import dm_env
import hypothesis
import numpy as np
import pytest
import starter

from waggle_tasks import registry
from waggle_tasks.protocol import agreement, flight, gestures, reference, timing

# Tests run beside each other: threads of one would wait for those of others.
cv2.setNumThreads(1)
os.environ['OPENCV_FOR_THREADS_NUM'] = '1'  # Of commands that tests start.

# A busy machine is slow, which is no failure.
hypothesis.settings.register_profile('patient', deadline=None, max_examples=60)
hypothesis.settings.load_profile('patient')

Observations = Sequence[dict[str, np.ndarray]]
Agent = Callable[[Observations], list[np.ndarray]]
Waggle = Callable[..., subprocess.CompletedProcess[str]]


def pytest_configure() -> None:
  """Takes Ctrl-C even where tests were begun in the background.

  Shells start such commands with the signal ignored, and so are the processes
  that they start in turn. nohup does so with hang-ups: those are ignored here
  still, but by a handler, which no process inherits.
  """
  signal.signal(signal.SIGINT, signal.default_int_handler)
  if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, lambda *_: None)


@pytest.fixture(scope='session')
def new_waggle() -> Waggle:
  """Runs `waggle` in a new Python."""

  def run(
    *arguments: str, cwd: pathlib.Path | None = None, **environment: str
  ) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
      [sys.executable, '-m', 'waggle_tasks.experiments.main', *arguments],
      capture_output=True,
      text=True,
      check=False,
      cwd=cwd,
      env=os.environ | environment,
    )

  return run


@pytest.fixture(scope='session')
def waggle(new_waggle: Waggle) -> Iterator[Waggle]:
  """Runs `waggle` in a process of its own, as a launcher's flags are global.

  It is a new Python only where the environment is another one.
  """
  ready = starter.Starter()

  def run(
    *arguments: str, cwd: pathlib.Path | None = None, **environment: str
  ) -> subprocess.CompletedProcess[str]:
    if environment or not ready.is_as_new:
      return new_waggle(*arguments, cwd=cwd, **environment)
    return ready.run(arguments, cwd)

  yield run
  ready.close()


# Python and dm_control take a second to start, so that one process takes every
# line; it forgets the flags in between.
_ASK = """
import contextlib, io, json, os, sys
from absl import flags
from waggle_tasks.experiments import launch

answers = []
for command, *argv in json.load(sys.stdin):
  for name in flags.FLAGS:
    flags.FLAGS[name].unparse()
  said = io.StringIO()
  with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
    try:
      module = f'waggle_tasks.experiments.{command}'
      status = launch.run(module, [command, *argv])
    except Exception as error:
      status = repr(error)
  answers.append((status, said.getvalue(), sorted(os.listdir())))
print(json.dumps(answers))
"""


@pytest.fixture(scope='session')
def ask() -> Callable[[Sequence[Sequence[str]], pathlib.Path], list]:
  """Gives one command many lines; its status, output and files after each."""

  def run(lines: Sequence[Sequence[str]], here: pathlib.Path) -> list:
    done = subprocess.run(
      [sys.executable, '-c', _ASK], input=json.dumps(lines),
      capture_output=True, text=True, check=True, cwd=here,
    )  # fmt: skip
    return json.loads(done.stdout)

  return run


_BLOCK = """
import importlib.abc
import sys


class Block(importlib.abc.MetaPathFinder):
  def find_spec(self, name, path=None, target=None):
    if name.startswith(('OpenGL', 'glfw', 'mujoco', 'dm_control._render')):
      raise ImportError(f'there is no {name}', name=name)


sys.meta_path.insert(0, Block())
"""


@pytest.fixture(scope='session')
def no_gl(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
  """The environment of a process that can import nothing that draws."""
  folder = tmp_path_factory.mktemp('no_gl')
  (folder / 'sitecustomize.py').write_text(_BLOCK, encoding='utf-8')
  return {'MUJOCO_GL': 'disabled', 'PYTHONPATH': str(folder)}


@pytest.fixture(scope='session')
def short() -> dict[str, object]:
  """Scenario fields of a dance of half the length that every view can read.

  Small, fast gestures, and pauses that just fit the receiver's null.
  """
  return {
    'codebook': gestures.v_codebook(0.12, 0.25, duration_s=2.0),
    'pauses': timing.Timing(3.2, 0.6, 2.0, 1.8),
  }


@pytest.fixture(scope='session')
def agreed(short: dict[str, object]) -> agreement.Agreement:
  """What both sides know of the short dance."""
  return agreement.Agreement(**short)


@dataclasses.dataclass(frozen=True, eq=False)
class Clip:
  """What one observer saw, and where the performer truly was in it.

  Attributes:
    images: One (480, 640, 3) uint8 for each frame; equal ones are one array.
    times_s: Their times.
    target_px: (T, 2) the performer's centre in each.
  """

  images: list[np.ndarray]
  times_s: list[float]
  target_px: np.ndarray


@pytest.fixture(scope='session')
def clip(short: dict[str, object]) -> Clip:
  """The front view of a null, START, a null, 0 and a null: 15.8 s."""
  environment = registry.load(
    'broadcast', observers=1, duration_s=15.8, **short
  )
  images, times_s, target_px = [], [], []
  timestep = environment.reset()
  physics = environment.physics
  eye = physics.model.name2id('observer_1/eye', 'camera')
  focal_px = 240 / math.tan(math.radians(30))
  while True:
    (seen,) = timestep.observation
    same = images and np.array_equal(images[-1], seen['camera'])
    images.append(images[-1] if same else seen['camera'].copy())
    times_s.append(float(seen['time_s']))
    data = physics.data
    performer_m = environment.task.positions_m(physics)['performer']
    x, y, z = (performer_m - data.cam_xpos[eye]) @ data.cam_xmat[eye].reshape(
      3, 3
    )
    target_px.append((320 - focal_px * x / z, 240 + focal_px * y / z))
    if timestep.last():
      break
    timestep = environment.step(_hover(timestep.observation))
  environment.close()
  return Clip(images, times_s, np.array(target_px))


@pytest.fixture
def load() -> Iterator[Callable[..., registry.composer.Environment]]:
  """Makes environments of named scenarios; they are closed after the test.

  With `cameras=False` observations hold no images, which makes flights cheap.
  """
  made = []

  def make(
    name: str = 'broadcast', cameras: bool = True, **changes: object
  ) -> registry.composer.Environment:
    environment = registry.load(name, **changes)
    made.append(environment)
    for each in environment.task.observers:
      each.observables.camera.enabled = cameras
    return environment

  yield make
  for environment in made:
    environment.close()


def _episode(
  environment: registry.composer.Environment, agent: Agent
) -> Iterator[dm_env.TimeStep]:
  timestep = environment.reset()
  yield timestep
  while not timestep.last():
    timestep = environment.step(agent(timestep.observation))
    yield timestep


@pytest.fixture
def episode() -> Callable[..., Iterator[dm_env.TimeStep]]:
  """The time steps of one episode of an environment with an agent."""
  return _episode


def _hover(observations: Observations) -> list[np.ndarray]:
  return [
    reference.Reference.hover(each['position_m']).to_array()
    for each in observations
  ]


@pytest.fixture
def hover() -> Agent:
  """An agent that stays where it is."""
  return _hover


class _Flyer:
  def __init__(self, offset_m: Sequence[float], begin_s: float) -> None:
    self._offset_m = np.array(offset_m)
    self._begin_s = begin_s
    self._begins_m: list[np.ndarray] = []

  def __call__(self, observations: Observations) -> list[np.ndarray]:
    if not self._begins_m:
      self._begins_m = [each['position_m'].copy() for each in observations]
    time_s = float(observations[0]['time_s'])
    if time_s < self._begin_s:
      return _hover([{'position_m': each} for each in self._begins_m])
    out = []
    for begin_m in self._begins_m:
      plan = flight.Flight(begin_m, begin_m + self._offset_m, self._begin_s)
      motion = plan.motion(time_s + agreement.Agreement().frame_s / 2)
      wanted = reference.Reference(*motion, 0.0, plan.goal_m)
      out.append(wanted.to_array())
    return out


@pytest.fixture
def flyer() -> Callable[[Sequence[float], float], Agent]:
  """Makes an agent that flies an offset from where it was at a time."""
  return _Flyer


@pytest.fixture
def dancing(
  load: Callable[..., registry.composer.Environment],
) -> Callable[..., registry.composer.Environment]:
  """Makes environments of 0.4 s in which the performer moves at once."""

  def make(**changes: object) -> registry.composer.Environment:
    at_once = {
      'codebook': gestures.v_codebook(0.03, 0.18, duration_s=1.2),
      'pauses': timing.Timing(0.0, 0.0, 0.0, 0.0),
      'duration_s': 0.4,
      'observers': 2,
    }
    return load('broadcast', **(at_once | changes))

  return make


@pytest.fixture
def film() -> Callable[[registry.composer.Environment], np.ndarray]:
  """All images of an episode: (observers, T, 480, 640, 3)."""

  def run(environment: registry.composer.Environment) -> np.ndarray:
    steps = [
      [each['camera'].copy() for each in timestep.observation]
      for timestep in _episode(environment, _hover)
    ]
    return np.stack(steps, axis=1)

  return run


def _session(leader: int) -> dict[int, str]:
  found = {}
  for path in pathlib.Path('/proc').glob('[0-9]*'):
    try:
      fields = (path / 'stat').read_text().rpartition(')')[2].split()
      words = (path / 'cmdline').read_text()
    except (FileNotFoundError, ProcessLookupError):
      continue
    # The dead stay listed until somebody reaps them.
    if int(fields[3]) == leader and fields[0] not in 'ZX':
      found[int(path.name)] = words
  return found


@pytest.fixture
def session() -> Callable[[int], dict[int, str]]:
  """The living processes of a session, by id, and their command lines."""
  if not pathlib.Path('/proc/self/stat').exists():
    pytest.skip('needs /proc, which macOS has not')
  return _session


def _wait_until(condition: Callable[[], object], limit_s: float = 60.0) -> None:
  end_s = time.monotonic() + limit_s
  while not condition():
    assert time.monotonic() < end_s, f'not within {limit_s:g} s'
    time.sleep(0.01)


@pytest.fixture
def wait_until() -> Callable[..., None]:
  """Waits for a condition; fails when it does not come about."""
  return _wait_until
