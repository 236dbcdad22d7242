"""The rendered cases that the ladder of fidelity stands on."""

from collections.abc import Sequence
import pathlib

from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import ladder_table
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.studies import (
  batch,
  ladder_flight,
  link_cases,
  link_schemes,
  pool,
  sweep_cases,
)

LANGUAGE, RECEIVER = 'swift', 'joint'
DISTANCES_M = (0.6, 1.0, 1.3, 2.0, 3.0)
ANGLES_DEG = (0.0, 30.0, 60.0, 75.0)
TABLE = 'ladder.json'
_FILES = TABLE, 'summary.txt', 'ladder.svg', 'ladder.png'


def cases(
  conditions: Sequence[str],
  distances_m: Sequence[float],
  angles_deg: Sequence[float],
  numbers: range,
) -> list[sweep_cases.Sample]:
  """The broadcasts of each cell, one observer each.

  Args:
    conditions: Some of `ladder_table.CONDITIONS`.
    distances_m: Where observers stand...
    angles_deg: ...and from where they look.
    numbers: Which of the broadcasts of a cell: others are other ones.

  Raises:
    WaggleError: if there is no such cell.
  """
  plan = link_cases.Plan(
    (link_schemes.Scheme(LANGUAGE, LANGUAGE, RECEIVER),),
    conditions, distances_m, angles_deg, numbers.stop, 1,
  )  # fmt: skip
  samples, _ = link_cases.cases(plan)
  # A repeat of every cell before the next: the whole map is soon seen.
  kept = [each for each in samples if each.repeat in numbers]
  return sorted(kept, key=lambda each: each.repeat)


def run(
  samples: Sequence[sweep_cases.Sample],
  both: bool,
  folder: pathlib.Path,
  engine: pool.Engine,
  command: str,
) -> list[ladder_flight.Row]:
  """Renders cases, and makes their tracks too where `both` are asked for."""
  digest = provenance.source_digest(provenance.deciding_hashes())
  jobs = {}
  for case in samples:
    whole = identity_lib.of(case.scene, case.receiver, digest)
    identity = f'{whole} {"both" if both else "pixels"}'
    name = f'{case.cell["condition"]} {case.name}'
    jobs[identity] = batch.job(name, ladder_flight.fly, case, identity, both)
  what = 'ladder', _FILES
  return batch.run(jobs, ladder_flight.Row, folder, engine, command, what)


def table(
  rows: Sequence[ladder_flight.Row], command: str
) -> ladder_table.Table:
  """What follows from rendered broadcasts."""
  groups: dict[tuple[str, float, float], list[ladder_flight.Row]] = {}
  for row in rows:
    key = row.condition, row.distance_m, row.angle_deg
    groups.setdefault(key, []).append(row)
  cells = tuple(_cell(key, members) for key, members in sorted(groups.items()))
  digest = provenance.source_digest(provenance.perception_hashes())
  renderers = ', '.join(sorted({row.renderer for row in rows}))
  return ladder_table.Table(
    command, LANGUAGE, RECEIVER, digest, renderers, cells
  )


def _cell(
  key: tuple[str, float, float], rows: Sequence[ladder_flight.Row]
) -> ladder_table.Cell:
  right = [row for row in rows if row.pixels == row.sent]
  return ladder_table.Cell(
    *key,
    sent=len(rows),
    read=len(right),
    wrong=sum(row.pixels not in (None, row.sent) for row in rows),
    late_s=tuple(row.late_s for row in right if row.late_s is not None),
    tracks=tuple(row.track for row in rows if row.track is not None),
  )
