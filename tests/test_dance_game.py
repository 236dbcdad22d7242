"""A language is learned from nothing, and the game's rules hold."""

from collections.abc import Callable
import json
import pathlib
import subprocess
import warnings

import numpy as np
import pettingzoo.test
import pytest

from waggle_tasks import rl
from waggle_tasks.protocol import levels, limits
from waggle_tasks.rl import by_hand, learners, needs, signals

Waggle = Callable[..., subprocess.CompletedProcess[str]]
QUICK = learners.Numbers(updates=200, batch=256, hidden=64)


def test_the_official_checks_pass() -> None:
  with warnings.catch_warnings():
    warnings.simplefilter('error')
    env = rl.Dance(listeners=2)
    pettingzoo.test.parallel_api_test(env, num_cycles=50)
    pettingzoo.test.parallel_seed_test(rl.Dance, num_cycles=20)


def test_who_understands_earns_and_the_speaker_earns_the_mean() -> None:
  env = rl.Dance(8, listeners=3, wrong=-0.5)
  seen, _ = env.reset(seed=4)
  meant = int(np.argmax(seen['speaker']))
  assert all(not seen[f'listener_{n}'].any() for n in (1, 2, 3))
  heights = by_hand.heights(8, 3)[meant].astype(np.float32)
  blank = {f'listener_{n}': 0 for n in (1, 2, 3)}
  seen, rewards, over, _, _ = env.step({'speaker': heights, **blank})
  assert not any(rewards.values())
  assert not any(over.values())
  told = by_hand.heights(8, 3)
  for n in (1, 2, 3):
    track = seen[f'listener_{n}'][None]
    assert by_hand.read(track, told, env.channel)[0] == meant
  said = {
    'listener_1': meant + 1,
    'listener_2': (meant + 1) % 8 + 1,
    'listener_3': 0,
  }
  _, rewards, over, late, infos = env.step({'speaker': heights, **said})
  assert rewards == {
    'speaker': pytest.approx(0.5 / 3),
    'listener_1': 1.0,
    'listener_2': -0.5,
    'listener_3': 0.0,
  }
  assert all(over.values())
  assert not any(late.values())
  assert infos['speaker'] == {'payload': meant}
  assert not env.agents


def test_every_dance_can_be_flown() -> None:
  channel = signals.Channel(6, error_m=0.0, lost_share=0.0)
  heights = np.random.default_rng(0).uniform(-2, 2, (200, 6))
  paths_m = channel.paths(heights, np.zeros(200))
  assert abs(paths_m).max() <= signals.REACH_M + 1e-9
  up_mps2 = np.diff(paths_m, 2, axis=1) * signals.RATE_HZ**2
  assert abs(up_mps2).max() <= limits.MAX_UP_MPS2
  steepest = signals.Channel(2).paths(np.array([[1.0, -1.0]]), np.zeros(1))
  assert np.ptp(steepest) == pytest.approx(2 * signals.REACH_M, abs=2e-3)
  assert levels.least_s(2 * signals.REACH_M) == signals.STROKE_S


@pytest.mark.slow
def test_a_pair_learns_a_language_of_its_own() -> None:
  curve = learners.train(4, signals.Channel(2), QUICK, seed=0)
  assert curve.right[0] < 0.6
  assert curve.right[-1] > 0.95
  assert abs(curve.means).max() <= 1
  again = learners.train(4, signals.Channel(2), QUICK, seed=0)
  assert (again.right == curve.right).all()
  assert (again.means == curve.means).all()


def test_nothing_is_learned_where_nothing_is_seen() -> None:
  channel = signals.Channel(2, lost_share=1.0)
  curve = learners.train(4, channel, QUICK, seed=0)
  assert curve.right[-1] < 0.5


def test_a_language_made_by_hand_is_understood() -> None:
  assert by_hand.understood(8, signals.Channel(3)) > 0.99
  assert by_hand.understood(64, signals.Channel(4)) > 0.99
  assert by_hand.understood(8, signals.Channel(3, error_m=0.1)) < 0.8


@pytest.mark.parametrize(
  ('make', 'words'),
  [
    (lambda: rl.Dance(1), '`payloads` must be'),
    (lambda: rl.Dance(8, 0), '`listeners` must be'),
    (lambda: rl.Dance(8, wrong=0.5), '`wrong` must be'),
    (lambda: signals.Channel(0), '`strokes` must be 1 to 16: got 0'),
    (lambda: signals.Channel(error_m=-1), '`error_m` must be 0 to 0.1'),
    (lambda: learners.Numbers(batch=1), '`batch` must be 8 to 65536: got 1'),
    (lambda: by_hand.heights(8, 2), '`strokes` must be 3 at least'),
    (lambda: rl.Dance().step({}), '`reset` must come before'),
  ],
)
def test_bad_choices_are_refused(
  make: Callable[[], object], words: str
) -> None:
  with pytest.raises((needs.LearningError, ValueError), match=words):
    make()


@pytest.mark.slow
def test_the_command_keeps_curves_and_draws_them(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle(
    'learn', '--payloads=4', '--seeds=2', '--updates=60',
    f'--output={tmp_path / "out"}',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  assert 'seed 1' in child.stdout
  assert 'made by hand: 1.000' in child.stdout
  kept = json.loads((tmp_path / 'out' / 'curves.json').read_text())
  assert [each['seed'] for each in kept['learners']] == [0, 1]
  assert np.shape(kept['learners'][0]['heights']) == (4, 3)
  assert (tmp_path / 'out' / 'dance.png').stat().st_size > 10_000


@pytest.mark.slow
def test_the_command_refuses_before_it_learns(waggle: Waggle) -> None:
  child = waggle('learn', '--strokes=2')
  assert child.returncode == 2
  assert '`strokes` must be' in child.stderr
