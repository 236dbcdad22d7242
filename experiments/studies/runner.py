"""Flies the cases of a study into a folder, and goes on where it was ended."""

import abc
from collections.abc import Callable, Mapping, Sequence
import contextlib
import csv
import dataclasses
import io
import pathlib
from typing import Any, Generic, TypeVar

from waggle_tasks import scenario, suites
from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  encoding,
  provenance,
  result_folder,
  source_files,
)
from waggle_tasks.experiments.studies import (
  case_rows,
  job_progress,
  pool,
  sweep_cases,
)

# After how many cases the sources are looked at again.
_CHECK_CASES = 50

_Case = TypeVar('_Case', suites.Case, sweep_cases.Sample)
_Row = TypeVar('_Row', case_rows.SuiteRow, case_rows.SweepRow)


class Study(abc.ABC, Generic[_Case, _Row]):
  """Cases, how one is flown, and how what comes out of it is kept."""

  kind: str  # For people.
  files: tuple[str, ...]  # What its folder may hold beside its tables.

  def __init__(
    self, cases: Sequence[_Case], receiver_name: str, replays: int = 0
  ) -> None:
    """Makes a study.

    Args:
      cases: What is flown.
      receiver_name: The receiver of every observer.
      replays: How many times each observer's images are shown again, spoilt,
        see `replay_flight`; 0 to fly each case with its receivers.
    """
    self.cases: Sequence[_Case] = cases
    self.receiver_name = receiver_name
    self.replays = replays

  def rank(self, case: _Case) -> float:
    """Cases begin in this order: the longest first, to end together."""
    return -case.scene.episode_s * case.scene.observers

  def reader(self, case: _Case) -> str:
    """The receiver of a case."""
    del case
    return self.receiver_name

  def beside(self, case: _Case) -> str:
    """What else than its episode decides the result of a case, as text."""
    del case
    return f' {self.replays} replays' if self.replays else ''

  def told(self, flown: int, active: Sequence[str]) -> str:
    """The words before the bar: who is under way, or how many were flown."""
    return ', '.join(active) or f'{flown}/{len(self.cases)} cases'

  @abc.abstractmethod
  def known(
    self, folder: pathlib.Path, identities: Mapping[str, str]
  ) -> dict[str, _Row]:
    """The rows of cases that were flown before, by their names."""

  @abc.abstractmethod
  def job(
    self, case: _Case, identity: str, command: str, folder: pathlib.Path
  ) -> pool.Job:
    """What a worker does to fly a case."""

  @abc.abstractmethod
  def keeping(
    self, folder: pathlib.Path
  ) -> contextlib.AbstractContextManager[Callable[[pool.Done], _Row]]:
    """While it is open, puts what is done on the disk and makes its row."""

  @abc.abstractmethod
  def lines(self, row: _Row) -> list[dict[str, Any]]:
    """The lines of a row in results.csv, one for each observer."""

  def end(
    self,
    folder: pathlib.Path,
    rows: Sequence[_Row],
    start: provenance.Start,
    flown: bool,
  ) -> None:
    """Leaves what follows from all rows, some of which were just flown."""


def run(
  study: Study[_Case, _Row],
  folder: pathlib.Path,
  engine: pool.Engine,
  command: str,
) -> list[_Row]:
  """Flies what is missing in a folder and returns one row for each case.

  A case is kept as soon as it was flown. Whatever ends the study, the next call
  with the same arguments flies only the cases that are missing and ends with
  the same results.

  Args:
    study: What is flown.
    folder: Where results are kept; made if needed.
    engine: What flies the cases.
    command: The shell line of the study.

  Returns:
    The rows of results.jsonl, in the order of the cases.

  Raises:
    OutputError: if the folder cannot be used, or a case not be recorded; then
      those that were are kept.
    WorkerError: if a case failed again and again.
    SourceError: if sources changed meanwhile.
    UnknownSourceError: if code from outside has none.
  """
  foreign = _foreign(study)
  start = provenance.Start.now(command, foreign)
  own = provenance.deciding_hashes()
  sources = own | source_files.hashes(foreign)
  digest = provenance.source_digest(own)
  modules = tuple(outside.modules(foreign).items())
  shows = 1 + study.replays
  identities = {
    case.name: identity_lib.of(case.scene, study.reader(case), digest)
    + study.beside(case)
    for case in study.cases
  }
  names = case_rows.RESULTS, case_rows.TABLE, *study.files
  with result_folder.locked(folder, names, study.kind):
    known = study.known(folder, identities)
    missing = [case for case in study.cases if case.name not in known]
    jobs = [
      study.job(case, identities[case.name], command, folder)
      for case in sorted(missing, key=study.rank)
    ]
    jobs = [dataclasses.replace(job, modules=modules) for job in jobs]
    lengths_s = {case.name: shows * case.scene.episode_s for case in missing}
    # Workers are ended before the place where they write is cleared.
    with (
      study.keeping(folder) as keep,
      contextlib.closing(engine(jobs)) as news,
    ):
      flown = job_progress.shown(
        news, lengths_s, lambda _, active: study.told(len(known), active)
      )
      for number, done in enumerate(flown):
        known[done.job.name] = keep(done)
        if number % _CHECK_CASES == 0:
          provenance.check_unchanged(sources, study.kind, foreign)
    provenance.check_unchanged(sources, study.kind, foreign)
    rows = [known[case.name] for case in study.cases]
    _write(study, folder, rows)
    study.end(folder, rows, start, bool(jobs))
  return rows


def _foreign(study: Study[_Case, _Row]) -> dict[str, pathlib.Path]:
  """The files of code from outside, of all receivers and scenarios."""
  scenes: dict[str, list[scenario.Scenario]] = {}
  for case in study.cases:
    scenes.setdefault(study.reader(case), []).append(case.scene)
  out: dict[str, pathlib.Path] = {}
  for name, watched in scenes.items():
    out |= outside.paths(name, watched)
  return out


def _write(
  study: Study[_Case, _Row], folder: pathlib.Path, rows: Sequence[_Row]
) -> None:
  """Writes the tables."""
  texts = [encoding.dumps(case_rows.table(row)) for row in rows]
  lines = ''.join(f'{text}\n' for text in texts)
  files.replace(folder / case_rows.RESULTS, lines)
  cells: list[dict[str, Any]] = [
    line for row in rows for line in study.lines(row)
  ]
  text = io.StringIO()
  writer = csv.DictWriter(text, [*cells[0]], lineterminator='\n')
  writer.writeheader()
  writer.writerows(cells)
  files.replace(folder / case_rows.TABLE, text.getvalue())
