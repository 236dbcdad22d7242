"""Runs the cases of a suite into a folder, and goes on where it was ended."""

from collections.abc import Iterator, Sequence
import contextlib
import csv
import fcntl
import io
import os
import pathlib
import shutil

import tqdm

from waggle_tasks import errors, suites
from waggle_tasks.experiments import pool, provenance, records, suite_case
from waggle_tasks.protocol import timing

_CASES, _DRAFTS, _LOCK = 'cases', '.drafts', '.lock'


class SourceError(errors.WaggleError):
  """Sources that changed while a suite ran."""


def run(
  cases: Sequence[suites.Case],
  receiver_name: str,
  folder: pathlib.Path,
  workers: int,
  command: str,
) -> list[dict[str, object]]:
  """Runs what is missing in a folder and returns one row for each case.

  Whatever ends it, the next call with the same arguments runs only the cases
  that are missing and ends with the same results.

  Args:
    cases: The suite.
    receiver_name: The receiver of every observer.
    folder: Where results are kept; made if needed.
    workers: How many processes, at least 1.
    command: The shell line of the suite; '--case=NAME' runs one case of it.

  Returns:
    The rows of results.jsonl, in the order of `cases`.

  Raises:
    OutputError: if the folder cannot be used.
    WorkerError: if a case failed again and again.
    SourceError: if this project's sources changed meanwhile.
  """
  sources = provenance.source_hashes()
  digest = provenance.source_digest(sources)
  identities = {
    case.name: suite_case.identity(case, receiver_name, digest)
    for case in cases
  }
  with _locked(folder):
    missing = _missing(cases, identities, folder)
    jobs = [
      pool.Job(
        case.name,
        suite_case.fly,
        (
          case, receiver_name, identities[case.name],
          f'{command} --case={case.name}', folder / _DRAFTS / case.name,
        ),
      )
      for case in sorted(missing, key=_size, reverse=True)
    ]  # fmt: skip
    _fly(jobs, folder, workers)
    shutil.rmtree(folder / _DRAFTS, ignore_errors=True)
    if provenance.source_hashes() != sources:
      raise SourceError(
        'sources must not change while a suite runs: run it again, cases'
        ' of other sources are run anew'
      )
    rows = [suite_case.row(c, folder / _CASES / c.name) for c in cases]
    _write(
      folder / 'results.jsonl',
      ''.join(f'{records.dumps(row)}\n' for row in rows),
    )
    _write(folder / 'results.csv', _csv(rows))  # fmt: skip
  return rows


@contextlib.contextmanager
def _locked(folder: pathlib.Path) -> Iterator[None]:
  """Makes the folder and keeps a second run of a suite out of it."""
  try:
    folder.mkdir(parents=True, exist_ok=True)
    tables = ('results.jsonl', 'results.csv', 'index.html')
    known = {_CASES, _DRAFTS, _LOCK, *tables, *map(_draft_name, tables)}
    strange = {p.name for p in folder.iterdir()} - known
    if strange:
      raise records.OutputError(
        f'`output` must be new or hold results of a suite: {folder} holds'
        f' {sorted(strange)[0]}'
      )
    with (folder / _LOCK).open('w') as lock:
      fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
      yield
  except BlockingIOError:
    raise records.OutputError(
      f'`output` must not be in use: another run is writing {folder}'
    ) from None
  except OSError as error:
    raise records.OutputError(
      f'`output` must be writable: {folder}: {error.strerror}'
    ) from None


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
  """Runs jobs behind a progress bar of simulated frames."""
  (folder / _CASES).mkdir(exist_ok=True)
  lengths = {
    job.name: timing.frames(job.arguments[0].scene.episode_s) for job in jobs
  }
  flown, active = dict.fromkeys(lengths, 0), {}
  form = '{desc}|{bar}| {n:.0f}/{total:.0f} s simulated [{elapsed} <'
  with tqdm.tqdm(
    total=sum(lengths.values()), unit_scale=timing.FRAME_S, mininterval=0.5,
    bar_format=form + ' {remaining}]',
  ) as bar:  # fmt: skip
    for news in pool.run(jobs, workers):
      name = news.job.name
      if isinstance(news, pool.Progress):
        flown[name] = min(int(news.amount), lengths[name])
        active[name] = True
      else:
        os.replace(folder / _DRAFTS / name, folder / _CASES / name)
        flown[name] = lengths[name]  # Episodes may end before their time.
        active.pop(name, None)
      bar.set_description_str(f'{", ".join(active)} ', refresh=False)
      bar.update(sum(flown.values()) - bar.n)


def _csv(rows: Sequence[dict[str, object]]) -> str:
  """One line for each observer of each case."""
  text = io.StringIO()
  writer = csv.writer(text, lineterminator='\n')
  fields = [field for field in rows[0]['outcomes'][0] if field != 'failures']
  writer.writerow(
    ['group', 'case', 'receiver', *fields, 'failures', 'group_passed']
  )
  for row in rows:
    for outcome in row['outcomes']:
      values = ['' if outcome[f] is None else outcome[f] for f in fields]
      writer.writerow(
        [
          row['group'], row['case'], row['receiver'], *values,
          '; '.join(outcome['failures']), row['passed'],
        ]
      )  # fmt: skip
  return text.getvalue()


def _write(path: pathlib.Path, text: str) -> None:
  """Replaces a file as a whole."""
  draft = path.with_name(_draft_name(path.name))
  draft.write_text(text, encoding='utf-8')
  os.replace(draft, path)


def _draft_name(name: str) -> str:
  return f'.{name}.draft'
