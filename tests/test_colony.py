"""Swarms choose as published models say, and as well as they read dances."""

from collections.abc import Callable
import dataclasses
import functools
import pathlib
import subprocess
from typing import Any

import numpy as np
import pytest

from waggle_tasks.experiments.episodes import (
  colony_limits,
  colony_swarm,
  colony_worlds,
  ladder_table,
  word_level,
)
from waggle_tasks.experiments.results import colony_tables
from waggle_tasks.experiments.studies import colony_study, pool

Waggle = Callable[..., subprocess.CompletedProcess[str]]
PERFECT = word_level.Watching('perfect')
SWARM = colony_swarm.Swarm(watching=PERFECT)


def hard_to_read(share: float) -> ladder_table.Table:
  """A table in which a share of all frames is read, and no doubt of it."""
  cell = ladder_table.Cell(
    'calm', 1.0, 0.0, 10**7, round(share * 10**7), 0, (), ()
  )
  return ladder_table.Table('', 'swift', 'joint', '', '', (cell,))


@pytest.mark.slow
def test_equal_sites_are_a_deadlock_below_the_critical_stop_signal() -> None:
  value = 3.0
  critical = colony_limits.critical_stop(value)
  assert critical == pytest.approx(1.6875)  # 4 v^3 / (v^2 - 1)^2.
  ends = {}
  for share in (0.9, 1.1):
    course = colony_limits.course(
      np.full(2, value), share * critical, [600.0], begin=[0.31, 0.30]
    )
    ends[share] = abs(course[-1, 0] - course[-1, 1])
  assert ends[0.9] < 1e-4
  assert ends[1.1] > 0.1


@pytest.mark.parametrize('read', [1.0, 0.5])
def test_many_vehicles_follow_the_equations_of_the_model(read: float) -> None:
  swarm = dataclasses.replace(
    SWARM, vehicles=20_000, noise=0.0, quorum=1.0, longest_s=1200.0,
    watching=word_level.Watching(near_m=1.0, far_m=1.0, aside_deg=0.0),
  )  # fmt: skip
  choice = colony_worlds.run(swarm, 1, 1, hard_to_read(read))
  times = swarm.rate * np.arange(1, len(choice.shares) + 1)
  told = colony_limits.course(swarm.values, swarm.stop, times, read)
  assert np.abs(choice.shares - told).max() < 0.05
  assert np.abs(choice.shares[-1] - told[-1]).max() < 0.02


def test_many_vehicles_dance_as_the_other_model_has_it_at_rest() -> None:
  swarm = colony_swarm.Swarm(
    vehicles=20_000, noise=0.0, model='list', value=10.0, quorum=1.0,
    qualities=(1.0, 0.9, 0.7, 0.5, 0.3), watching=PERFECT, longest_s=2000.0,
  )  # fmt: skip
  choice = colony_worlds.run(swarm, 1, 0)
  found = choice.shares[-60:].mean(axis=0)
  assert found == pytest.approx(colony_limits.list_shares(swarm), abs=0.02)


@pytest.mark.parametrize('model', colony_swarm.MODELS)
def test_a_better_site_is_chosen_more_surely(model: str) -> None:
  shares = []
  for ratio in (0.4, 0.95):
    swarm = dataclasses.replace(
      SWARM, vehicles=20, model=model, qualities=(1.0, ratio)
    )
    choice = colony_worlds.run(swarm, 200, 0)
    shares.append((choice.chosen == 0).mean())
  assert shares[0] > 0.75
  assert shares[1] < shares[0] - 0.1


@pytest.mark.parametrize('model', colony_swarm.MODELS)
def test_dances_that_are_hard_to_read_take_longer(model: str) -> None:
  swarm = dataclasses.replace(
    SWARM, model=model,
    watching=word_level.Watching(near_m=1.0, far_m=1.0, aside_deg=0.0),
  )  # fmt: skip
  steps = [
    np.median(colony_worlds.run(swarm, 60, 0, hard_to_read(share)).steps)
    for share in (1.0, 0.4)
  ]
  assert steps[1] > 1.2 * steps[0]


@pytest.mark.slow
def test_frames_that_are_read_wrongly_keep_a_swarm_from_agreeing() -> None:
  swarm = dataclasses.replace(SWARM, vehicles=50, qualities=(1.0, 0.8))
  right, wrong = (
    colony_worlds.run(dataclasses.replace(swarm, wrong=share), 100, 0).steps
    for share in (0.0, 0.5)
  )
  assert np.median(wrong) > 1.5 * np.median(right)


