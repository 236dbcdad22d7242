"""What swarms chose as text, beside what published models say."""

from collections.abc import Sequence
import math

from waggle_tasks.experiments.episodes import colony_limits
from waggle_tasks.experiments.machine import table as table_lib
from waggle_tasks.experiments.results import intervals
from waggle_tasks.experiments.studies import colony_study

PERFECT = 'perfect'


def report(rows: Sequence[colony_study.Row]) -> str:
  """The table, and what it means."""
  return '\n'.join([table_lib.render(*table(rows)), '', *legend(rows)])


def table(
  rows: Sequence[colony_study.Row],
) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
  """A line for each case: header and lines."""
  header = (
    'model', 'vehicles', 'qualities', 'noise', 'dances', 'frames read',
    'best site', '95 %', 'other', 'none', 'median s', 'middle half s',
    'endless swarm s',
  )  # fmt: skip
  return header, [_line(row) for row in rows]


def _line(row: colony_study.Row) -> tuple[str, ...]:
  swarm = row.case.swarm
  low, high = intervals.clopper_pearson(row.best, row.case.worlds)
  first, median, last = row.quantiles_s or (None, None, None)
  return (
    swarm.model,
    str(swarm.vehicles),
    ' '.join(f'{quality:g}' for quality in swarm.qualities),
    f'{swarm.noise:g}',
    swarm.watching.condition,
    f'{row.read:.1%}',
    f'{row.best}/{row.case.worlds}',
    f'{low:.1%} to {high:.1%}',
    str(row.other),
    str(row.none),
    table_lib.number(median, 0),
    f'{table_lib.number(first, 0)} to {table_lib.number(last, 0)}',
    endless(row),
  )


def endless(row: colony_study.Row) -> str:
  """When an endless swarm without noise has a quorum, for people."""
  if row.case.swarm.model != 'value':
    return '-'
  time_s = colony_limits.quorum_s(row.case.swarm, row.read)
  return 'never' if math.isinf(time_s) else f'{time_s:.0f}'


def legend(rows: Sequence[colony_study.Row]) -> list[str]:
  """What the columns mean, and what was watched in all."""
  frames = sum(row.frames for row in rows)
  out = [
    f'{sum(row.case.worlds for row in rows)} swarms in {len(rows)} cases,'
    f' {frames} frames watched.',
    'dances: how they are watched; perfect is the published model, in which'
    ' each is read. endless swarm: by the equations of Pais et al. 2013, with'
    ' the share of frames that is read, without noise.',
  ]
  if any(row.case.swarm.wrong for row in rows):
    shares = sorted({row.case.swarm.wrong for row in rows})
    told = ', '.join(f'{share:g}' for share in shares)
    out.append(f'Share of frames that were made wrong: {told}.')
  return out
