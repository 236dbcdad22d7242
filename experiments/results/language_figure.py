"""Languages as a picture: their strokes from two sides, and a whole frame."""

from collections.abc import Mapping
import math
import pathlib
from typing import TYPE_CHECKING

import numpy as np

from waggle_tasks.experiments.results import figures, language_measure
from waggle_tasks.protocol import alphabets, languages, schedule, sights
from waggle_tasks.protocol.symbols import Symbol

if TYPE_CHECKING:
  from matplotlib import axes
  from matplotlib import figure as figure_lib

NAMES = 'languages.svg', 'languages.png'
_SIZE_IN = 12.0, 2.6  # Width of all, height of a line.
_SIDES_DEG = 0, sights.WIDEST_DEG
_SAID = '101110'  # A frame of which symbols differ.
_POINTS = 65  # Of a stroke.
_STEP_S = 0.02
_APART = 1.15  # Lanes are as far apart as the widest stroke is wide, and more.


def draw(
  shown: Mapping[str, languages.Language], folder: pathlib.Path
) -> list[pathlib.Path]:
  """Writes a line of panels for each language into one picture, twice.

  Args:
    shown: The languages by name.
    folder: Where the picture is put.

  Returns:
    The files.

  Raises:
    FigureError: without matplotlib.
  """

  def paint(figure: 'figure_lib.Figure') -> None:
    lines = figure.subplots(len(shown), len(_SIDES_DEG) + 1, squeeze=False)
    for line, (name, language) in zip(lines, shown.items(), strict=True):
      for axis, side_deg in zip(line, _SIDES_DEG, strict=False):
        _strokes(axis, language, side_deg)
        side = 'front' if not side_deg else f'side, {side_deg} degrees'
        axis.set_title(f'{pathlib.PurePath(name).name}, {side}', size=10)
      _frame(line[-1], language)

  size_in = _SIZE_IN[0], _SIZE_IN[1] * len(shown)
  return figures.write(
    paint, folder, NAMES, size_in, f'Pictures of languages {figures.NEEDED}.'
  )


def _paths(alphabet: sights.Alphabet) -> dict[str, schedule.Path]:
  """START, each symbol from where START ends, and END after the last one."""
  strokes = {
    sights.name_of(alphabet, symbol): alphabet.stroke(0, symbol)
    for symbol in range(alphabet.size)
  }
  end = alphabet.end(alphabet.after(alphabet.size - 1))
  return {Symbol.START.value: alphabet.start, **strokes, Symbol.END.value: end}


def _strokes(
  axis: 'axes.Axes', language: languages.Language, side_deg: float
) -> None:
  """Each stroke in a lane of its own; a dot is where it begins."""
  paths = _paths(language.alphabet)
  angle_rad = np.array([math.radians(side_deg)])
  flown = {n: alphabets.sample(path, _POINTS) for n, path in paths.items()}
  # As wide from every side, so that what a side hides is seen to be hidden.
  widths_m = [np.ptp(offsets_m[:, 0]) for offsets_m in flown.values()]
  lane_m = max(*widths_m, language.alphabet.highest_m / 2) * _APART
  for lane, offsets_m in enumerate(flown.values()):
    seen = sights.project(offsets_m, angle_rad, sights.DISTANCE_M)[0]
    across_m, up_m = lane * lane_m + seen[:, 0], -seen[:, 1]
    colour = f'C{lane % 10}'
    axis.plot(across_m, up_m, color=colour)
    axis.plot(across_m[:1], up_m[:1], 'o', color=colour, ms=4)
  axis.set_xticks(np.arange(len(flown)) * lane_m, [*flown], size=8)
  axis.set_xlim(-0.7 * lane_m, (len(flown) - 0.3) * lane_m)
  axis.set_ylabel('up, m')


def _frame(axis: 'axes.Axes', language: languages.Language) -> None:
  """Where a dancer is, from the first stroke to acceptance."""
  slots = language_measure.frame(language, _SAID)
  begin_s, end_s = slots[0].begin_s, slots[-1].end_s
  times_s = np.arange(0.0, end_s + language.confirm_s - begin_s, _STEP_S)
  dance = schedule.Schedule(slots)
  places_m = np.array([dance.motion(begin_s + t)[0] for t in times_s])
  axis.plot(times_s, places_m[:, 1], label='up')
  if places_m[:, 0].any():
    axis.plot(times_s, places_m[:, 0], '--', lw=0.8, label='right')
  for slot in slots:
    axis.axvline(
      slot.begin_s - slots[0].begin_s, color='0.85', lw=0.6, zorder=0
    )
  axis.axvline(slots[-1].end_s - slots[0].begin_s, color='0.5', lw=0.6, ls=':')
  axis.set_title(f'a frame: {_SAID}', size=10)
  axis.legend(fontsize=7, loc='upper right')
  axis.set_xlabel('s')
  axis.set_ylabel('m')
