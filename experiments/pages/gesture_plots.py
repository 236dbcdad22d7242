"""Each motion beside the templates it was compared with, and its scores."""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import description, receiver, views
from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.experiments.results import palette
from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import MOTIONS, Symbol

_SIDE = 150.0
_EDGE = (30.0, 8.0)  # Around the plot: left and below, right and above.


def draw(
  events: Sequence[receiver.Event],
  trace: traces_lib.Trace | None,
  told: description.Description,
) -> markup.Markup:
  """One figure for each motion.

  Args:
    events: The motions that one observer recognised, or did not.
    trace: What it saw, when that was kept.
    told: What it was compared with, and what scores are held against.
  """
  motions = {m.confirmed_s: m for m in trace.motions} if trace else {}
  templates = told.templates() if told.templates else None
  figures = [
    _figure(number, event, motions.get(event.time_s), templates, told)
    for number, event in enumerate(events, 1)
  ]
  return markup.tag('div', *figures, class_='gestures')


def _figure(
  number: int,
  event: receiver.Event,
  motion: traces_lib.TracedMotion | None,
  templates: views.Templates | None,
  told: description.Description,
) -> markup.Markup:
  unknown = event.symbol is Symbol.UNKNOWN
  colour = palette.SYMBOLS[event.symbol]
  chip = markup.tag(
    'span',
    str(event.symbol),
    class_='symbol',
    style=f'background:{colour};color:{palette.ink(colour)}',
  )
  caption = markup.tag(
    'figcaption', f'motion {number}, {event.time_s:.2f} s ', chip
  )
  reason = None
  if unknown and event.recognition is not None:
    reason = markup.tag('p', event.recognition.reason, class_='reason')
  if event.rejection:
    said = markup.tag('p', f'frame: {event.rejection}', class_='reason')
    reason = markup.join([reason, said])
  return markup.tag(
    'figure', caption, _plot(event, motion, templates),
    _scores(event, motion, told.recognition), reason,
    class_='unknown' if unknown else None,
  )  # fmt: skip


def _plot(
  event: receiver.Event,
  motion: traces_lib.TracedMotion | None,
  templates: views.Templates | None,
) -> markup.Markup:
  """The normalised track, over the best and the second template if any."""
  path_px = motion.path_px if motion else np.empty((0, 2))
  if len(path_px) < 2 or not np.ptp(path_px, axis=0).any():
    return markup.tag('p', 'no track', class_='blank')
  track = gestures.normalise(path_px)
  curves, hint = [(track, 'track', 'track')], 'track of the motion'
  if templates is not None:
    errors = templates.errors(track)  # (4, V)
    best, second = np.argsort(errors.min(axis=1), kind='stable')[:2]
    nearest = templates.paths[np.arange(len(errors)), errors.argmin(axis=1)]
    curves = [
      (nearest[best], 'best', f'best: {MOTIONS[best]}'),
      (nearest[second], 'second', f'second: {MOTIONS[second]}'),
      *curves,
    ]
    hint += f' over {MOTIONS[best]} and {MOTIONS[second]}'
  points = np.concatenate([curve for curve, _, _ in curves])
  middle = (points.min(axis=0) + points.max(axis=0)) / 2
  half = 0.54 * np.ptp(points, axis=0).max()
  left, rest = _EDGE
  x = plot.Scale(middle[0] - half, middle[0] + half, left, left + _SIDE)
  y = plot.Scale(middle[1] - half, middle[1] + half, rest, rest + _SIDE)
  out = [_axes(x, y)]
  for number, (curve, look, name) in enumerate(curves):
    out.append(plot.path(x(curve[:, 0]), y(curve[:, 1]), class_=f'line {look}'))
    row = rest + _SIDE + 30 + 14 * number
    out.append(
      markup.tag(
        'line', x1=left, x2=left + 22, y1=row - 4, y2=row - 4,
        class_=f'line {look}',
      )
    )  # fmt: skip
    out.append(plot.text(left + 27, row, name, class_='tick'))
  width, height = left + _SIDE + rest, rest + _SIDE + 64
  return markup.tag(
    'svg', *out, viewBox=f'0 0 {width:g} {height:g}', role='img',
    aria_label=hint,
  )  # fmt: skip


def _axes(x: plot.Scale, y: plot.Scale) -> markup.Markup:
  """A frame with ticks in spans; image rows grow downwards."""
  out = [
    markup.tag(
      'rect', x=x.begin, y=y.begin, width=_SIDE, height=_SIDE, class_='frame'
    )
  ]
  for tick in x.ticks(40):
    at = float(x(tick))
    out.append(
      markup.tag('line', x1=at, x2=at, y1=y.begin, y2=y.end, class_='grid')
    )
    out.append(plot.text(at, y.end + 12, f'{tick:g}', class_='tick middle'))
  for tick in y.ticks(40):
    at = float(y(tick))
    out.append(
      markup.tag('line', x1=x.begin, x2=x.end, y1=at, y2=at, class_='grid')
    )
    out.append(
      plot.text(x.begin - 4, at + 4, f'{0.0 - tick:g}', class_='tick end')
    )
  out.append(plot.text(x.end, y.end + 26, 'spans', class_='tick end'))
  return markup.join(out)


def _scores(
  event: receiver.Event,
  motion: traces_lib.TracedMotion | None,
  limits: config_lib.RecognitionLimits | None,
) -> markup.Markup | None:
  """Every score with its limit and whether it keeps it, where that is told."""
  scores = event.recognition
  if scores is None or limits is None:
    return None
  rows = []
  if motion is not None:  # It alone tells whether the width is known.
    span_px, least_px = scores.span_px, limits.least_span_px(motion.width_px)
    limit = f'\u2265 {least_px:.3g}'
    if motion.width_px is not None:
      limit += f' ({limits.min_span_widths:g} widths)'
    rows = [('span, px', f'{span_px:.1f}', limit, span_px >= least_px)]
  if scores.best is not Symbol.UNKNOWN:  # Only then it was compared.
    rmse, margin, closure = scores.rmse, scores.margin, scores.closure
    least, most, open_ = limits.min_margin, limits.max_rmse, limits.max_closure
    rows = [
      ('RMSE', f'{rmse:.3f}', f'< {most:g}', rmse < most),
      ('margin', f'{margin:.3f}', f'> {least:g}', margin > least),
      ('closure', f'{closure:.3f}', f'< {open_:g}', closure < open_),
      *rows,
    ]
  cells = [
    markup.tag(
      'tr',
      markup.tag('th', name, scope='row'),
      markup.tag('td', value),
      markup.tag('td', limit, class_='faint'),
      markup.tag('td', '\u2713' if kept else '\u2717'),
      class_=None if kept else 'broken',
    )
    for name, value, limit, kept in rows
  ]
  return markup.tag('table', markup.tag('tbody', *cells), class_='scores')
