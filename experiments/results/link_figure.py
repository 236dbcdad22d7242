"""What a link delivers, as a picture by matplotlib."""

from collections.abc import Sequence
import pathlib
from typing import TYPE_CHECKING, Any

from waggle_tasks.experiments.results import figures, goodput, palette
from waggle_tasks.experiments.studies import case_rows, link_cases

if TYPE_CHECKING:
  from matplotlib import axes
  from matplotlib import figure as figure_lib

MISSING = f'Pictures of a link {figures.NEEDED}.'
_SIZE_IN = 9.0, 3.6  # Width of all, height of a panel.
_COLOURS = (
  palette.BLUE, palette.ORANGE, palette.GREEN, palette.VERMILLION,
  palette.PURPLE, palette.SKY, palette.BLACK, palette.YELLOW,
)  # fmt: skip
# No colour stands alone.
_MARKS = 'osD^vPX*'
_DISTANCE = 'distance_m'
_BESIDE = 0.05  # So that limits of several schemes do not cover each other.


def draw(
  rows: Sequence[goodput.Row], folder: pathlib.Path
) -> list[pathlib.Path]:
  """Writes delivery against disturbance, and goodput against distance.

  The second is drawn where there are several distances.

  Args:
    rows: Results of whole messages.
    folder: Where they are put.

  Returns:
    The files of one picture, as SVG and as PNG.

  Raises:
    FigureError: without matplotlib.
  """
  count = 1 + (len({row.cell[_DISTANCE] for row in rows}) > 1)

  def paint(figure: 'figure_lib.Figure') -> None:
    first, *others = figure.subplots(count, 1, squeeze=False).flat
    _delivery(first, rows)
    for axis in others:
      _goodput(axis, rows)
    figure.legend(
      *first.get_legend_handles_labels(), loc='outside upper center', ncols=4
    )

  size_in = _SIZE_IN[0], _SIZE_IN[1] * count
  return figures.write(paint, folder, case_rows.LINK_FIGURES, size_in, MISSING)


def _delivery(axis: 'axes.Axes', rows: Sequence[goodput.Row]) -> None:
  """The share delivered in each condition, with limits: a line a scheme."""
  known = [name for (name,) in goodput.grouped(rows, link_cases.CONDITION)]
  schemes = goodput.grouped(rows, link_cases.SCHEME)
  for number, ((scheme,), members) in enumerate(schemes.items()):
    groups = goodput.grouped(members, link_cases.CONDITION)
    tallies = {name: goodput.tally(group) for (name,), group in groups.items()}
    places = [
      known.index(name) + _BESIDE * (number - (len(schemes) - 1) / 2)
      for name in tallies
    ]
    shares = [each.share for each in tallies.values()]
    low, high = zip(*(each.limits for each in tallies.values()), strict=True)
    below = [s - limit for s, limit in zip(shares, low, strict=True)]
    above = [limit - s for s, limit in zip(shares, high, strict=True)]
    axis.errorbar(
      places, shares, [below, above], label=scheme, capsize=2, lw=1,
      **_look(number),
    )  # fmt: skip
  axis.set_xticks(range(len(known)), known)
  axis.set_xlim(-0.5, len(known) - 0.5)
  axis.set_ylim(-0.03, 1.03)
  axis.set_ylabel('messages delivered, 95 %')
  axis.grid(axis='y', alpha=0.3)


def _goodput(axis: 'axes.Axes', rows: Sequence[goodput.Row]) -> None:
  """Bits delivered in a second at each distance, over all conditions."""
  schemes = goodput.grouped(rows, link_cases.SCHEME)
  for number, (_, members) in enumerate(schemes.items()):
    groups = goodput.grouped(members, _DISTANCE)
    places = sorted(groups)
    rates = [goodput.tally(groups[place]).goodput for place in places]
    axis.plot([m for (m,) in places], rates, **_look(number))
  axis.set_xlabel('distance, m')
  axis.set_ylabel('bit/s, all conditions')
  axis.set_yscale('log')
  axis.grid(alpha=0.3)


def _look(number: int) -> dict[str, Any]:
  return {
    'color': _COLOURS[number % len(_COLOURS)],
    'marker': _MARKS[number % len(_MARKS)],
    'ms': 4,
  }
