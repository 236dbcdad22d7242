"""A small suite, its results when nothing disturbs it, and what to compare."""

from collections.abc import Generator, Sequence
import dataclasses
import functools
import json
import pathlib
import shutil

import pytest

from waggle_tasks import suites
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.studies import (
  case_rows,
  pool,
  runner,
  suite_study,
)

# The longest comes first to the workers, the shortest to the table.
ROWS = (
  {'name': 'silent', 'task': 'no_send', 'observers': 1, 'duration_s': 1},
  {'name': 'pair', 'task': 'no_send', 'observers': 2, 'duration_s': 4},
  {
    'name': 'dance',
    'observers': 1,
    'duration_s': 9.2,
    'codebook': {
      'half_width_m': 0.12,
      'start_height_m': 0.25,
      'duration_s': 2.0,
    },
    'pauses': {'initial_hover_s': 3.2, 'settle_s': 0.6, 'lead_in_s': 1.4},
  },
)
# One frame: as short as a case can be.
BLINK = ({'name': 'blink', 'task': 'no_send', 'duration_s': 0.04},)
# They hold the wall clock, or hashes of files that do.
CLOCKED = {'provenance.json', 'seal.json'}
PAGE = 'index.html'  # Of the suite: its launcher makes it.


def _here(
  jobs: Sequence[pool.Job],
) -> Generator[pool.Advance | pool.Done]:
  """Does jobs in this process, where no other is to be tested."""
  for job in jobs:
    told = []
    value = job.do(told.append)
    yield from (pool.Advance(job, amount) for amount in told)
    yield pool.Done(job, value)


@dataclasses.dataclass(frozen=True)
class Own:
  """A suite of one's own and a folder for its results.

  Attributes:
    rows: The suite.
    folder: Its results.
  """

  rows: Sequence[dict[str, object]]
  folder: pathlib.Path

  command = 'waggle suite --suite=own.json --receiver=klt'

  def run(self, workers: int = 0) -> list[case_rows.SuiteRow]:
    """Runs what is missing, in worker processes or in this one."""
    cases = suites.from_rows(self.rows)
    study = suite_study.Suite(cases, 'klt', run_page.leave)
    engine = functools.partial(pool.run, workers=workers) if workers else _here
    return runner.run(study, self.folder, engine, self.command)

  def results(self) -> dict[str, bytes]:
    """Every file that must repeat bit for bit."""
    files = {
      path.relative_to(self.folder).as_posix(): path.read_bytes()
      for path in sorted(self.folder.rglob('*'))
      if path.is_file() and path.name not in CLOCKED
    }
    files.pop(PAGE, None)
    return files

  def written(self) -> dict[str, int]:
    """When each file of the cases was last written, ns."""
    return {
      path.relative_to(self.folder).as_posix(): path.stat().st_mtime_ns
      for path in self.folder.glob('cases/*/*')
    }

  def home(self, name: str) -> pathlib.Path:
    """The folder of a case."""
    return self.folder / 'cases' / name

  def lines(self) -> list[dict[str, object]]:
    """The lines of results.jsonl."""
    text = (self.folder / 'results.jsonl').read_text(encoding='utf-8')
    return [json.loads(line) for line in text.splitlines()]

  def copy(self, folder: pathlib.Path) -> 'Own':
    """The same results in a new folder."""
    return Own(self.rows, shutil.copytree(self.folder, folder))


@pytest.fixture(scope='session')
def reference(tmp_path_factory: pytest.TempPathFactory) -> Own:
  """Three cases, run one by one with nothing to disturb them."""
  own = Own(ROWS, tmp_path_factory.mktemp('reference') / 'results')
  own.run(workers=1)
  return own


@pytest.fixture
def finished(reference: Own, tmp_path: pathlib.Path) -> Own:
  """A copy of it."""
  return reference.copy(tmp_path / 'results')


@pytest.fixture
def fresh(tmp_path: pathlib.Path) -> Own:
  """The same suite before it was run."""
  return Own(ROWS, tmp_path / 'results')


@pytest.fixture(scope='session')
def blink_reference(tmp_path_factory: pytest.TempPathFactory) -> Own:
  """One very short case, run."""
  own = Own(BLINK, tmp_path_factory.mktemp('blink') / 'results')
  own.run()
  return own


@pytest.fixture
def blink(blink_reference: Own, tmp_path: pathlib.Path) -> Own:
  """A copy of it."""
  return blink_reference.copy(tmp_path / 'results')


@pytest.fixture
def fresh_blink(tmp_path: pathlib.Path) -> Own:
  """The same suite before it was run."""
  return Own(BLINK, tmp_path / 'results')
