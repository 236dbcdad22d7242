"""Flights that go wrong, and who is said to have failed."""

from collections.abc import Callable, Iterator
import dataclasses
import json
import math
import pathlib
import subprocess

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import registry, scenario
from waggle_tasks.agents import observer_agent
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import episode, nulls, verdicts
from waggle_tasks.protocol import timing

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@dataclasses.dataclass(frozen=True)
class Above:
  """One observer in front, at a height of its own."""

  height_m: float
  distance_m: float = 1.3

  def poses(self, count: int) -> tuple[layouts.Pose, ...]:
    assert count == 1
    return (layouts.Pose((0.0, -self.distance_m, self.height_m), math.pi / 2),)


@pytest.fixture
def play() -> Iterator[Callable[..., tuple]]:
  """Flies a scenario; returns its environment, rollout and only outcome."""
  made = []

  def run(
    scene: scenario.Scenario,
    receiver_name: str,
    change: Callable[[composer.Environment], object] = lambda environment: None,
    watch: episode.Onlooker = lambda *seen: None,
  ) -> tuple[rollout_lib.Rollout, verdicts.Outcome]:
    environment = registry.environment(scene)
    made.append(environment)
    change(environment)
    team = observer_agent.Team(1, receiver_name, scene.agreement)
    rollout = rollout_lib.play(environment, team, [watch])
    (outcome,) = evaluator.evaluate(scene, rollout).outcomes
    return rollout, outcome

  yield run
  for environment in made:
    environment.close()


@pytest.mark.long
@pytest.mark.parametrize('height_m', [1.2, 1.5])
def test_a_message_leads_to_the_agreed_height_for_everyone(
  height_m: float, play: Callable[..., tuple], short: dict[str, object]
) -> None:
  scene = scenario.Scenario(
    observers=1, layout=Above(height_m), payload='000010', **short
  )
  rewards = []
  rollout, outcome = play(
    scene,
    'view_bank',
    watch=lambda step: rewards.append(step.timestep.reward),
  )
  assert outcome.failures == ()
  assert outcome.decoded == '000010'
  assert sum(each[0] for each in rewards[1:]) == 1.0
  end_m = rollout.positions_m['observer_1'][-1]
  np.testing.assert_allclose(end_m, (0.0, -0.9, 1.3), atol=2e-3)
  start, arrival = (
    each
    for each in rollout.events['observer_1']
    if isinstance(each, observer_agent.Navigation)
  )
  np.testing.assert_allclose(start.target_m, (0.0, -0.9, 1.3), atol=2e-3)
  assert outcome.arrival_s == pytest.approx(arrival.time_s, abs=0.09)


@pytest.mark.slow
@pytest.mark.parametrize(
  ('tilt_deg', 'said'),
  [
    (10.0, 'it was at 320, 167 px of 640 x 480, and is looked for around'),
    (35.0, 'outside of the picture, at 320, -51 px of 640 x 480'),
  ],
)
def test_a_tilted_camera_is_the_reason_for_reading_nothing(
  tilt_deg: float,
  said: str,
  play: Callable[..., tuple],
  short: dict[str, object],
) -> None:
  def tilt(environment: composer.Environment) -> None:
    (each,) = environment.task.observers
    tilt_rad = math.radians(tilt_deg)
    up = (math.sin(tilt_rad), 0, math.cos(tilt_rad))
    each.eye.xyaxes = (0, -1, 0, *up)  # It looks down.

  scene = scenario.Scenario(observers=1, duration_s=16.0, **short)
  _, outcome = play(scene, 'klt', tilt)
  assert outcome.decoded is None
  sight = [each for each in outcome.failures if each.startswith('sight: ')]
  assert any(said in each for each in sight), outcome.failures


def test_a_vehicle_that_is_pushed_off_its_path_is_the_reason(
  play: Callable[..., tuple], short: dict[str, object]
) -> None:
  def push(step: episode.Step) -> None:
    physics = step.environment.physics
    wind_n = 0.15 if 4.0 < physics.time() < 8.0 else 0.0
    body = step.environment.task.performer.airframe
    physics.bind(body).xfrc_applied[:3] = (wind_n, 0.0, 0.0)

  scene = scenario.Scenario(observers=1, duration_s=20.0, **short)
  _, outcome = play(scene, 'view_bank', watch=push)
  (said,) = (each for each in outcome.failures if each.startswith('dance: '))
  assert 'mm off its path, first at 4.' in said


@pytest.mark.parametrize(
  ('receiver_name', 'needed_s'), [('klt', 3.76), ('view_bank', 3.08)]
)
def test_a_pause_must_hold_the_receivers_null(
  receiver_name: str, needed_s: float
) -> None:
  def scene(**pauses: float) -> scenario.Scenario:
    return scenario.Scenario(pauses=timing.Timing(**pauses))

  assert nulls.needed_s(receiver_name) == pytest.approx(needed_s)
  enough = scene(settle_s=needed_s, gap_s=0, lead_in_s=0)
  short = scene(settle_s=needed_s - 0.04, gap_s=0, lead_in_s=0)
  assert not nulls.check([enough], receiver_name)
  why = (
    f'got {needed_s - 0.04:.2f} s between gestures, of which a null of'
    f' {receiver_name} takes {needed_s:.2f} s'
  )
  with pytest.raises(nulls.PauseError, match=why):
    nulls.check([short, short], receiver_name)
  with pytest.raises(nulls.PauseError, match=r'got 2.50 s before START'):
    nulls.check([scene(initial_hover_s=2.5)], receiver_name)
  assert not nulls.check([short], f'{receiver_name}:separators=off')
  assert not nulls.check([short], f'{receiver_name}:hold_s=2.0')
  quiet = dataclasses.replace(short, control='no_send')
  assert not nulls.check([quiet], receiver_name)
  note = nulls.check([enough, short, quiet], receiver_name)
  assert note.startswith('1 of 3 scenarios cannot be read: `initial_hover_s`')
  assert note.endswith(why)


SHORT = ('--settle_s=0.5', '--lead_in_s=0.8')
SUITE = [{'name': 'short', 'pauses': {'settle_s': 0.5, 'lead_in_s': 0.8}}]


@pytest.mark.slow
@pytest.mark.parametrize(
  'command',
  [
    ('broadcast', *SHORT),
    ('sweep', '--grid', 'distance_m=1.0,1.3', *SHORT),
    ('suite', '--suite=mine.json'),
  ],
)
def test_what_cannot_be_read_is_refused_before_it_flies(
  command: tuple[str, ...], waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  (tmp_path / 'mine.json').write_text(json.dumps(SUITE), encoding='utf-8')
  child = waggle(*command, cwd=tmp_path)
  assert child.returncode == 2
  (line,) = child.stderr.strip().splitlines()
  assert 'got 3.30 s between gestures, of which a null of klt takes 3.76 s' in (
    line
  )
  assert [each.name for each in tmp_path.iterdir()] == ['mine.json']


def test_a_codebook_that_cannot_be_flown_is_refused_in_one_line(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle('broadcast', '--gesture_s=2', cwd=tmp_path)
  assert child.returncode == 2
  (line,) = child.stderr.strip().splitlines()
  assert '`gesture START` must accelerate upwards by at most 3.15' in line
  assert not [*tmp_path.iterdir()]
