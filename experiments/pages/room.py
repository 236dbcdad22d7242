"""Where everybody flew as drawings: from above, and as seen from the front.

The dance is vertical, so that only the front shows it. A script marks in both
where everyone is at a moment, and zooms.
"""

import json

import numpy as np

from waggle_tasks.experiments.pages import flights, markup, plot
from waggle_tasks.experiments.record import archive
from waggle_tasks.experiments.results import palette

_SIDE = 460.0
_STEP_SIDE = 130.0  # Of the drawing of one gesture.
_MARGIN_M = 0.25
_EVERY_S = 0.2  # Between the moments that the script knows.
_AXES = ('world x, m', 'y, m', 'height, m')

Moment = list[float]  # Time in s, then x, y and z in m.


def ways(run: archive.Run) -> dict[str, list[Moment]]:
  """Where each vehicle was, to the millimetre, whenever that changed."""
  out: dict[str, list[Moment]] = {}
  every = max(run.config.agreement.frames(_EVERY_S), 1)
  for name, way_m in run.positions_m.items():
    moments: list[Moment] = []
    for frame in range(0, len(way_m), every):
      place = [round(float(each), 3) for each in way_m[frame]]
      if not moments or moments[-1][1:] != place:
        moments.append([round(float(run.times_s[frame]), 3), *place])
    out[name] = moments
  return out


def plan(run: archive.Run) -> markup.Markup:
  """The room from above: starts, commands and ways flown."""
  return _zoomed(_drawing(run, (0, 1), 'the room from above'), 'From above')


def front(run: archive.Run) -> markup.Markup:
  """The same as seen from the front, where the dance can be read."""
  return _zoomed(
    _drawing(run, (0, 2), 'the room from the front'), 'From the front'
  )


def _zoomed(drawing: markup.Markup, title: str) -> markup.Markup:
  """A drawing with buttons that the script gives a meaning."""
  buttons = [
    markup.tag('button', sign, type='button', data_zoom=factor, aria_label=hint)
    for sign, factor, hint in (
      ('+', 2, 'nearer'), ('\u2212', 0.5, 'further'), ('whole', 0, 'whole'),
    )
  ]  # fmt: skip
  bar = markup.tag(
    'span', *buttons, ' ', markup.tag('output'), class_='zooms', hidden=True
  )
  caption = markup.tag('figcaption', markup.tag('b', title), bar)
  return markup.tag('figure', caption, drawing)


def _drawing(
  run: archive.Run, axes: tuple[int, int], label: str
) -> markup.Markup:
  ways_m = {name: way[:, axes] for name, way in run.positions_m.items()}
  commands = {name: flights.commanded(run, name) for name in run.events}
  goals_m = {
    name: command[1][list(axes)]
    for name, command in commands.items()
    if command is not None
  }
  spots = [*ways_m.values(), *(goal[None] for goal in goals_m.values())]
  x, y = _scales(np.concatenate(spots), _SIDE, _MARGIN_M)
  width, height = x.end - x.begin, y.begin - y.end
  return markup.tag(
    'svg', _axes(x, y, axes),
    *(plot.path(x(w[:, 0]), y(w[:, 1]), class_='line a faded')
      for w in ways_m.values()),
    *(markup.tag('polyline', class_='line trail', data_name=name)
      for name in ways_m),
    *(_start(x(way[0, 0]), y(way[0, 1]), name) for name, way in ways_m.items()),
    *(_at(x(goal[0]), y(goal[1]), _GOAL) for goal in goals_m.values()),
    *(_at(x.begin, y.begin, _HERE, data_name=name, visibility='hidden')
      for name in ways_m),
    viewBox=f'0 0 {width + 70:.0f} {height + 106:.0f}', role='img',
    class_='plan', aria_label=label,
    data_maps=json.dumps([_map(axes[0], x), _map(axes[1], y)]),
    style=f'max-width:{width + 70:.0f}px',
  )  # fmt: skip


def _map(axis: int, scale: plot.Scale) -> list[float]:
  """By what the script puts places on a drawing.

  An axis, a value at it, the coordinate of that, and units for each metre.
  """
  unit = (scale.end - scale.begin) / (scale.high - scale.low)
  return [axis, scale.low, scale.begin, unit]


def _start(x: float, y: float, name: str) -> markup.Markup:
  """Where a vehicle starts, and its name."""
  if name != 'performer':
    number = name.removeprefix('observer_')
    return _at(x, y, _mark(False), plot.text(9, 14, number, class_='tick'))
  # It stands behind an observer when it is seen from the front.
  return _at(x, y, _mark(True), plot.text(-9, -9, name, class_='tick end'))


