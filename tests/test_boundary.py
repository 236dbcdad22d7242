"""The experiment finds nothing in an honest receiver, and every leak."""

from collections.abc import Callable
import dataclasses
import json
import re
import subprocess
import sys
import zlib

import numpy as np
import pytest

from waggle_tasks import registry
from waggle_tasks.agents import config, observer_agent, receiver, receivers
from waggle_tasks.experiments.episodes import boundary_worlds
from waggle_tasks.protocol import frame
from waggle_tasks.protocol.symbols import Symbol

SWAP = (0, 1)


def run(
  name: str, scene: registry.Scenario
) -> tuple[
  boundary_worlds.Events, boundary_worlds.Events, boundary_worlds.Events
]:
  other = dataclasses.replace(scene, payload='110101', jitter_m=0.01, seed=1)
  return boundary_worlds.experiment(scene, other, name, SWAP)


@pytest.mark.long
def test_events_of_the_klt_receiver_come_from_its_own_images(
  short: dict[str, object],
) -> None:
  # A null, START, a null and the first bit, which differs in the other world.
  scene = registry.find('broadcast', observers=2, duration_s=12.6, **short)
  own, foreign, swapped = run('klt', scene)
  for events in own:
    assert [e.symbol for e in events] == ['NULL', 'START', 'NULL', '0']
  assert own[0] != own[1]  # Or the swap would show nothing.
  assert foreign == own
  assert swapped == own[::-1]


class Leak:
  """A receiver that says, of each image, what it knows.

  Attributes:
    DEFAULT: Numbers that it has no use for.
    images: What each receiver saw last, in the order of their making.
    told: What somebody told this one beside images and times.
  """

  DEFAULT = config.Config()
  images: list[int]

  def __init__(self, *agreed: object) -> None:
    del agreed  # The gestures, and numbers to read them with.
    self.number = len(self.images)
    self.images.append(0)
    self.told: object = None
    self.track = self.segment = None

  def know(self) -> object:
    """What an honest one knows: its own image."""
    return self.images[self.number]

  def step(
    self, image: np.ndarray, time_s: float
  ) -> tuple[receiver.Event, ...]:
    self.images[self.number] = zlib.crc32(image.tobytes())
    text = str(self.know())
    state = frame.State.START
    return (receiver.Event(time_s, Symbol.NULL, state, None, None, text),)


class Neighbour(Leak):
  """Looks over its neighbour's shoulder."""

  def know(self) -> object:
    first = self.number - self.number % 2
    return sorted(self.images[first : first + 2])


class Listener(Leak):
  """Uses what it was told."""

  def know(self) -> object:
    return self.told


class Number(Leak):
  """Knows which observer it is."""

  def know(self) -> object:
    return self.number % 2


@pytest.fixture
def leaky(
  monkeypatch: pytest.MonkeyPatch,
) -> Callable[[type[Leak]], tuple[boundary_worlds.Events, ...]]:
  """Runs the experiment, five frames of it, with such a receiver."""

  def experiment(kind: type[Leak]) -> tuple[boundary_worlds.Events, ...]:
    monkeypatch.setattr(kind, 'images', [], raising=False)
    monkeypatch.setitem(receivers.RECEIVERS, 'leaky', kind)
    scene = registry.find('broadcast', observers=2, duration_s=0.2)
    return run('leaky', scene)

  return experiment


@pytest.mark.slow
def test_receivers_that_know_their_own_images_pass(
  leaky: Callable[[type[Leak]], tuple[boundary_worlds.Events, ...]],
) -> None:
  own, foreign, swapped = leaky(Leak)
  assert own[0] != own[1]
  assert foreign == own
  assert swapped == own[::-1]


@pytest.mark.slow
def test_a_receiver_that_sees_its_neighbours_image_is_found(
  leaky: Callable[[type[Leak]], tuple[boundary_worlds.Events, ...]],
) -> None:
  own, foreign, _ = leaky(Neighbour)
  assert foreign[0] != own[0]
  assert foreign[1] != own[1]


