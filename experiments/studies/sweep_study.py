"""A sweep as a study: a journal keeps a line of each of its cases."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import pathlib
from typing import Any

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  journal,
  provenance,
)
from waggle_tasks.experiments.studies import (
  case_rows,
  pool,
  runner,
  sweep_cases,
  sweep_flight,
)


class Sweep(runner.Study[sweep_cases.Sample, case_rows.SweepRow]):
  """The cases of a sweep."""

  kind = 'sweep'
  files: tuple[str, ...] = (
    case_rows.JOURNAL, case_rows.PROVENANCE, case_rows.SUMMARY, archive.PAGE,
    *case_rows.FIGURES,
  )  # fmt: skip

  def rank(self, case: sweep_cases.Sample) -> float:
    """A repeat of every cell before the next: the whole map is soon seen."""
    return case.repeat

  def reader(self, case: sweep_cases.Sample) -> str:
    """Its own, or that of the sweep."""
    return case.receiver or self.receiver_name

  def told(self, flown: int, active: Sequence[str]) -> str:
    """How many cases were flown."""
    return super().told(flown, ())

  def known(
    self, folder: pathlib.Path, identities: Mapping[str, str]
  ) -> dict[str, case_rows.SweepRow]:
    """Rows of the journal, wherever they stand in this sweep."""
    path = folder / case_rows.JOURNAL
    found = {table['identity']: table for table in journal.read(path)}
    kept = [c for c in self.cases if identities[c.name] in found]
    tables = [found[identities[case.name]] for case in kept]
    made = archive.rows(tables, case_rows.SweepRow, path)
    return {
      case.name: dataclasses.replace(
        row, case=case.name, cell=dict(case.cell), repeat=case.repeat
      )
      for case, row in zip(kept, made, strict=True)
    }

  def job(
    self,
    case: sweep_cases.Sample,
    identity: str,
    command: str,
    folder: pathlib.Path,
  ) -> pool.Job:
    """Flies a case and makes its row."""
    del command, folder
    arguments = case, self.reader(case), identity, self.replays
    return pool.Job(case.name, sweep_flight.fly, arguments)

  @contextlib.contextmanager
  def keeping(
    self, folder: pathlib.Path
  ) -> Iterator[Callable[[pool.Done], case_rows.SweepRow]]:
    """Adds rows to the journal."""
    with journal.opened(folder / case_rows.JOURNAL) as log:

      def keep(done: pool.Done) -> case_rows.SweepRow:
        log.append(case_rows.table(done.value))
        return done.value

      yield keep

  def lines(self, row: case_rows.SweepRow) -> list[dict[str, Any]]:
    """One for each exposure, with every value of its scenario."""
    table = case_rows.table(row)
    del table['format']
    flat = {k: v for k, v in table.items() if not isinstance(v, (dict, list))}
    out = []
    for outcome in table['outcomes']:
      line = {**flat, **outcome, **table['scenario']}
      for field in ('failures', 'stages'):
        line[field] = '; '.join(line[field])
      out.append(line)
    return out

  def end(
    self,
    folder: pathlib.Path,
    rows: Sequence[case_rows.SweepRow],
    start: provenance.Start,
    flown: bool,
  ) -> None:
    """Leaves the provenance of what was flown."""
    path = folder / case_rows.PROVENANCE
    if flown or not path.exists():
      renderers = ', '.join(sorted({row.renderer for row in rows}))
      origin = encoding.stamped(start.end(renderers))
      files.replace(path, encoding.pretty(origin))