def _scales(
  spots: np.ndarray, side: float, margin_m: float
) -> tuple[plot.Scale, plot.Scale]:
  """Scales that show (K, 2) places, a metre as long on one as on the other."""
  low, high = spots.min(axis=0) - margin_m, spots.max(axis=0) + margin_m
  width, height = (high - low) * side / (high - low).max()
  x = plot.Scale(low[0], high[0], 50.0, 50.0 + width)
  return x, plot.Scale(low[1], high[1], 12.0 + height, 12.0)


def _at(
  x: float, y: float, *marks: markup.Content, **attributes: markup.Content
) -> markup.Markup:
  """Marks around a place, which keep their size however near one looks."""
  inner = markup.tag('g', *marks, class_='mark')
  place = f'translate({x:.1f} {y:.1f})'
  return markup.tag('g', inner, transform=place, **attributes)


def _mark(performer: bool) -> markup.Markup:
  if performer:
    return markup.tag('path', d='M0 -7l7 12h-14z', class_='performer')
  return markup.tag('circle', r=5, class_='start')


_GOAL = markup.tag('path', d='M-6 -6l12 12m0 -12l-12 12', class_='goal')
_HERE = markup.tag('circle', r=4, class_='here')


def _axes(x: plot.Scale, y: plot.Scale, axes: tuple[int, int]) -> markup.Markup:
  out = [_grid(x, y)]
  out.append(plot.text(x.end, y.begin + 30, _AXES[axes[0]], class_='tick end'))
  out.append(plot.text(4, y.end - 2, _AXES[axes[1]], class_='tick'))
  stroke = markup.tag('line', x1=-14, x2=8, y1=0, y2=0, class_='line a faded')
  keys = (
    ('performer', _mark(True)), ('start', _mark(False)),
    ('commanded', _GOAL), ('flown', stroke),
  )  # fmt: skip
  for number, (name, mark) in enumerate(keys):
    # Two and two, which also fits below a narrow room.
    left, row = x.begin + number % 2 * 96, y.begin + 54 + number // 2 * 18
    place = f'translate({left:g} {row - 4:g})'
    out.append(markup.tag('g', mark, transform=place))
    out.append(plot.text(left + 12, row, name, class_='tick'))
  return markup.join(out)


def _grid(x: plot.Scale, y: plot.Scale, apart: float = 70.0) -> markup.Markup:
  out = []
  for tick in x.ticks(apart):
    at = float(x(tick))
    out.append(
      markup.tag('line', x1=at, x2=at, y1=y.end, y2=y.begin, class_='grid')
    )
    out.append(plot.text(at, y.begin + 14, f'{tick:g}', class_='tick middle'))
  for tick in y.ticks(apart):
    at = float(y(tick))
    out.append(
      markup.tag('line', x1=x.begin, x2=x.end, y1=at, y2=at, class_='grid')
    )
    out.append(plot.text(x.begin - 6, at + 4, f'{tick:g}', class_='tick end'))
  return markup.join(out)


def dance(run: archive.Run) -> markup.Markup | None:
  """Each gesture by itself, in the order in which they were flown.

  Returns:
    As many figures as there are gestures, from the front and all of one scale;
    None when nothing was sent.
  """
  way_m = run.positions_m['performer'][:, (0, 2)]  # (T, 2)
  parts = [
    way_m[(run.times_s >= sent.begin_s) & (run.times_s <= sent.end_s)]
    for sent in run.sent
  ]
  parts = [part for part in parts if len(part)]
  if not parts:
    return None
  x, y = _scales(np.concatenate(parts), _STEP_SIDE, 0.05)
  size = f'0 0 {x.end + 12:.0f} {y.begin + 22:.0f}'
  figures = []
  for number, (sent, part) in enumerate(zip(run.sent, parts, strict=False), 1):
    colour = palette.SYMBOLS[sent.symbol]
    chip = markup.tag(
      'span', sent.mark.label, class_='symbol',
      style=f'background:{colour};color:{palette.ink(colour)}',
    )  # fmt: skip
    drawing = markup.tag(
      'svg', _grid(x, y, 45.0),
      plot.path(x(part[:, 0]), y(part[:, 1]), class_='line track'),
      viewBox=size, role='img', aria_label=f'gesture {number} from the front',
    )  # fmt: skip
    when = f'{number}: {sent.begin_s:.1f}\u2013{sent.end_s:.1f} s '
    figures.append(
      markup.tag('figure', markup.tag('figcaption', when, chip), drawing)
    )
  return markup.tag('div', *figures, class_='steps')
