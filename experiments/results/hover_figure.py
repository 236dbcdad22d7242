"""Hovers as a picture: how strong they are by frequency, and some time."""

from collections.abc import Mapping
import pathlib
from typing import TYPE_CHECKING

import numpy as np

from waggle_tasks.experiments.results import figures, hover_measure
from waggle_tasks.tasks import hover

if TYPE_CHECKING:
  from matplotlib import axes
  from matplotlib import figure as figure_lib

NAMES = 'hover.svg', 'hover.png'
_SIZE_IN = 9.0, 2.2  # Width of all, height of a line.
_SHOWN_S = 20.0
_RATE_HZ = 25.0
# Column of a signal, and colour; z is as x or y.
_LINES = {
  'x': (0, 'C0'), 'y': (1, 'C1'), 'roll': (3, 'C2'), 'pitch': (4, 'C3'),
  'yaw': (5, 'C4'),
}  # fmt: skip


def draw(
  spectra: Mapping[str, hover.Spectrum], folder: pathlib.Path
) -> list[pathlib.Path]:
  """Writes a line of panels for each hover into one picture, twice.

  Args:
    spectra: The hovers by name.
    folder: Where the picture is put.

  Returns:
    The files.

  Raises:
    FigureError: without matplotlib.
  """

  def paint(figure: 'figure_lib.Figure') -> None:
    places = figure.subplots(len(spectra), 3, squeeze=False)
    for line, (name, spectrum) in zip(places, spectra.items(), strict=True):
      _bands(line[0], pathlib.PurePath(name).name, spectrum)
      _times(line[1], line[2], spectrum)
    figure.legend(
      *places[0][0].get_legend_handles_labels(), loc='outside upper center',
      ncols=len(_LINES),
    )  # fmt: skip

  size_in = _SIZE_IN[0], _SIZE_IN[1] * len(spectra)
  return figures.write(
    paint, folder, NAMES, size_in, f'Pictures of hover {figures.NEEDED}.'
  )


def _bands(axis: 'axes.Axes', name: str, spectrum: hover.Spectrum) -> None:
  """Root mean square of each band, as steps over frequency."""
  for label, (index, colour) in _LINES.items():
    rms = [
      spectrum.x_mm, spectrum.y_mm, spectrum.z_mm,
      spectrum.roll_deg, spectrum.pitch_deg, spectrum.yaw_deg,
    ][index]  # fmt: skip
    style = '-' if index < 3 else '--'
    axis.stairs(
      rms, hover.EDGES_HZ, label=label, ls=style, color=colour, baseline=None
    )
  axis.set_xscale('log')
  axis.set_yscale('log')
  axis.set_title(name, size=10)
  axis.set_xlabel('Hz')
  axis.set_ylabel('rms, mm or deg')


def _times(
  places: 'axes.Axes', attitudes: 'axes.Axes', spectrum: hover.Spectrum
) -> None:
  """What one vehicle does."""
  moved, _ = hover_measure.signal(spectrum, 0, _SHOWN_S, _RATE_HZ)
  times_s = np.arange(len(moved)) / _RATE_HZ
  for index, colour in _LINES.values():
    axis = places if index < 3 else attitudes
    axis.plot(times_s, moved[:, index], lw=0.8, color=colour)
  for axis, unit in ((places, 'mm'), (attitudes, 'degrees')):
    axis.set_xlabel('s')
    axis.set_ylabel(unit)