def test_a_swarm_follows_from_its_seed() -> None:
  first, again, other = (
    colony_worlds.run(SWARM, 20, seed) for seed in (1, 1, 2)
  )
  assert (first.steps == again.steps).all()
  assert (first.chosen == again.chosen).all()
  assert (first.steps != other.steps).any()


def test_a_swarm_that_cannot_agree_ends_in_time() -> None:
  swarm = dataclasses.replace(
    SWARM, qualities=(1.0, 1.0), stop=0.0, longest_s=600.0, vehicles=500
  )
  choice = colony_worlds.run(swarm, 5, 0)
  assert (choice.chosen == -1).all()
  assert (choice.steps == swarm.steps).all()


@pytest.mark.parametrize(
  ('values', 'named'),
  [
    ({'vehicles': 1}, '`vehicles` must be'),
    ({'qualities': (0.5, 1.0)}, '`qualities` must be'),
    ({'qualities': (1.0,)}, '`qualities` must be'),
    ({'qualities': (1.0, 0.0)}, '`qualities` must be'),
    ({'model': 'ants'}, '`model` must be'),
    ({'quorum': 0.4}, '`quorum` must be'),
    ({'noise': float('nan')}, '`noise` must be'),
    ({'longest_s': 1.0}, '`longest_s` must be'),
  ],
)
def test_a_swarm_that_cannot_be_is_refused(
  values: dict[str, Any], named: str
) -> None:
  with pytest.raises(colony_swarm.ColonyError, match=named):
    colony_swarm.Swarm(**values)


@pytest.mark.parametrize(
  ('values', 'named'),
  [
    ({'near_m': 0.7, 'far_m': 0.9}, 'measured'),
    ({'near_m': 3.0, 'far_m': 1.0}, '`far_m` must be'),
    ({'condition': 'fog'}, '`condition` must be'),
  ],
)
def test_places_that_were_not_measured_are_refused(
  values: dict[str, Any], named: str
) -> None:
  with pytest.raises(ladder_table.LadderError, match=named):
    word_level.Channel(
      word_level.Watching(**values), 1, np.random.default_rng(0)
    )


def study(folder: pathlib.Path, engine: pool.Engine) -> bytes:
  factors = {'vehicles': [10, 20], 'condition': ['perfect', 'calm']}
  cases = colony_study.cases(colony_swarm.Swarm(), factors, 20, 0)
  rows = colony_study.run(cases, folder, engine, 'waggle colony')
  assert len(colony_tables.table(rows)[1]) == 4
  return (folder / 'results.jsonl').read_bytes()


def here(jobs: list[pool.Job], most: int = 100) -> Any:  # noqa: ANN401
  """Does jobs in this process, the first few of them."""
  for number, job in enumerate(jobs):
    if number == most:
      raise KeyboardInterrupt
    yield pool.Done(job, job.do(lambda done_s: None))


@pytest.mark.slow
def test_a_study_that_was_ended_goes_on_to_the_same_bytes(
  tmp_path: pathlib.Path,
) -> None:
  whole = study(tmp_path / 'whole', here)
  with pytest.raises(KeyboardInterrupt):
    study(tmp_path / 'ended', functools.partial(here, most=2))
  assert not (tmp_path / 'ended' / 'results.jsonl').exists()
  done: list[str] = []

  def rest(jobs: list[pool.Job]) -> Any:  # noqa: ANN401
    done.extend(job.name for job in jobs)
    yield from here(jobs)

  assert study(tmp_path / 'ended', rest) == whole
  assert len(done) == 2


@pytest.mark.slow
def test_the_command_leaves_a_table_a_picture_and_a_page(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle(
    'colony', '--vehicles=10', '--ratios=0.5,0.9', '--worlds=10',
    '--workers=1', '--output=made', cwd=tmp_path,
  )  # fmt: skip
  assert done.returncode == 0, done.stderr
  assert 'perfect' in done.stdout
  assert 'calm' in done.stdout
  names = {path.name for path in (tmp_path / 'made').iterdir()}
  assert {'results.jsonl', 'summary.txt', 'index.html', 'colony.svg'} <= names
  bad = waggle('colony', '--vehicles=ten', '--output=other', cwd=tmp_path)
  assert bad.returncode == 2
  assert '`vehicles` must be numbers' in bad.stderr
  assert not (tmp_path / 'other').exists()
