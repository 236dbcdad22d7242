"""A reader learns from its reward what dances mean."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import numpy as np
import pytest

pytest.importorskip('gymnasium')
from waggle_tasks import rl
from waggle_tasks.experiments.episodes import tracks_by_hand
from waggle_tasks.rl import glimpses, needs, readers

Waggle = Callable[..., subprocess.CompletedProcess[str]]
SEEN = glimpses.Glimpses()


def test_tracks_are_those_of_the_environment() -> None:
  """One is drawn as many are, and no two are alike."""
  env = rl.Read()
  first, _ = env.reset(seed=5)
  rows, late = [first], False
  while not late:
    row, _, _, late, _ = env.step(0)
    rows.append(row)
  rng = np.random.default_rng(5)
  values = rng.integers(64, size=1)
  assert np.array_equal(SEEN.draw(values, rng)[0], np.array(rows))
  many = SEEN.draw(np.full(4, 9), np.random.default_rng(0))
  assert many.shape == (4, SEEN.frames, 4)
  assert not np.array_equal(many[0], many[1])


@pytest.mark.slow
def test_what_was_made_by_hand_reads_them() -> None:
  assert tracks_by_hand.share(SEEN, count=6) == 1.0


@pytest.mark.slow
def test_it_learns_the_first_bits_from_rewards_alone_and_again_the_same() -> (
  None
):
  numbers = readers.Numbers(updates=120, batch=128, hidden=64)
  rng = np.random.default_rng(0)
  reader = readers.Reader(SEEN, numbers, rng)
  values = rng.integers(64, size=400)
  tracks, bits = SEEN.draw(values, rng), SEEN.bits(values)
  before = (reader.says(tracks) == bits).mean()
  for _ in range(numbers.updates):
    drawn = rng.integers(64, size=numbers.batch)
    reader.learn(SEEN.draw(drawn, rng), SEEN.bits(drawn), 0.2, rng)
  right = (reader.says(tracks) == bits).mean(0)
  assert right.mean() > before + 0.15
  assert right[0] > 0.98  # The first bit is which half of the levels.
  one, two = (readers.train(SEEN, QUICK, seed=3) for _ in range(2))
  assert np.array_equal(one.right, two.right)


QUICK = readers.Numbers(updates=3, batch=16, hidden=8)


def test_a_blind_reader_learns_nothing() -> None:
  dark = glimpses.Glimpses(lost_share=1.0)
  curve = readers.train(dark, QUICK, seed=0)
  assert curve.right.max() < 0.1


def test_bad_numbers_are_refused() -> None:
  for make, words in (
    (lambda: readers.Numbers(batch=8.5), '`batch` must be an integer'),
    (lambda: readers.Numbers(rate=0), '`rate` must be between'),
    (lambda: glimpses.Glimpses(error_m=1), '`error_m` must be between'),
  ):
    with pytest.raises(needs.LearningError, match=words):
      make()


@pytest.mark.slow
def test_the_command_keeps_curves_and_draws_them(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  child = waggle(
    'learn', '--game=read', '--seeds=1', '--updates=20',
    f'--output={tmp_path / "out"}',
  )  # fmt: skip
  assert child.returncode == 0, child.stderr
  by_hand = float(child.stdout.split('made by hand: ')[1].split()[0])
  assert by_hand > 0.9
  kept = json.loads((tmp_path / 'out' / 'curves.json').read_text())
  assert kept['game'] == 'read'
  assert 'heights' not in kept['learners'][0]
  assert (tmp_path / 'out' / 'read.png').stat().st_size > 10_000
  child = waggle('learn', '--game=read', '--payloads=4')
  assert child.returncode == 2
  assert '--payloads must not be given with --game=read' in child.stderr
