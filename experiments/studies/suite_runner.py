"""Runs the cases of a suite into a folder, and goes on where it was ended."""

from collections.abc import Sequence
import contextlib
import csv
import io
import os
import pathlib
import shutil
from typing import Any

from waggle_tasks import suites
from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  folders,
  provenance,
  result_folder,
  source_files,
  writer,
)
from waggle_tasks.experiments.studies import job_progress, pool, suite_case

_CASES, _DRAFTS = 'cases', '.drafts'
_TABLES = 'results.jsonl', 'results.csv', archive.PAGE


def run(
  cases: Sequence[suites.Case],
  receiver_name: str,
  folder: pathlib.Path,
  workers: int,
  command: str,
  page: writer.Page,
) -> list[dict[str, Any]]:
  """Runs what is missing in a folder and returns one row for each case.

  Whatever ends it, the next call with the same arguments runs only the cases
  that are missing and ends with the same results.

  Args:
    cases: The suite.
    receiver_name: The receiver of every observer.
    folder: Where results are kept; made if needed.
    workers: How many processes, at least 1.
    command: The shell line of the suite; '--case=NAME' runs one case of it.
    page: Makes the page of a case's run folder.

  Returns:
    The rows of results.jsonl, in the order of `cases`.

  Raises:
    OutputError: if the folder cannot be used, or a case not be recorded; then
      those that were are kept.
    WorkerError: if a case failed again and again.
    SourceError: if sources changed meanwhile.
    UnknownSourceError: if code from outside has none.
  """
  foreign = outside.paths(receiver_name, (case.scene for case in cases))
  own = provenance.deciding_hashes()
  sources = own | source_files.hashes(foreign)
  digest = provenance.source_digest(own)
  identities = {
    case.name: identity_lib.of(case.scene, receiver_name, digest)
    for case in cases
  }
  names = _CASES, _DRAFTS, *_TABLES
  with result_folder.locked(folder, names, 'suite'):
    missing = _missing(cases, identities, folder)
    jobs = [
      pool.Job(
        case.name,
        suite_case.fly,
        (
          case, receiver_name, identities[case.name],
          f'{command} --case={case.name}', folder / _DRAFTS / case.name, page,
        ),
      )
      for case in sorted(missing, key=_size, reverse=True)
    ]  # fmt: skip
    try:
      _fly(jobs, folder, workers)
    finally:
      shutil.rmtree(folder / _DRAFTS, ignore_errors=True)
    provenance.check_unchanged(sources, 'suite', foreign)
    rows = [suite_case.row(c, folder / _CASES / c.name) for c in cases]
    files.replace(
      folder / 'results.jsonl',
      ''.join(f'{encoding.dumps(row)}\n' for row in rows),
    )
    files.replace(folder / 'results.csv', _csv(rows))
  return rows


def _missing(
  cases: Sequence[suites.Case],
  identities: dict[str, str],
  folder: pathlib.Path,
) -> list[suites.Case]:
  """The cases without sound results; unsound ones are put out of the way."""
  missing = []
  for case in cases:
    home = folder / _CASES / case.name
    if not home.exists():
      missing.append(case)
    elif flaw := suite_case.flaw(home, identities[case.name]):
      print(f'{case.name}: run anew: {flaw}')
      shutil.rmtree(home)
      missing.append(case)
  return missing


def _size(case: suites.Case) -> float:
  """How long a case takes: the longest begin first, to end together."""
  return case.scene.episode_s * case.scene.observers


def _fly(jobs: Sequence[pool.Job], folder: pathlib.Path, workers: int) -> None:
  """Runs jobs behind a progress bar of simulated seconds."""
  (folder / _CASES).mkdir(exist_ok=True)
  lengths_s = {job.name: job.arguments[0].scene.episode_s for job in jobs}
  # Closed here, whatever happens: no worker writes after that.
  with contextlib.closing(pool.run(jobs, workers)) as news:
    for done in job_progress.shown(
      news, lengths_s, lambda _, active: ', '.join(active)
    ):
      name = done.job.name
      if done.value is not None:
        raise folders.OutputError(
          f'`output` must be writable: {name} could not be recorded:'
          f' {done.value}; cases that were are kept'
        )
      os.replace(folder / _DRAFTS / name, folder / _CASES / name)


def _csv(rows: Sequence[dict[str, Any]]) -> str:
  """One line for each observer of each case."""
  text = io.StringIO()
  lines = csv.writer(text, lineterminator='\n')
  fields = [field for field in rows[0]['outcomes'][0] if field != 'failures']
  lines.writerow(
    ['group', 'case', 'receiver', *fields, 'failures', 'group_passed']
  )
  for row in rows:
    for outcome in row['outcomes']:
      values = ['' if outcome[f] is None else outcome[f] for f in fields]
      lines.writerow(
        [
          row['group'], row['case'], row['receiver'], *values,
          '; '.join(outcome['failures']), row['passed'],
        ]
      )  # fmt: skip
  return text.getvalue()
