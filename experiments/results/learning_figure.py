"""How learners learned, as a picture by matplotlib."""

from collections.abc import Sequence
import pathlib
from typing import TYPE_CHECKING

import numpy as np

from waggle_tasks.experiments.results import figures, palette

if TYPE_CHECKING:
  from matplotlib import axes
  from matplotlib import figure as figure_lib

  from waggle_tasks.rl import curve

_SIDE_IN = 4.5, 3.4


def draw(
  game: str,
  curves: Sequence['curve.Curve'],
  by_hand: float,
  folder: pathlib.Path,
) -> list[pathlib.Path]:
  """Writes the curves into one picture, beside the language of the first seed.

  Args:
    game: What was learned, which names the picture.
    curves: Of one seed each.
    by_hand: The share that is understood of what was made by hand.
    folder: Where the picture is put.

  Returns:
    The files, SVG and PNG.

  Raises:
    FigureError: without matplotlib.
  """

  def paint(figure: 'figure_lib.Figure') -> None:
    axes = figure.subplots(1, count, squeeze=False)[0]
    _curves(axes[0], curves, by_hand)
    if means is not None:
      _language(axes[1], curves[0].seed, means)

  means = curves[0].means
  count = 1 if means is None else 2
  size = count * _SIDE_IN[0], _SIDE_IN[1]
  names = f'{game}.svg', f'{game}.png'
  missing = f'Pictures of learners {figures.NEEDED}.'
  return figures.write(paint, folder, names, size, missing)


def _curves(
  axis: 'axes.Axes', curves: Sequence['curve.Curve'], by_hand: float
) -> None:
  episodes = curves[0].episodes / 1000
  shares = np.stack([each.right for each in curves])
  for share in shares:
    axis.plot(episodes, share, color=palette.BLUE, lw=0.6, alpha=0.5)
  axis.plot(
    episodes, shares.mean(0), color=palette.BLUE, lw=2,
    label=f'learned, mean of {len(curves)} seeds',
  )  # fmt: skip
  axis.fill_between(
    episodes, shares.min(0), shares.max(0), color=palette.SKY, alpha=0.3, lw=0
  )
  axis.axhline(by_hand, color=palette.ORANGE, ls='--', label='made by hand')
  axis.set_xlabel('thousands of dances')
  axis.set_ylabel('share understood')
  axis.set_ylim(0, 1.03)
  axis.legend(loc='lower right', frameon=False)


def _language(axis: 'axes.Axes', seed: int, means: np.ndarray) -> None:
  colours = (
    palette.BLUE, palette.ORANGE, palette.GREEN, palette.VERMILLION,
    palette.PURPLE, palette.SKY, palette.BLACK, palette.YELLOW,
  )  # fmt: skip
  marks = 'osD^vPX*'
  strokes = means.shape[1]
  for number, heights in enumerate(means):
    corners = [0.0, *heights, 0.0]
    axis.plot(
      range(strokes + 2), corners, color=colours[number % len(colours)],
      marker=marks[number % len(marks)], lw=1, ms=4,
    )  # fmt: skip
  axis.set_xticks(range(strokes + 2))
  axis.set_xlabel('stroke')
  axis.set_ylabel('height, in 0.14 m')
  axis.set_title(f'what seed {seed} dances for each payload', size=10)
