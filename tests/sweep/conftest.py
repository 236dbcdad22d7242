"""Results of sweeps that nobody flew, and sweeps of a second each."""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import functools
import pathlib
import subprocess
import types

import numpy as np
import pytest

from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import scenario_fields, verdicts
from waggle_tasks.experiments.studies import (
  case_rows,
  pool,
  runner,
  sweep_cases,
  sweep_flight,
  sweep_study,
)

# What becomes of an observer of a case, by its number from 1; all is well
# where it says nothing.
Fate = Callable[[sweep_cases.Sample, int], dict[str, object]]
Row = case_rows.SweepRow
Waggle = Callable[..., subprocess.CompletedProcess[str]]

# Nothing is sent, so that a second is enough.
BRIEF = {'control': 'no_send', 'duration_s': 1.0, 'observers': 1}
GRID = ('distance_m=0.8,1.3', 'bearing_deg=0,40')
# They hold the wall clock, or the order in which cases ended.
UNEQUAL = {'provenance.json', 'journal.jsonl', '.lock'}


def _cases(
  *grid: str, repeats: int = 1, **base: object
) -> tuple[sweep_cases.Sample, ...]:
  return sweep_cases.cases(
    sweep_cases.grid(grid), scenario_fields.defaults() | base, repeats
  )


def _row(case: sweep_cases.Sample, fate: Fate, identity: str) -> Row:
  names = [f'observer_{n + 1}' for n in range(case.scene.observers)]
  outcomes = []
  for number, name in enumerate(names, 1):
    expected = evaluator.expected_bits(case.scene, number)
    usual = {'decoded': expected, 'start_s': expected and 95.6}
    fields = usual | fate(case, number)
    outcomes.append(verdicts.Outcome(name, expected, **fields))
  rollout = rollout_lib.Rollout(
    np.array([0.0, 101.0]), {}, (), dict.fromkeys(names, ()), 'none'
  )
  verdict = verdicts.Verdict(tuple(outcomes))
  return sweep_flight.row(case, 'view_bank', identity, rollout, verdict)


def _well(case: sweep_cases.Sample, number: int) -> dict[str, object]:
  del case, number
  return {}


def _rows(
  *grid: str, repeats: int = 1, fate: Fate = _well, **base: object
) -> list[Row]:
  made = _cases(*grid, repeats=repeats, **base)
  return [_row(case, fate, case.name) for case in made]


@pytest.fixture(scope='session')
def make() -> types.SimpleNamespace:
  """Makes `cases` of a grid over changed values, and the `rows` of a sweep."""
  return types.SimpleNamespace(cases=_cases, rows=_rows, row=_row, well=_well)


def _told(jobs: Sequence[pool.Job]) -> Iterator[pool.Done]:
  """Flies nothing: every case ends well."""
  for job in jobs:
    case, _, identity, _ = job.arguments
    yield pool.Done(job, _row(case, _well, identity))


@dataclasses.dataclass(frozen=True)
class Sweep:
  """A sweep and a folder for its results."""

  folder: pathlib.Path
  grid: tuple[str, ...] = GRID
  repeats: int = 1

  @property
  def cases(self) -> tuple[sweep_cases.Sample, ...]:
    """Its cases."""
    return _cases(*self.grid, repeats=self.repeats, **BRIEF)

  def run(self, engine: pool.Engine = _told) -> list[Row]:
    """Flies what is missing; by default without flying."""
    study = sweep_study.Sweep(self.cases, 'view_bank')
    return runner.run(study, self.folder, engine, 'waggle sweep')

  def fly(self, workers: int = 1) -> list[Row]:
    """Flies what is missing in worker processes."""
    return self.run(functools.partial(pool.run, workers=workers))

  def results(self) -> dict[str, bytes]:
    """Every file that must repeat bit for bit."""
    return {
      path.name: path.read_bytes()
      for path in sorted(self.folder.iterdir())
      if path.name not in UNEQUAL
    }

  @property
  def journal(self) -> pathlib.Path:
    """Its journal."""
    return self.folder / case_rows.JOURNAL


@pytest.fixture
def sweep(tmp_path: pathlib.Path) -> Sweep:
  """A sweep of four cells that was not run yet."""
  return Sweep(tmp_path / 'results')


@pytest.fixture(scope='session')
def told(tmp_path_factory: pytest.TempPathFactory) -> Sweep:
  """The same sweep, run without flying."""
  told = Sweep(tmp_path_factory.mktemp('told') / 'results')
  told.run()
  return told


@pytest.fixture(scope='session')
def flown(tmp_path_factory: pytest.TempPathFactory) -> Sweep:
  """The same sweep, flown one by one with nothing to disturb it."""
  flown = Sweep(tmp_path_factory.mktemp('flown') / 'results')
  flown.fly()
  return flown


@pytest.fixture
def here(waggle: Waggle, tmp_path: pathlib.Path) -> Waggle:
  """Runs `waggle` in a folder of its own."""
  return functools.partial(waggle, cwd=tmp_path)
