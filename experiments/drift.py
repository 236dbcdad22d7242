"""Shows how vehicles hover: the presets, or a log of one's own.

Prints for each axis what windows of 4 s of generated signals show, beside what
the preset's source says: root mean square, speed, and each band of frequency.
Of --hover_log it prints what was taken from the log, and the value that a suite
takes as its `hover_log`. --output draws them.
"""

from collections.abc import Iterator, Mapping, Sequence
import json
import pathlib
import sys

from absl import flags

from waggle_tasks import plain
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import folders, hover_file
from waggle_tasks.experiments.results import hover_figure, hover_measure
from waggle_tasks.protocol import checks
from waggle_tasks.tasks import hover, hover_presets

_HOVER = flags.DEFINE_list(
  'hover', [*hover_presets.PRESETS], 'The presets to show.'
)
_LOG = flags.DEFINE_string(
  'hover_log', None, f'Show the hover of a log instead: {hover_file.ABOUT}.'
)
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Folder to draw hover.svg and hover.png in; needs matplotlib.'
)
_QUANTITIES = 'rms', 'speed', *hover_measure.BANDS


def main(argv: Sequence[str]) -> int:
  """Prints the tables and draws the picture; returns the exit status."""
  if argv[1:]:
    raise flags.Error(f'takes only flags, --name=value: got {argv[1]!r}.')
  spectra, published = {}, {}
  if _LOG.value is not None:
    spectra[_LOG.value] = hover_file.read(pathlib.Path(_LOG.value))
  for name in [] if spectra else _HOVER.value:
    known = [*hover_presets.PRESETS]
    checks.choice('hover', name, known, hover.HoverError)
    preset = hover_presets.PRESETS[name]
    spectra[name], published[name] = preset.spectrum, preset
  if _OUTPUT.value is not None:
    folders.check_writable(pathlib.Path(_OUTPUT.value))
  for name, spectrum in spectra.items():
    print(_report(name, spectrum, published.get(name)), end='\n\n')
  if _LOG.value is not None:
    (spectrum,) = spectra.values()
    print(json.dumps(plain.to_plain(spectrum)))
  if _OUTPUT.value is not None:
    print(*hover_figure.draw(spectra, pathlib.Path(_OUTPUT.value)), sep='\n')
  return 0


def _report(
  name: str, spectrum: hover.Spectrum, preset: hover_presets.Preset | None
) -> str:
  """The table of one hover."""
  source = {} if preset is None else preset.published
  rows = [*_rows(source, hover_measure.figures(spectrum))]
  bands = [f'{band} Hz' for band in hover_measure.BANDS]
  header = 'axis', 'from', 'rms', 'mm/s', *bands
  title = name if preset is None else f'{name}: {preset.source}'
  return f'{title}\n{table.render(header, rows)}'


def _rows(
  source: Mapping[str, hover_presets.Figures],
  signal: Mapping[str, hover_presets.Figures],
) -> Iterator[list[str]]:
  for axis, figures in signal.items():
    unit = 'mm' if 'speed' in figures else 'deg'
    for who, values in (('source', source.get(axis)), ('signal', figures)):
      if values is not None:
        cells = (table.number(values.get(each)) for each in _QUANTITIES)
        yield [f'{axis} {unit}', who, *cells]


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
