"""The ladder of fidelity as text: what was measured, and how levels agree."""

from collections.abc import Iterable, Sequence
import dataclasses
import statistics

import numpy as np

from waggle_tasks.experiments.episodes import (
  ladder_row,
  ladder_table,
  word_level,
)
from waggle_tasks.experiments.machine import table as table_lib
from waggle_tasks.experiments.results import intervals

_DRAWN = 4_000  # Shares of each cell, for the limits of words.


@dataclasses.dataclass(frozen=True)
class Agreement:
  """How two levels agree in one cell, or in several.

  Attributes:
    cases: Broadcasts that were read on both levels.
    pixels: How many were read of pictures...
    tracks: ...and of tracks.
    only_pixels: How many were read of pictures alone...
    only_tracks: ...and of tracks alone.
  """

  cases: int
  pixels: int
  tracks: int
  only_pixels: int
  only_tracks: int

  @classmethod
  def of(cls, rows: Iterable[ladder_row.Row]) -> 'Agreement':
    """Counts some rows."""
    pairs = [(row.pixels == row.sent, row.tracks == row.sent) for row in rows]
    seen, told = (sum(each) for each in zip(*pairs, strict=True))
    alone = sum(p and not t for p, t in pairs)
    return cls(len(pairs), seen, told, alone, alone + told - seen)

  @property
  def limits(self) -> tuple[float, float]:
    """The 95 % interval of the share that is read of pictures."""
    return intervals.clopper_pearson(self.pixels, self.cases)

  @property
  def inside(self) -> bool:
    """Whether the share that is read of tracks is in it."""
    low, high = self.limits
    return low - 1e-9 <= self.tracks / self.cases <= high + 1e-9


def measured(table: ladder_table.Table) -> str:
  """A table for people: what was read, and how far off the tracker was."""
  rows = []
  for condition in ladder_table.CONDITIONS:
    cells = [c for c in table.cells if c.condition == condition]
    if not cells:
      continue
    tracks = [track for cell in cells for track in cell.tracks]
    sent, read = (sum(getattr(c, n) for c in cells) for n in ('sent', 'read'))
    low, high = intervals.clopper_pearson(read, sent)
    late_s = [late for cell in cells for late in cell.late_s]
    spread_px = [max(track.spread_px) for track in tracks]
    rows.append(
      (
        condition, str(len(cells)), f'{read}/{sent}',
        f'{low:.1%} to {high:.1%}', str(sum(c.wrong for c in cells)),
        table_lib.number(statistics.mean(late_s) if late_s else None),
        table_lib.number(statistics.median(spread_px) if tracks else None),
        table_lib.number(max(spread_px, default=None)),
        f'{statistics.mean(t.lost for t in tracks):.1%}' if tracks else '-',
      )
    )  # fmt: skip
  header = (
    'condition', 'cells', 'read', '95 %', 'wrong', 'late s', 'error px',
    'largest', 'lost',
  )  # fmt: skip
  return table_lib.render(header, rows)


def agreement(rows: Sequence[ladder_row.Row], table: ladder_table.Table) -> str:
  """How the levels agree on the same cases, for people."""
  lines = []
  for condition in dict.fromkeys(row.condition for row in rows):
    members = [row for row in rows if row.condition == condition]
    cells = _cells(members)
    apart = sum(not Agreement.of(cell).inside for cell in cells)
    whole = Agreement.of(members)
    low, high = whole.limits
    lines.append(
      (
        condition, str(len(cells)), f'{whole.pixels}/{whole.cases}',
        f'{low:.1%} to {high:.1%}', f'{whole.tracks}/{whole.cases}',
        _words(table, members), str(apart),
        f'{intervals.mcnemar(whole.only_pixels, whole.only_tracks):.2f}',
      )
    )  # fmt: skip
  header = (
    'condition', 'cells', 'pixels', '95 %', 'tracks', 'symbols', 'cells apart',
    'McNemar p',
  )  # fmt: skip
  return '\n'.join([table_lib.render(header, lines), '', *totals(rows)])


def totals(rows: Sequence[ladder_row.Row]) -> list[str]:
  """What holds for all cases together."""
  cells, whole = _cells(rows), Agreement.of(rows)
  apart = sum(not Agreement.of(cell).inside for cell in cells)
  wrong = [
    sum(getattr(row, level) not in (None, row.sent) for row in rows)
    for level in ('pixels', 'tracks')
  ]
  pixels_s = [row.pixels_s for row in rows]
  tracks_s = [row.tracks_s for row in rows]
  return [
    f'wrong messages: {wrong[0]} of {whole.cases} on pixels, {wrong[1]} on'
    ' tracks',
    f'cells with tracks inside the 95 % limits of pixels:'
    f' {len(cells) - apart} of {len(cells)}',
    f'cases read on one level alone: {whole.only_pixels} on pixels,'
    f' {whole.only_tracks} on tracks',
    f'processor time, median: {statistics.median(pixels_s):.2f} s on pixels,'
    f' {statistics.median(tracks_s):.3f} s on tracks; all together'
    f' {sum(pixels_s) / max(sum(tracks_s), 1e-9):.0f} times',
  ]


def _cells(
  rows: Iterable[ladder_row.Row],
) -> list[list[ladder_row.Row]]:
  groups: dict[tuple[str, float, float], list[ladder_row.Row]] = {}
  for row in rows:
    key = row.condition, row.distance_m, row.angle_deg
    groups.setdefault(key, []).append(row)
  return [*groups.values()]


def _words(table: ladder_table.Table, rows: Sequence[ladder_row.Row]) -> str:
  """The share that words are read at these places, with what is left open."""
  rng = np.random.default_rng(0)
  about = [
    (weight, cell)
    for row in rows
    for weight, cell in table.about(
      row.condition, row.distance_m, row.angle_deg
    )
  ]
  weights, cells = zip(*about, strict=True)
  drawn = word_level.shares(cells, table, _DRAWN, rng) @ np.array(weights)
  low, high = np.quantile(drawn / len(rows), [0.025, 0.975])
  return f'{low:.1%} to {high:.1%}'
