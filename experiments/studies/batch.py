"""Jobs whose results a journal keeps: ended at any moment, it goes on there."""

from collections.abc import Callable, Mapping, Sequence
import contextlib
import pathlib
from typing import Any

import tqdm

from waggle_tasks import plain
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  encoding,
  journal,
  provenance,
  result_folder,
)
from waggle_tasks.experiments.studies import case_rows, pool

_CHECK_JOBS = 50  # After how many the sources are looked at again.


def run(
  jobs: Mapping[str, pool.Job],
  row_type: type,
  folder: pathlib.Path,
  engine: pool.Engine,
  command: str,
  what: tuple[str, Sequence[str]],
) -> list[Any]:
  """Does the jobs that a folder lacks, and returns the rows of all.

  Args:
    jobs: By their identities, which rows have too, what makes each row.
    row_type: The dataclass of rows; it has an `identity`.
    folder: Where results are kept; made if needed.
    engine: What does the jobs.
    command: The shell line of this.
    what: What it is, for people, and which other files the folder may hold.

  Raises:
    OutputError: if the folder cannot be used.
    WorkerError: if a job failed again and again; what is done is kept.
    SourceError: if sources changed meanwhile.
  """
  kind, others = what
  start, sources = provenance.Start.now(command), provenance.deciding_hashes()
  names = case_rows.RESULTS, case_rows.JOURNAL, case_rows.PROVENANCE, *others
  path = folder / case_rows.JOURNAL
  with result_folder.locked(folder, names, kind):
    known = {table['identity']: table for table in journal.read(path)}
    missing = [job for each, job in jobs.items() if each not in known]
    with (
      journal.opened(path) as log,
      contextlib.closing(engine(missing)) as news,
      tqdm.tqdm(total=len(missing), desc=kind, mininterval=0.5) as bar,
    ):
      for each in news:
        if not isinstance(each, pool.Done):
          continue
        table = encoding.stamped(each.value)
        log.append(table)
        known[table['identity']] = table
        bar.update()
        if bar.n % _CHECK_JOBS == 0:
          provenance.check_unchanged(sources, kind)
    provenance.check_unchanged(sources, kind)
    tables = [known[identity] for identity in jobs]
    lines = ''.join(f'{encoding.dumps(table)}\n' for table in tables)
    files.replace(folder / case_rows.RESULTS, lines)
    origin = folder / case_rows.PROVENANCE
    if missing or not origin.exists():
      files.replace(
        origin, encoding.pretty(encoding.stamped(start.end('none')))
      )
  return [
    plain.from_plain(row_type, encoding.unstamped(table, path))
    for table in tables
  ]


def job(name: str, work: Callable, *arguments: object) -> pool.Job:
  """A job of this."""
  return pool.Job(name, work, arguments)
