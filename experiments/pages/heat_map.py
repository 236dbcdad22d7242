"""A map of an envelope as inline SVG: a cell for each pair of values."""

from collections.abc import Sequence

from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.results import envelope, heat, palette

_CELL, _HEIGHT = 58, 30  # Units of the SVG.
_LEFT, _TOP, _BELOW = 92, 8, 46


def draw(panel: envelope.Panel) -> markup.Markup:
  """A map with its axes; each cell says how many of how many were right."""
  width = _LEFT + _CELL * max(len(panel.acrosses), 3) + 10
  bottom = _TOP + _HEIGHT * len(panel.downs)
  out = []
  for i, down in enumerate(panel.downs):
    y = _TOP + _HEIGHT * i
    out.append(
      plot.text(_LEFT - 8, y + 20, heat.label(down), class_='tick end')
    )
    for j, across in enumerate(panel.acrosses):
      rows = panel.cells.get((down, across))
      out += _cell(_LEFT + _CELL * j, y, rows) if rows else []
  for j, across in enumerate(panel.acrosses):
    x = _LEFT + _CELL * (j + 0.5)
    out.append(
      plot.text(x, bottom + 16, heat.label(across), class_='tick middle')
    )
  middle = (_TOP + bottom) / 2
  out += [
    plot.text(
      _LEFT + _CELL * len(panel.acrosses) / 2, bottom + 36,
      heat.axis(panel.across), class_='name middle',
    ),
    plot.text(
      18, middle, heat.axis(panel.down), class_='name middle',
      transform=f'rotate(-90 18 {middle:g})',
    ),
  ]  # fmt: skip
  return markup.tag(
    'svg', *out, viewBox=f'0 0 {width} {bottom + _BELOW}', role='img',
    style=f'max-width: {width}px',
    aria_label=f'share of exposures that were right, {heat.title(panel)}',
  )  # fmt: skip


def _cell(
  x: float, y: float, rows: Sequence[envelope.Row]
) -> list[markup.Markup]:
  share, words = heat.share(rows)
  fill = heat.colour(share)
  return [
    markup.tag(
      'rect', x=x, y=y, width=_CELL, height=_HEIGHT, fill=fill, stroke='#fff'
    ),
    plot.text(
      x + _CELL / 2, y + 20, words, class_='in', fill=palette.ink(fill)
    ),
  ]
