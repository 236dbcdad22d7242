"""Plots as inline SVG: scales with ticks, lines, limits and labels."""

from collections.abc import Sequence
import dataclasses
import math
from typing import Any, NamedTuple, overload

import numpy as np

from waggle_tasks.experiments.pages import markup

# Everything over time shares these columns, in units of the SVG.
WIDTH, LEFT, RIGHT = 1120, 112, 20


@dataclasses.dataclass(frozen=True)
class Scale:
  """Maps values to coordinates.

  Attributes:
    low: The value at `begin`.
    high: The value at `end`.
    begin: A coordinate.
    end: Another.
    logarithmic: Whether equal ratios are equally far apart.
  """

  low: float
  high: float
  begin: float
  end: float
  logarithmic: bool = False

  @overload
  def __call__(self, values: float) -> float: ...

  @overload
  def __call__(self, values: np.ndarray) -> np.ndarray: ...

  def __call__(self, values: Any) -> Any:
    """Coordinates of values, which are clipped to the scale."""
    values = np.clip(values, self.low, self.high)
    low, high = self.low, self.high
    if self.logarithmic:
      values, low, high = np.log(values), math.log(low), math.log(high)
    share = (values - low) / (high - low)
    return self.begin + share * (self.end - self.begin)

  def ticks(self, apart: float = 70.0) -> list[float]:
    """Round values along the scale, about so many coordinates apart."""
    if self.logarithmic:
      first = math.ceil(math.log10(self.low) - 1e-9)
      last = math.floor(math.log10(self.high) + 1e-9)
      return [10.0**power for power in range(first, last + 1)]
    length = abs(self.end - self.begin)
    rough = (self.high - self.low) / max(length / apart, 2)
    unit = 10 ** math.floor(math.log10(rough))
    step = next(s * unit for s in (1, 2, 5, 10) if s * unit >= rough * 0.999)
    first = math.ceil(self.low / step - 1e-9)
    last = math.floor(self.high / step + 1e-9)
    return [round(k * step, 10) for k in range(first, last + 1)]


def time_scale(end_s: float) -> Scale:
  """The scale that everything over time shares."""
  return Scale(0.0, end_s, LEFT, WIDTH - RIGHT)


class Curve(NamedTuple):
  """A curve of a panel: its values, its look, and its name in the legend."""

  values: np.ndarray
  look: str
  name: str = ''


class Limits(NamedTuple):
  """Horizontal lines of a panel and what they say."""

  values: Sequence[float]
  name: str


def text(
  x: float, y: float, *content: markup.Content, **attributes: markup.Content
) -> markup.Markup:
  """An SVG text."""
  return markup.tag('text', *content, x=float(x), y=float(y), **attributes)


def path(
  x: np.ndarray, y: np.ndarray, **attributes: markup.Content
) -> markup.Markup:
  """A polyline through (K,) points, rounded and without those that repeat."""
  points = np.column_stack([x, y]).round(1)  # (K, 2)
  moved = (np.diff(points, axis=0) != 0).any(axis=1)
  points = points[np.concatenate([[True], moved])]
  line = ' '.join(f'{a:g},{b:g}' for a, b in points)
  return markup.tag('polyline', points=line, **attributes)


def curve(
  x: np.ndarray, y: np.ndarray, **attributes: markup.Content
) -> markup.Markup:
  """A polyline over time, (K,) points, without those inside level stretches."""
  level = np.diff(np.round(y, 1)) == 0
  inside = np.concatenate([[False], level[1:] & level[:-1], [False]])
  kept = ~inside if len(x) > 2 else slice(None)
  return path(x[kept], y[kept], **attributes)


def pieces(valid: np.ndarray) -> list[slice]:
  """The runs of True in a mask (K,)."""
  edges = np.flatnonzero(np.diff(np.concatenate([[0], valid, [0]])))
  return [slice(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def time_axis(scale: Scale, top: float, bottom: float) -> markup.Markup:
  """Vertical grid lines with times below them."""
  out = []
  for tick in scale.ticks():
    x = float(scale(tick))
    out.append(markup.tag('line', x1=x, x2=x, y1=top, y2=bottom, class_='grid'))
    out.append(text(x, bottom + 14, f'{tick:g}', class_='tick middle'))
  out.append(text(scale.end, bottom + 28, 'simulation time, s', class_='end'))
  return markup.join(out)


def timed(
  height: float, end_s: float, *content: markup.Content, label: str
) -> markup.Markup:
  """An SVG over time with the cursor that the page's script moves.

  Args:
    height: In the units of its width, `WIDTH`.
    end_s: Where its time axis ends.
    *content: What is in it.
    label: What it shows, for those who cannot see it.
  """
  cursor = markup.tag(
    'line', x1=LEFT, x2=LEFT, y1=0, y2=height, class_='cursor'
  )
  return markup.tag(
    'svg', *content, cursor,
    viewBox=f'0 0 {WIDTH} {height:g}', class_='timed', role='img',
    aria_label=label, data_end=f'{end_s:g}', data_left=LEFT,
    data_width=WIDTH - LEFT - RIGHT,
  )  # fmt: skip


def panel(
  title: str,
  unit: str,
  times_s: np.ndarray,
  lines: Sequence[Curve],
  scale: Scale,
  end_s: float,
  limits: Limits | None = None,
  last: bool = False,
) -> markup.Markup:
  """A plot over time: one panel of several that stand below one another.

  Args:
    title: What is plotted.
    unit: Its unit.
    times_s: (K,) times of all lines.
    lines: What is plotted, (K,) values each; NaN leaves a gap.
    scale: The vertical one; its `begin` is the bottom.
    end_s: Where the time axis ends.
    limits: Horizontal lines.
    last: Whether the time axis has its numbers.
  """
  across = time_scale(end_s)
  out = [
    text(0, scale.end + 10, title, class_='name'),
    text(0, scale.end + 25, unit, class_='tick'),
  ]
  for tick in scale.ticks():
    y = float(scale(tick))
    out.append(
      markup.tag('line', x1=LEFT, x2=WIDTH - RIGHT, y1=y, y2=y, class_='grid')
    )
    out.append(text(LEFT - 6, y + 4, f'{tick:g}', class_='tick end'))
  for value in limits.values if limits else ():
    y = float(scale(value))
    out.append(
      markup.tag('line', x1=LEFT, x2=WIDTH - RIGHT, y1=y, y2=y, class_='limit')
    )
  if limits:
    name = f'dashed: {limits.name}'
    out.append(text(WIDTH - RIGHT, scale.end - 5, name, class_='tick end'))
  for number, line in enumerate(lines):
    for part in pieces(np.isfinite(line.values)):
      along, up = across(times_s[part]), scale(line.values[part])
      out.append(curve(along, up, class_=f'line {line.look}'))
    if line.name:
      x = LEFT + 8 + 90 * number
      key = markup.tag(
        'line', x1=x, x2=x + 22, y1=scale.end - 9, y2=scale.end - 9,
        class_=f'line {line.look}',
      )  # fmt: skip
      out += [key, text(x + 27, scale.end - 5, line.name, class_='tick')]
  height = scale.begin + (32 if last else 6)
  grid = time_axis(across, scale.end, scale.begin) if last else None
  return timed(height, end_s, grid, *out, label=f'{title}, {unit}, over time')
