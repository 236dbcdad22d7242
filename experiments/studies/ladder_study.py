"""The rendered cases that the ladder of fidelity stands on."""

from collections.abc import Sequence
import dataclasses
import itertools
import pathlib

import numpy as np

from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import ladder_row, ladder_table
from waggle_tasks.experiments.record import provenance, scenario_fields
from waggle_tasks.experiments.studies import (
  batch,
  ladder_flight,
  link_conditions,
  link_schemes,
  pool,
  sweep_cases,
)
from waggle_tasks.protocol import checks

LANGUAGE, RECEIVER = 'swift', 'joint'
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
  places = {'distances': distances_m, 'bearings': angles_deg}
  for field, values in (('conditions', conditions), *places.items()):
    link_schemes.once(field, values)
  cells = itertools.product(distances_m, angles_deg, conditions)
  out = [_case(*cell, number) for cell in cells for number in numbers]
  # A broadcast of every cell before the next: the whole map is soon seen.
  return sorted(out, key=lambda each: each.repeat)


def _case(
  distance_m: float, angle_deg: float, condition: str, number: int
) -> sweep_cases.Sample:
  """One broadcast of a cell: what link sends, with black-outs of its own."""
  checks.choice(
    'conditions', condition, ladder_table.CONDITIONS, ladder_table.LadderError
  )
  known = link_conditions.CONDITIONS[condition]
  place = round(100 * distance_m), round(10 * abs(angle_deg)), number
  rng = np.random.default_rng(place)
  drawn = {
    name: round(float(rng.uniform(0.0, most)), 2)
    for name, most in known.drawn.items()
  }
  values = {
    **scenario_fields.defaults(), **known.values, **drawn,
    'language': LANGUAGE, 'observers': 1, 'payload': sweep_cases.RANDOM,
    'distance_m': distance_m, 'bearing_deg': angle_deg,
  }  # fmt: skip
  sample = sweep_cases.draw({}, values, number)
  cell = {
    'condition': condition, 'distance_m': distance_m, 'bearing_deg': angle_deg,
  }  # fmt: skip
  return dataclasses.replace(sample, cell=cell, receiver=RECEIVER)


def run(
  samples: Sequence[sweep_cases.Sample],
  both: bool,
  folder: pathlib.Path,
  engine: pool.Engine,
  command: str,
) -> list[ladder_row.Row]:
  """Renders cases, and makes their tracks too where `both` are asked for."""
  digest = provenance.source_digest(provenance.deciding_hashes())
  jobs = {}
  for case in samples:
    whole = identity_lib.of(case.scene, case.receiver, digest)
    identity = f'{whole} {"both" if both else "pixels"}'
    name = f'{case.cell["condition"]} {case.name}'
    jobs[identity] = batch.job(name, ladder_flight.fly, case, identity, both)
  what = 'ladder', _FILES
  return batch.run(jobs, ladder_row.Row, folder, engine, command, what)


def table(rows: Sequence[ladder_row.Row], command: str) -> ladder_table.Table:
  """What follows from rendered broadcasts."""
  groups: dict[tuple[str, float, float], list[ladder_row.Row]] = {}
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
  key: tuple[str, float, float], rows: Sequence[ladder_row.Row]
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