@pytest.mark.slow
def test_a_receiver_that_is_told_where_it_is_is_found(
  leaky: Callable[[type[Leak]], tuple[boundary_worlds.Events, ...]],
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  step = observer_agent.ObserverAgent.step

  def tell(
    agent: observer_agent.ObserverAgent, observation: dict[str, np.ndarray]
  ) -> np.ndarray:
    agent.receiver.told = observation['position_m'].tolist()
    return step(agent, observation)

  monkeypatch.setattr(observer_agent.ObserverAgent, 'step', tell)
  own, foreign, swapped = leaky(Listener)
  assert foreign[0] != own[0]
  assert foreign[1] != own[1]
  assert swapped != own[::-1]


@pytest.mark.slow
def test_a_receiver_that_knows_which_one_it_is_is_found(
  leaky: Callable[[type[Leak]], tuple[boundary_worlds.Events, ...]],
) -> None:
  own, _, swapped = leaky(Number)
  assert swapped != own[::-1]


# The launcher.

SCRIPT = """
import contextlib, io, json, sys
from absl import flags
from waggle_tasks.experiments import launch

answers = []
for argv in json.load(sys.stdin):
  for name in flags.FLAGS:
    flags.FLAGS[name].unparse()
  out, err = io.StringIO(), io.StringIO()
  with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
    status = launch.run(
      'waggle_tasks.experiments.boundary', ['boundary', *argv]
    )
  answers.append((status, out.getvalue(), err.getvalue()))
print(json.dumps(answers))
"""
LINES = (
  '--observers=2 --duration_s=3.2',
  '--observers=2 --duration_s=0.2 --other_payload=000010',
  '--observers=2 --duration_s=0.2 --other_payload=2',
  '--observers=2 --duration_s=0.2 --swap=1',
  '--observers=2 --duration_s=0.2 --swap=2,2',
  '--observers=2 --duration_s=0.2 --swap=1,3',
  '--observers=2 --duration_s=0.2 --swap=1,x',
  '--observers=1 --duration_s=0.2',
  '--observers=2 --duration_s=0.2 --receiver=kl',
)


@pytest.fixture(scope='module')
def answers() -> dict[str, tuple[int, str, str]]:
  """Exit status, output and errors of each line, all of one process."""
  done = subprocess.run(
    [sys.executable, '-c', SCRIPT],
    input=json.dumps([line.split() for line in LINES]),
    capture_output=True,
    text=True,
    check=True,
  )
  return dict(zip(LINES, json.loads(done.stdout), strict=True))


@pytest.mark.slow
def test_the_launcher_shows_both_experiments(
  answers: dict[str, tuple[int, str, str]],
) -> None:
  status, out, _ = answers[LINES[0]]
  assert status == 0
  head, _, *rows, verdict = out.splitlines()
  assert re.split(r' {2,}', head) == [
    'observer', 'message', 'events', 'same under 110101', 'message, swapped',
    'swapped',
  ]  # fmt: skip
  # The null at 3 s.
  expected = ['-', '1', 'yes', '-', 'yes']
  assert [re.split(r' {2,}', row) for row in rows] == [
    ['observer_1', *expected], ['observer_2', *expected],
  ]  # fmt: skip
  assert verdict == 'The boundary holds.'


@pytest.mark.slow
@pytest.mark.parametrize(
  ('line', 'error'),
  zip(
    LINES[1:],
    [
      '`other_payload` must differ from `payload`: got 000010',
      "`payload` must be 6 characters .* got '2'",
      r"`swap` must name two observers: got \['1'\]",
      r"`swap` must name two observers: got \['2', '2'\]",
      '`swap` must be between 1 and 2: got 3',
      "`swap` must be an integer: got 'x'",
      '`swap` must be between 1 and 1: got 2',
      "`receiver` must be one of .*: got 'kl'. Did you mean klt",
    ],
    strict=True,
  ),
)
def test_what_cannot_be_shown_is_refused_in_one_line(
  answers: dict[str, tuple[int, str, str]], line: str, error: str
) -> None:
  status, out, err = answers[line]
  assert (status, out) == (2, '')
  assert err.count('\n') == 1
  assert re.match(f'waggle boundary: {error}', err)
