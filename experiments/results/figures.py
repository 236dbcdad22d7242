"""The envelope as pictures for papers, by matplotlib."""

from collections.abc import Callable, Sequence
import importlib.util
import io
import itertools
import math
import pathlib
from typing import TYPE_CHECKING, Any

import numpy as np

from waggle_tasks import errors
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.results import envelope, heat, palette
from waggle_tasks.experiments.studies import case_rows

if TYPE_CHECKING:
  from matplotlib import axes, image
  from matplotlib import figure as figure_lib

NEEDED = "need matplotlib: pip install 'waggle-tasks[analysis]'"
MISSING = (
  f'Pictures of the envelope {NEEDED}; then `waggle sweep --summary FOLDER`.'
)
_CELL_IN = 0.62, 0.42  # Width and height of a cell.
_MARGIN_IN = 1.3, 1.15
_DPI = 150


class FigureError(errors.WaggleError):
  """A picture that cannot be drawn here."""


def can_draw() -> bool:
  """Whether matplotlib is here."""
  return importlib.util.find_spec('matplotlib') is not None


def draw(
  panels: Sequence[envelope.Panel], folder: pathlib.Path
) -> list[pathlib.Path]:
  """Writes every map of an envelope into one picture, twice.

  Args:
    panels: The maps.
    folder: Where they are put.

  Returns:
    The files.

  Raises:
    FigureError: without matplotlib.
  """
  columns = min(len(panels), 2)
  lines = math.ceil(len(panels) / columns)
  width = max(len(panels[0].acrosses), 4) * _CELL_IN[0] + _MARGIN_IN[0]
  height = len(panels[0].downs) * _CELL_IN[1] + _MARGIN_IN[1]

  def paint(figure: 'figure_lib.Figure') -> None:
    places = figure.subplots(lines, columns, squeeze=False)
    drawn = [
      _panel(panel, axis)
      for panel, axis in zip(panels, places.flat, strict=False)
    ]
    for axis in places.flat[len(panels) :]:
      axis.set_axis_off()
    bar = figure.colorbar(drawn[-1], ax=places, shrink=0.8)
    bar.set_label('share of exposures that were right')
    if any(_unflown(panel) for panel in panels):
      _explain_white(figure)

  size_in = columns * width + 1, lines * height
  return write(paint, folder, case_rows.FIGURES, size_in, MISSING, _DPI)


def write(
  paint: Callable[['figure_lib.Figure'], None],
  folder: pathlib.Path,
  names: Sequence[str],
  size_in: tuple[float, float],
  missing: str,
  dpi: int = 100,
) -> list[pathlib.Path]:
  """Writes one picture twice, as SVG and as PNG.

  Args:
    paint: Draws it.
    folder: Where it is put, which is made where there is none.
    names: The names of its two files.
    size_in: Its width and height.
    missing: What is said where matplotlib is not.
    dpi: How fine the PNG is.

  Returns:
    The files.

  Raises:
    FigureError: without matplotlib.
  """
  if not can_draw():
    raise FigureError(missing)
  import matplotlib as mpl
  from matplotlib import figure as figure_lib

  # Letters stay letters, and equal pictures give equal files.
  settings: Any = {'svg.fonttype': 'none', 'svg.hashsalt': 'waggle'}
  with mpl.rc_context(settings):
    figure = figure_lib.Figure(size_in, layout='constrained')
    paint(figure)
    vectors, painted = io.BytesIO(), io.BytesIO()
    figure.savefig(vectors, format='svg', metadata={'Date': None})
    figure.savefig(painted, format='png', dpi=dpi)
  folder.mkdir(parents=True, exist_ok=True)
  return [
    files.replace(folder / name, data.getvalue())
    for name, data in zip(names, (vectors, painted), strict=True)
  ]


def _explain_white(figure: 'figure_lib.Figure') -> None:
  """A sample of it beside the words: white could be taken for a share."""
  from matplotlib import patches

  sample = patches.Patch(facecolor='w', edgecolor='0.5', hatch='////')
  figure.legend(
    handles=[sample], labels=['not flown'], loc='outside lower right'
  )


def _unflown(panel: envelope.Panel) -> list[tuple[object, object]]:
  """The places of a map that were not flown."""
  places = itertools.product(panel.downs, panel.acrosses)
  return [place for place in places if not panel.cells.get(place)]


def _panel(panel: envelope.Panel, axis: 'axes.Axes') -> 'image.AxesImage':
  """Draws one map and returns its image."""
  from matplotlib import colors, patches

  shares = np.full((len(panel.downs), len(panel.acrosses)), np.nan)
  for i, down in enumerate(panel.downs):
    for j, across in enumerate(panel.acrosses):
      if rows := panel.cells.get((down, across)):
        shares[i, j], words = heat.share(rows)
        ink = palette.ink(heat.colour(shares[i, j]))
        axis.text(j, i, words, ha='center', va='center', color=ink, size=8)
  colours = colors.LinearSegmentedColormap.from_list('share', heat.STOPS)
  shown = axis.imshow(shares, colours, vmin=0, vmax=1, aspect='auto')
  axis.set_xticks(range(len(panel.acrosses)), map(heat.label, panel.acrosses))
  axis.set_yticks(range(len(panel.downs)), map(heat.label, panel.downs))
  axis.set_facecolor('w')
  for down, across in _unflown(panel):
    place = panel.acrosses.index(across) - 0.5, panel.downs.index(down) - 0.5
    axis.add_patch(
      patches.Rectangle(place, 1, 1, fc='w', ec='0.5', hatch='////', lw=0)
    )
  axis.hlines(
    np.arange(len(panel.downs)) - 0.5, -0.5, shares.shape[1] - 0.5, 'w'
  )
  axis.vlines(np.arange(shares.shape[1]) - 0.5, -0.5, len(shares) - 0.5, 'w')
  axis.set_xlabel(heat.axis(panel.across))
  axis.set_ylabel(heat.axis(panel.down))
  axis.set_title(heat.title(panel), size=10)
  return shown
