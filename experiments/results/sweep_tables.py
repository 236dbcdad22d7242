"""A sweep's results as tables for people."""

from collections.abc import Sequence
import json

from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.results import (
  envelope,
  heat,
  intervals,
  sweep_fit,
)
from waggle_tasks.experiments.studies import sweep_cases

_NOTHING = '-'  # A cell that was not flown.
_LEGEND = 'cells: exposures that were right, of all, and 95 % limits in percent'


def report(rows: Sequence[envelope.Row], most: int | None) -> str:
  """Every table of a sweep, or of several together.

  Args:
    rows: The results.
    most: How many weak cells and failures to list at most; None for all.
  """
  maps = envelope.panels(rows)
  parts = [
    *map(_panel, maps),
    _LEGEND,
    '\n'.join(totals(rows)),
    '\n'.join(_first(weak_cells(maps), most)),
    '\n'.join(line for panel in maps for line in sweep_fit.lines(panel)),
    '\n'.join(_first(_failures(rows), most)),
  ]
  return '\n\n'.join(filter(None, parts))


def _failures(rows: Sequence[envelope.Row]) -> list[str]:
  lines = [
    f'  {each.row.case}, {each.observer}: {each.reason}'
    for each in envelope.failures(rows)
  ]
  return ['failures:', *lines] if lines else []


def _first(lines: Sequence[str], most: int | None) -> list[str]:
  """A headline and the first lines of a list below it."""
  if most is None or len(lines) <= most + 1:
    return [*lines]
  return [*lines[: most + 1], f'  and {len(lines) - most - 1} more']


def _panel(panel: envelope.Panel) -> str:
  """A map: right of all exposures in each cell, and limits in percent."""
  corner = ' \\ '.join(filter(None, (panel.down, panel.across))) or 'all'
  header = [corner, *(heat.label(each) or 'right' for each in panel.acrosses)]
  cells = [
    [
      heat.label(down) or 'right',
      *(_cell(panel.cells.get((down, across))) for across in panel.acrosses),
    ]
    for down in panel.downs
  ]
  flown = [line for line in cells if {*line[1:]} != {_NOTHING}]
  head = f'{heat.title(panel)}:\n' if panel.fixed else ''
  return head + table.render(header, flown)


def _cell(rows: Sequence[envelope.Row] | None) -> str:
  if not rows:
    return _NOTHING
  got = envelope.count(rows)
  return cell(got.right, got.exposures)


def cell(right: int, exposures: int) -> str:
  """A cell such as '5/5 48-100'."""
  low, high = intervals.clopper_pearson(right, exposures)
  return f'{right}/{exposures} {low * 100:.0f}-{high * 100:.0f}'


def right_line(right: int, exposures: int) -> str:
  """How many exposures were right, with limits."""
  low, high = intervals.clopper_pearson(right, exposures)
  return (
    f'right: {right}/{exposures} exposures ({right / exposures:.2%}); 95 %'
    f' interval {low:.2%} to {high:.2%} (Clopper-Pearson)'
  )


def event_line(
  name: str, events: int, exposures: int, units: str = 'exposures'
) -> str:
  """How often something happened that must not, with its limit."""
  limit = intervals.upper_limit(events, exposures)
  return (
    f'{name}: {events} in {exposures} {units}; at most {limit:.3%}'
    ' (one-sided 95 % limit, Clopper-Pearson)'
  )


def totals(rows: Sequence[envelope.Row]) -> list[str]:
  """The sums over all exposures and their limits."""
  got = envelope.count(rows)
  n = got.exposures
  lines = [
    right_line(got.right, n),
    event_line('wrong messages', got.wrong, n),
    event_line('unauthorised motions', got.unauthorised, n),
  ]
  if stages := envelope.flaws_of_right(rows):
    listed = ', '.join(f'{name} {count}' for name, count in stages.items())
    lines.append(f'checks failed although reading was right: {listed}')
  # Two sweeps may hold the same broadcast: it counts once.
  told = {json.dumps(row.scenario, sort_keys=True) for row in rows}
  if len(told) < n:
    lines.append(
      f'The {n} exposures are those of {len(told)} broadcasts; observers of'
      ' one share its performer and scene, which the limits do not know.'
    )
  return lines


def weak_cells(maps: Sequence[envelope.Panel]) -> list[str]:
  """Where success falls below 90 %, cell by cell."""
  weak, cells = [], 0
  for panel in maps:
    for place, rows in panel.cells.items():
      cells += 1
      got = envelope.count(rows)
      if got.right < sweep_fit.LEVEL * got.exposures:
        names = (panel.down, panel.across)
        where = {n: v for n, v in zip(names, place, strict=True) if n}
        name = f'{panel.title} {sweep_cases.cell_name(where)}'.strip()
        weak.append(f'  {name}: {got.right}/{got.exposures}')
  if not weak:
    return [f'In none of the {cells} cells success falls below 90 %.']
  return [f'Success falls below 90 % in {len(weak)} of {cells} cells:', *weak]
