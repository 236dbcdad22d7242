"""Runs the cases of a sweep into a folder, and goes on where it was ended."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import csv
import io
import pathlib
from typing import Any

from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import outside
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  encoding,
  journal,
  provenance,
  result_folder,
  source_files,
)
from waggle_tasks.experiments.studies import (
  job_progress,
  pool,
  replay_flight,
  sweep_cases,
  sweep_flight,
  sweep_results,
)

# After how many cases the sources are looked at again.
_CHECK_CASES = 50

# Begins jobs in this order and tells what becomes of them, as `pool.run` does.
Engine = Callable[[Sequence[pool.Job]], Iterator[pool.Progress | pool.Done]]


def run(
  cases: Sequence[sweep_cases.Case],
  receiver_name: str,
  folder: pathlib.Path,
  engine: Engine,
  command: str,
  replays: int = 0,
) -> list[dict[str, Any]]:
  """Flies what is missing in a folder and returns one row for each case.

  A case is kept in the journal as soon as it was flown. Whatever ends the
  sweep, the next call with the same arguments flies only the cases that are
  missing and ends with the same results.

  Args:
    cases: The sweep.
    receiver_name: The receiver of every observer.
    folder: Where results are kept; made if needed.
    engine: What flies the cases.
    command: The shell line of the sweep.
    replays: How many times each observer's images are shown again, spoilt, see
      `replay_flight`; 0 to fly each case with its receivers.

  Returns:
    The rows of results.jsonl, in the order of `cases`.

  Raises:
    OutputError: if the folder cannot be used.
    WorkerError: if a case failed again and again.
    SourceError: if sources changed meanwhile.
    UnknownSourceError: if code from outside has none.
  """
  foreign = outside.paths(receiver_name, (case.scene for case in cases))
  start = provenance.Start.now(command, foreign)
  own = provenance.deciding_hashes()
  sources = own | source_files.hashes(foreign)
  digest = provenance.source_digest(own)
  identities = [
    identity_lib.of(case.scene, receiver_name, digest)
    + (f' {replays} replays' if replays else '')
    for case in cases
  ]
  modules = tuple(outside.modules(foreign).items())
  with result_folder.locked(folder, sweep_results.NAMES, 'sweep'):
    known = {
      row['identity']: row
      for row in journal.read(folder / sweep_results.JOURNAL)
    }
    fly: Callable[..., dict[str, Any]] = sweep_flight.fly
    more: tuple[int, ...] = ()
    if replays:
      fly, more = replay_flight.fly, (replays,)
    jobs = [
      pool.Job(case.name, fly, (case, receiver_name, identity, *more), modules)
      for case, identity in zip(cases, identities, strict=True)
      if identity not in known
    ]
    # A repeat of every cell before the next: the whole map is soon seen.
    jobs.sort(key=lambda job: job.arguments[0].repeat)
    with journal.opened(folder / sweep_results.JOURNAL) as log:
      flown = _fly(jobs, engine, len(cases), 1 + replays)
      for number, row in enumerate(flown):
        log.append(row)
        known[row['identity']] = row
        if number % _CHECK_CASES == 0:
          provenance.check_unchanged(sources, 'sweep', foreign)
    provenance.check_unchanged(sources, 'sweep', foreign)
    rows = [
      {**known[identity], **sweep_flight.head(case)}
      for case, identity in zip(cases, identities, strict=True)
    ]
    lines = ''.join(f'{encoding.dumps(row)}\n' for row in rows)
    files.replace(folder / sweep_results.RESULTS, lines)
    files.replace(folder / sweep_results.TABLE, _csv(rows))
    if jobs or not (folder / sweep_results.PROVENANCE).exists():
      renderers = ', '.join(sorted({row['renderer'] for row in rows}))
      origin = start.end(renderers)
      files.replace(
        folder / sweep_results.PROVENANCE,
        encoding.pretty(encoding.stamped(origin)),
      )
  return rows


def _fly(
  jobs: Sequence[pool.Job], engine: Engine, total: int, shows: int
) -> Iterator[dict[str, Any]]:
  """Runs jobs behind a progress bar and yields their rows.

  Args:
    jobs: One for each case.
    engine: What runs them.
    total: How many cases there are, those that were flown before included.
    shows: How often the images of each are seen, the flight included.
  """
  lengths_s = {
    job.name: shows * job.arguments[0].scene.episode_s for job in jobs
  }
  known = total - len(jobs)

  def describe(done: int, active: Sequence[str]) -> str:
    del active
    return f'{known + done}/{total} cases'

  for done in job_progress.shown(engine(jobs), lengths_s, describe):
    yield done.value


def _csv(rows: Sequence[Mapping[str, Any]]) -> str:
  """One line for each observer of each case."""
  lines = []
  for row in rows:
    flat = {k: v for k, v in row.items() if not isinstance(v, (dict, list))}
    del flat['format']
    for outcome in row['outcomes']:
      line = {**flat, **outcome, **row['scenario']}
      for field in ('failures', 'stages'):
        line[field] = '; '.join(line[field])
      lines.append(line)
  text = io.StringIO()
  writer = csv.DictWriter(text, [*lines[0]], lineterminator='\n')
  writer.writeheader()
  writer.writerows(lines)
  return text.getvalue()
