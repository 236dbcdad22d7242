"""Flies the cases of a study into a folder, and goes on where it was ended."""

import abc
from collections.abc import Callable, Mapping, Sequence
import contextlib
import csv
import dataclasses
import io
import pathlib
from typing import Any, Generic, Protocol, TypeVar

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  encoding,
  provenance,
  result_folder,
  source_files,
)
from waggle_tasks.experiments.studies import case_rows, job_progress, pool

# After how many cases the sources are looked at again.
_CHECK_CASES = 50


class Case(Protocol):
  """One episode of a study: `suites.Case`, or `sweep_cases.Sample`."""

  @property
  def name(self) -> str:
    """What it is called; unique in its study."""
    ...

  @property
  def scene(self) -> scenario.Scenario:
    """What is flown."""
    ...


_Case = TypeVar('_Case', bound=Case)
_Row = TypeVar('_Row', case_rows.SuiteRow, case_rows.SweepRow)


class Study(abc.ABC, Generic[_Case, _Row]):
  """Cases, how one is flown, and how what comes out of it is kept."""

  kind: str  # For people.
  files: tuple[str, ...]  # What its folder may hold beside its tables.

  def __init__(self, cases: Sequence[_Case], receiver_name: str) -> None:
    """Makes a study.

    Args:
      cases: What is flown.
      receiver_name: The receiver of every observer.
    """
    self.cases = cases
    self.receiver_name = receiver_name

  def identity(self, case: _Case, digest: str) -> str:
    """What decides a case's result, see `identity.of`."""
    return identity_lib.of(case.scene, self.receiver_name, digest)

  def length_s(self, case: _Case) -> float:
    """How much of a case the bar counts."""
    return case.scene.episode_s

  @abc.abstractmethod
  def rank(self, case: _Case) -> float:
    """The cases with the least begin first."""

  @abc.abstractmethod
  def told(self, flown: int, active: Sequence[str]) -> str:
    """The words before the bar.

    Args:
      flown: How many cases are, those of before among them.
      active: The names of those that are under way.
    """

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
  scenes = (case.scene for case in study.cases)
  foreign = outside.paths(study.receiver_name, scenes)
  start = provenance.Start.now(command, foreign)
  own = provenance.deciding_hashes()
  sources = own | source_files.hashes(foreign)
  digest = provenance.source_digest(own)
  modules = tuple(outside.modules(foreign).items())
  identities = {case.name: study.identity(case, digest) for case in study.cases}
  names = case_rows.RESULTS, case_rows.TABLE, *study.files
  with result_folder.locked(folder, names, study.kind):
    known = study.known(folder, identities)
    missing = [case for case in study.cases if case.name not in known]
    jobs = [
      dataclasses.replace(
        study.job(case, identities[case.name], command, folder),
        modules=modules,
      )
      for case in sorted(missing, key=study.rank)
    ]
    lengths_s = {case.name: study.length_s(case) for case in missing}
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
    texts = [encoding.dumps(case_rows.table(row)) for row in rows]
    files.replace(
      folder / case_rows.RESULTS, ''.join(f'{text}\n' for text in texts)
    )
    files.replace(
      folder / case_rows.TABLE,
      _csv([line for row in rows for line in study.lines(row)]),
    )
    study.end(folder, rows, start, bool(jobs))
  return rows


def _csv(lines: Sequence[Mapping[str, Any]]) -> str:
  text = io.StringIO()
  writer = csv.DictWriter(text, [*lines[0]], lineterminator='\n')
  writer.writeheader()
  writer.writerows(lines)
  return text.getvalue()
