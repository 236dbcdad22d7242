"""The envelope of a sweep: its exposures counted by cell, and its axes."""

import collections
from collections.abc import Mapping, Sequence
import dataclasses
from typing import Any

from waggle_tasks.experiments.studies import case_rows, sweep_cases

Row = case_rows.SweepRow

_DOWN, _ACROSS = ('distance_m',), ('bearing_deg', 'half_span_deg')


@dataclasses.dataclass(frozen=True)
class Count:
  """What became of the exposures of a cell: one for each observer and case.

  Attributes:
    exposures: How many.
    right: How many read what was sent, or nothing where nothing was.
    wrong: How many read something else.
    unauthorised: How many moved without a message that was right.
  """

  exposures: int
  right: int
  wrong: int
  unauthorised: int


@dataclasses.dataclass(frozen=True)
class Failure:
  """An exposure that was not right, or a motion that nothing allowed.

  Attributes:
    row: Its case.
    observer: Who.
    reason: Every check of it that failed.
  """

  row: Row
  observer: str
  reason: str


@dataclasses.dataclass(frozen=True)
class Panel:
  """A map over two factors, the others being fixed.

  Attributes:
    fixed: The other factors and their values.
    down: The factor of its lines, or None.
    across: The factor of its columns, or None.
    downs: The values of its lines; [None] without a factor.
    acrosses: The values of its columns; the same.
    cells: The results by the values of `down` and `across`.
  """

  fixed: Mapping[str, Any]
  down: str | None
  across: str | None
  downs: Sequence[object]
  acrosses: Sequence[object]
  cells: Mapping[tuple[object, object], Sequence[Row]]

  @property
  def title(self) -> str:
    """The other factors as text; may be empty."""
    return sweep_cases.cell_name(self.fixed)

  @property
  def rows(self) -> list[Row]:
    """All results in it."""
    return [row for rows in self.cells.values() for row in rows]


def value(row: Row, factor: str | None) -> object:
  """A factor's value in a row; None for no factor."""
  if factor is None or factor == 'receiver':
    return factor and row.receiver
  return row.scenario[factor]


def factors(rows: Sequence[Row]) -> list[str]:
  """What differs between rows, beside seeds and payloads that were drawn."""
  drawn = {'seed'}
  if not all('payload' in row.cell for row in rows):
    drawn.add('payload')
  names = ['receiver', *(n for n in rows[0].scenario if n not in drawn)]
  return [name for name in names if len(_levels(rows, name)) > 1]


def count(rows: Sequence[Row]) -> Count:
  """Counts all exposures of some rows."""
  outcomes = [outcome for row in rows for outcome in row.outcomes]
  return Count(
    len(outcomes),
    sum(each.right for each in outcomes),
    sum(each.wrong for each in outcomes),
    sum(each.unauthorised for each in outcomes),
  )


def failures(rows: Sequence[Row]) -> list[Failure]:
  """Every exposure that was not right or moved without a right message."""
  return [
    Failure(row, outcome.observer, '; '.join(outcome.failures))
    for row in rows
    for outcome in row.outcomes
    if not outcome.right or outcome.unauthorised
  ]


def flaws_of_right(rows: Sequence[Row]) -> dict[str, int]:
  """How often each stage of a flight failed after a message was right."""
  stages = [
    stage
    for row in rows
    for outcome in row.outcomes
    if outcome.right and not outcome.unauthorised
    for stage in dict.fromkeys(outcome.stages)
  ]
  return dict(collections.Counter(stages))


def panels(rows: Sequence[Row]) -> list[Panel]:
  """The maps of a sweep, or of several together.

  Distance goes down and angle across where they are factors; otherwise the
  first of the other factors do. There is a map for every choice of the rest.
  """
  found = factors(rows)
  down = next((name for name in _DOWN if name in found), None)
  across = next((name for name in _ACROSS if name in found), None)
  rest = [name for name in found if name not in (down, across)]
  if down is None and rest:
    down = rest.pop(0)
  if across is None and rest:
    across = rest.pop(0)
  downs, acrosses = _levels(rows, down), _levels(rows, across)
  return [
    Panel(
      dict(zip(rest, values, strict=True)), down, across, downs, acrosses,
      _grouped(members, (down, across), (downs, acrosses)),
    )
    for values, members in _grouped(
      rows, rest, [_levels(rows, name) for name in rest]
    ).items()
  ]  # fmt: skip


def _levels(rows: Sequence[Row], name: str | None) -> list[Any]:
  """A factor's values: numbers in their order, others as they come."""
  levels = list(dict.fromkeys(value(row, name) for row in rows))
  numbers = all(isinstance(level, (int, float)) for level in levels)
  return sorted(levels) if numbers else levels


def _grouped(
  rows: Sequence[Row],
  names: Sequence[str | None],
  levels: Sequence[Sequence[object]],
) -> dict[tuple, list[Row]]:
  """Rows by their values of some factors, in the order of the levels."""
  groups: dict[tuple, list[Row]] = {}
  for row in rows:
    groups.setdefault(tuple(value(row, n) for n in names), []).append(row)
  places = [{level: n for n, level in enumerate(each)} for each in levels]

  def place(values: tuple) -> list[int]:
    return [each[value] for each, value in zip(places, values, strict=True)]

  return {values: groups[values] for values in sorted(groups, key=place)}
