"""How vehicles hovered: how far, how fast, and at which frequencies.

Measured as hovers are (`hover_measure`), in every whole window in which a
vehicle was to stay where it was, and set beside what was asked for.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from waggle_tasks.experiments.pages import flights, markup, plot
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import hover_measure
from waggle_tasks.tasks import hover, hover_presets

_AXES = 'x', 'y', 'z'
_LOOKS = 'a', 'b', 'c'
_WIDTH, _HEIGHT, _LEFT, _TOP, _BELOW = 460.0, 170.0, 52.0, 22.0, 40.0
_LEAST_MM = 0.01  # What the drawing shows as nothing.

tag = markup.tag


def draw(run: archive.Run) -> markup.Markup | None:
  """A table and a spectrum for each vehicle; None where all stay in place."""
  scene = run.scenario
  if not _wanders(scene):
    return None
  rows, drawings = [], []
  for name in run.positions_m:
    asked, windows = _asked(scene, name), _windows(run, name)
    if not len(windows):
      rows.append([name, 'never long enough at its place'])
      continue
    found = _measured(windows, run)
    if max(each['rms'] for each in found.values()) < _LEAST_MM:
      continue  # It was told to stay, and did.
    for axis, each in found.items():
      rows.append([f'{name}, {axis}', f'{len(windows)} windows', *_cells(each)])
      if axis in asked:
        rows.append(['', 'asked for', *_cells(asked[axis])])
    drawings.append(_drawing(name, found, asked))
  bands = [f'{band} Hz' for band in hover_measure.BANDS]
  header = 'vehicle, axis', 'from', 'rms mm', 'mm/s', *bands
  return tag(
    'section',
    tag('h2', 'Hover'),
    tag(
      'p',
      f'Medians of windows of {hover_measure.WINDOW_S:g} s, each less its mean,'
      ' in which a vehicle was to stay where it was. Broad and pale lines are'
      " what its preset's source says, where it has bands.",
      class_='faint',
    ),
    markup.table(header, rows),
    tag('div', *drawings, class_='pair'),
    id='hover',
  )


def _wanders(scene: Mapping[str, Any]) -> bool:
  """Whether anything takes vehicles from their places."""
  drift = scene['drift']
  hovers = {drift['performer_hover'], drift['observer_hover']} != {'none'}
  return hovers or scene['estimator'] != 'none' or scene['air']['gusts']


def _asked(
  scene: Mapping[str, Any], name: str
) -> Mapping[str, hover_presets.Figures]:
  """What a preset's source says of a vehicle's hover, by axis."""
  drift, times = scene['drift'], 1.0
  preset = drift[f'{"performer" if name == "performer" else "observer"}_hover']
  if preset != 'none':
    times = drift['hover_amplitude']
  else:
    preset = scene['estimator']
  if preset not in hover_presets.PRESETS:
    return {}
  published = hover_presets.PRESETS[preset].published
  return {
    axis: {what: times * figure for what, figure in figures.items()}
    for axis, figures in published.items()
    if axis in _AXES
  }


def _windows(run: archive.Run, name: str) -> np.ndarray:
  """(N, T, 3) mm: where it was while it was to stay at its place."""
  size = hover_measure.frames(_rate_hz(run))
  way_mm, windows = 1000 * run.positions_m[name], []
  for begin_s, end_s in _rests(run, name):
    begin, end = np.searchsorted(run.times_s, [begin_s - 1e-6, end_s + 1e-6])
    windows += [
      way_mm[first : first + size]
      for first in range(begin, end - size + 1, size)
    ]
  return np.array(windows).reshape(-1, size, 3)


def _rests(run: archive.Run, name: str) -> Iterator[tuple[float, float]]:
  """From when to when a vehicle was to stay, once its hover has grown."""
  begin_s = hover.GROWTH_S
  if name == 'performer':
    for each in run.sent:
      yield begin_s, each.begin_s
      begin_s = each.end_s
  elif (begun_s := flights.begun_s(run, name)) is not None:
    yield begin_s, begun_s
    return
  yield begin_s, run.end_s


def _rate_hz(run: archive.Run) -> float:
  return run.config.agreement.rate_hz


def _measured(
  windows: np.ndarray, run: archive.Run
) -> Mapping[str, hover_presets.Figures]:
  rate_hz = _rate_hz(run)
  speeds = np.gradient(windows, 1 / rate_hz, axis=1)
  return hover_measure.of_windows(_AXES, windows, speeds, rate_hz)


def _cells(figures: hover_presets.Figures) -> list[str]:
  quantities = 'rms', 'speed', *hover_measure.BANDS
  return [
    f'{figures[each]:.2f}' if each in figures else '\u2013'
    for each in quantities
  ]


def _drawing(
  name: str,
  found: Mapping[str, hover_presets.Figures],
  asked: Mapping[str, hover_presets.Figures],
) -> markup.Markup:
  """Root mean squares by band, as steps; broad and pale what was asked for."""
  edges_hz = np.array(hover_measure.EDGES_HZ)
  bottom = _TOP + _HEIGHT
  across = plot.Scale(edges_hz[0], edges_hz[-1], _LEFT, _WIDTH - 12, True)
  most_mm = max(
    figures.get(band, 0.0)
    for each in (found, asked)
    for figures in each.values()
    for band in hover_measure.BANDS
  )
  top_mm = 10.0 ** np.ceil(np.log10(max(most_mm, 10 * _LEAST_MM)))
  up = plot.Scale(_LEAST_MM, top_mm, bottom, _TOP, True)
  out = [plot.text(0, 12, f'{name}: rms of each band, mm', class_='name')]
  for value in up.ticks():
    y = float(up(value))
    out.append(tag('line', x1=_LEFT, x2=_WIDTH - 12, y1=y, y2=y, class_='grid'))
    out.append(plot.text(_LEFT - 6, y + 4, f'{value:g}', class_='tick end'))
  for value in edges_hz:
    x = float(across(value))
    out.append(tag('line', x1=x, x2=x, y1=_TOP, y2=bottom, class_='grid'))
    out.append(plot.text(x, bottom + 15, f'{value:g}', class_='tick middle'))
  out.append(plot.text(_WIDTH - 12, bottom + 32, 'Hz', class_='tick end'))
  for figures, kind in ((asked, 'line asked'), (found, 'line')):
    for look, axis in zip(_LOOKS, _AXES, strict=True):
      bands = figures.get(axis, {})
      if hover_measure.BANDS[0] in bands:
        rms_mm = np.array([bands[band] for band in hover_measure.BANDS])
        along = np.repeat(across(edges_hz), 2)[1:-1]
        steps = np.repeat(up(rms_mm), 2)
        out.append(plot.path(along, steps, class_=f'{kind} {look}'))
  for number, (look, axis) in enumerate(zip(_LOOKS, _AXES, strict=True)):
    x = _WIDTH - 150 + 46 * number
    out.append(tag('line', x1=x, x2=x + 18, y1=8, y2=8, class_=f'line {look}'))
    out.append(plot.text(x + 22, 12, axis, class_='tick'))
  return tag(
    'svg', *out, viewBox=f'0 0 {_WIDTH:g} {bottom + _BELOW:g}', role='img',
    style=f'max-width: {_WIDTH:g}px', aria_label=f'hover of {name} by band',
  )  # fmt: skip
