"""Runs the cases of a sweep into a folder, and goes on where it was ended."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import csv
import datetime
import io
import json
import pathlib

from waggle_tasks.experiments import (
  archive,
  figures,
  files,
  job_progress,
  journal,
  outside,
  pool,
  provenance,
  records,
  replay_flight,
  result_folder,
  source_files,
  sweep_cases,
  sweep_flight,
)
from waggle_tasks.experiments.pages import document
from waggle_tasks.protocol import timing

JOURNAL, RESULTS, TABLE = 'journal.jsonl', 'results.jsonl', 'results.csv'
PROVENANCE, SUMMARY = 'provenance.json', 'summary.txt'
_NAMES = (
  JOURNAL, RESULTS, TABLE, PROVENANCE, SUMMARY, document.NAME, *figures.NAMES,
)  # fmt: skip
_FIELDS = {'case', 'cell', 'receiver', 'outcomes', 'scenario'}  # Of a row.
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
) -> list[dict[str, object]]:
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
  began = datetime.datetime.now(datetime.UTC)
  foreign = outside.paths(receiver_name, (case.scene for case in cases))
  own = provenance.source_hashes()
  sources = own | source_files.hashes(foreign)
  digest = provenance.source_digest(own)
  identities = [
    records.identity(case.scene, receiver_name, digest)
    + (f' {replays} replays' if replays else '')
    for case in cases
  ]
  modules = tuple(outside.modules(foreign).items())
  with result_folder.locked(folder, _NAMES, 'sweep'):
    known = {row['identity']: row for row in journal.read(folder / JOURNAL)}
    fly, more = sweep_flight.fly, ()
    if replays:
      fly, more = replay_flight.fly, (replays,)
    jobs = [
      pool.Job(case.name, fly, (case, receiver_name, identity, *more), modules)
      for case, identity in zip(cases, identities, strict=True)
      if identity not in known
    ]
    # A repeat of every cell before the next: the whole map is soon seen.
    jobs.sort(key=lambda job: job.arguments[0].repeat)
    with journal.opened(folder / JOURNAL) as log:
      for number, row in enumerate(_fly(jobs, engine, len(cases))):
        log.append(row)
        known[row['identity']] = row
        if number % _CHECK_CASES == 0:
          provenance.check_unchanged(sources, 'sweep', foreign)
    provenance.check_unchanged(sources, 'sweep', foreign)
    rows = [
      {**known[identity], **sweep_flight.head(case)}
      for case, identity in zip(cases, identities, strict=True)
    ]
    lines = ''.join(f'{records.dumps(row)}\n' for row in rows)
    files.replace(folder / RESULTS, lines)
    files.replace(folder / TABLE, _csv(rows))
    if jobs or not (folder / PROVENANCE).exists():
      renderers = ', '.join(sorted({row['renderer'] for row in rows}))
      origin = provenance.Provenance.of(command, renderers, began, foreign)
      files.replace(folder / PROVENANCE, records.pretty(origin))
  return rows


def read(folder: pathlib.Path) -> list[dict[str, object]]:
  """The rows of a sweep, or as many as there are yet.

  Raises:
    ArchiveError: if there are none, or they are damaged.
  """
  path = folder / RESULTS
  try:
    if path.exists():
      lines = path.read_text(encoding='utf-8').splitlines()
      rows = [json.loads(line) for line in lines]
    else:
      rows = journal.read(folder / JOURNAL)
  except (OSError, ValueError) as error:
    raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
  for row in rows:
    if not isinstance(row, dict) or not row.keys() >= _FIELDS:
      raise archive.ArchiveError(f'{path} must be results of a sweep')
  if not rows:
    raise archive.ArchiveError(f'{folder} holds no results of a sweep')
  return rows


def _fly(
  jobs: Sequence[pool.Job], engine: Engine, total: int
) -> Iterator[dict[str, object]]:
  """Runs jobs behind a progress bar and yields their rows."""
  frames = {
    job.name: timing.frames(job.arguments[0].scene.episode_s) for job in jobs
  }
  known = total - len(jobs)

  def describe(done: int, active: Sequence[str]) -> str:
    del active
    return f'{known + done}/{total} cases'

  for done in job_progress.shown(engine(jobs), frames, describe):
    yield done.value


def _csv(rows: Sequence[Mapping[str, object]]) -> str:
  """One line for each observer of each case."""
  lines = []
  for row in rows:
    flat = {k: v for k, v in row.items() if not isinstance(v, (dict, list))}
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
