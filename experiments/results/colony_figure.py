"""What swarms chose, as a picture by matplotlib."""

from collections.abc import Sequence
import math
import pathlib
from typing import TYPE_CHECKING, Any

from waggle_tasks.experiments.episodes import colony_limits
from waggle_tasks.experiments.results import (
  colony_tables,
  figures,
  intervals,
  palette,
)
from waggle_tasks.experiments.studies import colony_study

if TYPE_CHECKING:
  from matplotlib import axes
  from matplotlib import figure as figure_lib

MISSING = f'Pictures of a colony {figures.NEEDED}.'
_SIZE_IN = 9.0, 7.0
_COLOURS = (
  palette.BLUE, palette.ORANGE, palette.GREEN, palette.VERMILLION,
  palette.PURPLE, palette.SKY, palette.BLACK, palette.YELLOW,
)  # fmt: skip
_MARKS = 'osD^vPX*'  # No colour stands alone.
_Key = tuple[str, int, float, str]


def draw(
  rows: Sequence[colony_study.Row], folder: pathlib.Path
) -> list[pathlib.Path]:
  """Writes accuracy and time against the quality of the second site.

  Full lines are swarms that read dances as measured, dashed ones the published
  model, in which each is read; dotted ones an endless swarm.

  Args:
    rows: Results.
    folder: Where they are put.

  Returns:
    The files of one picture, as SVG and as PNG.

  Raises:
    FigureError: without matplotlib.
  """

  def paint(figure: 'figure_lib.Figure') -> None:
    accuracy, times = figure.subplots(2, 1, sharex=True)
    lines = _lines(rows)
    sizes = sorted({(key[0], key[1], key[2]) for key in lines})
    for key, members in lines.items():
      _line(accuracy, times, key, members, sizes.index(key[:3]))
    accuracy.set_ylabel('chose the best site, 95 %')
    times.set_ylabel('median time to a quorum, s')
    times.set_yscale('log')
    times.set_xlabel('quality of the second site over that of the best')
    for axis in (accuracy, times):
      axis.grid(alpha=0.3)
    figure.legend(
      *accuracy.get_legend_handles_labels(), loc='outside upper center', ncols=2
    )

  return figures.write(paint, folder, colony_study.FIGURES, _SIZE_IN, MISSING)


def _lines(
  rows: Sequence[colony_study.Row],
) -> dict[_Key, list[colony_study.Row]]:
  out: dict[_Key, list[colony_study.Row]] = {}
  for row in sorted(rows, key=_ratio):
    swarm = row.case.swarm
    key = swarm.model, swarm.vehicles, swarm.noise, swarm.watching.condition
    out.setdefault(key, []).append(row)
  return out


def _ratio(row: colony_study.Row) -> float:
  first, second, *_ = row.case.swarm.qualities
  return second / first


def _line(
  accuracy: 'axes.Axes',
  times: 'axes.Axes',
  key: _Key,
  rows: Sequence[colony_study.Row],
  number: int,
) -> None:
  model, vehicles, noise, condition = key
  published = condition == colony_tables.PERFECT
  look: dict[str, Any] = {
    'color': _COLOURS[number % len(_COLOURS)],
    'marker': _MARKS[number % len(_MARKS)],
    'ms': 4,
    'lw': 1,
    'ls': '--' if published else '-',
  }
  label = f'{model}, {vehicles} vehicles, noise {noise:g}, {condition}'
  ratios = [_ratio(row) for row in rows]
  shares = [row.best / row.case.worlds for row in rows]
  limits = [
    intervals.clopper_pearson(row.best, row.case.worlds) for row in rows
  ]
  below = [s - low for s, (low, _) in zip(shares, limits, strict=True)]
  above = [high - s for s, (_, high) in zip(shares, limits, strict=True)]
  accuracy.errorbar(
    ratios, shares, [below, above], label=label, capsize=2, **look
  )
  chose = [(r, row) for r, row in zip(ratios, rows, strict=True) if row.best]
  times.plot(
    [ratio for ratio, _ in chose], [row.quantiles_s[1] for _, row in chose],
    **look,
  )  # fmt: skip
  if model == 'value' and published:
    ends = [colony_limits.quorum_s(row.case.swarm) for row in rows]
    known = [p for p in zip(ratios, ends, strict=True) if math.isfinite(p[1])]
    if known:
      times.plot(*zip(*known, strict=True), color=look['color'], ls=':', lw=1)
