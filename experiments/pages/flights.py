"""Where everybody flew: from above, in numbers, and how near to each other."""

import itertools

import numpy as np

from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments import archive
from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.tasks import safety

_SIDE = 460.0
_MARGIN_M = 0.25
_PAIRS = 10  # The nearest ones; many observers have many pairs.


def commanded(
  run: archive.Run, name: str
) -> tuple[np.ndarray, np.ndarray] | None:
  """Where an observer took its command, and where that leads, (3,) each."""
  for event in run.events[name]:
    if (
      isinstance(event, observer_agent.Navigation)
      and event.deed is observer_agent.Deed.START
    ):
      frame = int(np.abs(run.times_s - event.time_s).argmin())
      begin_m = run.positions_m[name][frame]
      return begin_m, np.array(event.target_m)
  return None


def displacements(run: archive.Run) -> markup.Markup:
  """Commanded and flown displacement of each observer."""
  rows = []
  for name in run.events:
    command = commanded(run, name)
    way_m = run.positions_m[name]
    if command is None:
      strayed_m = np.linalg.norm(way_m - way_m[0], axis=1).max()
      flown = f'stayed within {strayed_m * 1e3:.1f} mm'
      rows.append([name, '\u2013', flown, '\u2013'])
      continue
    begin_m, target_m = command
    error_m = np.linalg.norm(way_m[-1] - target_m)
    rows.append(
      [
        name,
        _vector(target_m - begin_m),
        _vector(way_m[-1] - begin_m),
        f'{error_m * 1e3:.2f}',
      ]
    )
  return markup.table(
    ('observer', 'commanded x, y, z, m', 'flown x, y, z, m', 'apart, mm'), rows
  )


def _vector(way_m: np.ndarray) -> str:
  way_m = np.round(way_m, 3) + 0.0  # No negative zeros.
  return ', '.join(f'{value:.3f}' for value in way_m)


def distances(run: archive.Run) -> markup.Markup:
  """The smallest distance of each pair of vehicles, the nearest pairs first."""
  pairs = []
  for a, b in itertools.combinations(run.positions_m, 2):
    apart_m = np.linalg.norm(run.positions_m[a] - run.positions_m[b], axis=1)
    frame = int(apart_m.argmin())
    pairs.append((float(apart_m[frame]), run.times_s[frame], f'{a}, {b}'))
  pairs.sort()
  rows = [
    [pair, f'{apart_m:.3f}', f'{time_s:.2f}']
    for apart_m, time_s, pair in pairs[:_PAIRS]
  ]
  left_out = len(pairs) - len(rows)
  note = f'; {left_out} pairs that stayed further apart left out'
  return markup.table(
    ('vehicles', 'smallest distance, m', 'at, s'),
    rows,
    f'A flight that would pass under {safety.MINIMUM_SPACING_M:g} m is refused'
    + (note if left_out else '')
    + '.',
  )


def plan(run: archive.Run) -> markup.Markup:
  """The room from above: starts, commands and ways flown."""
  ways_m = {name: way[:, :2] for name, way in run.positions_m.items()}
  goals = {name: commanded(run, name) for name in run.events}
  spots = list(ways_m.values())
  spots += [goal[1][None, :2] for goal in goals.values() if goal]
  spots = np.concatenate(spots)
  low, high = spots.min(axis=0) - _MARGIN_M, spots.max(axis=0) + _MARGIN_M
  zoom = _SIDE / (high - low).max()
  width, height = (high - low) * zoom
  x = plot.Scale(low[0], high[0], 50.0, 50.0 + width)
  y = plot.Scale(low[1], high[1], 12.0 + height, 12.0)
  out = [_axes(x, y)]
  for name, way_m in ways_m.items():
    out.append(plot.path(x(way_m[:, 0]), y(way_m[:, 1]), class_='line a'))
    begin_x, begin_y = float(x(way_m[0, 0])), float(y(way_m[0, 1]))
    shape = _mark(begin_x, begin_y, name == 'performer')
    goal = goals.get(name)
    if goal is not None:
      out.append(_goal(float(x(goal[1][0])), float(y(goal[1][1]))))
    label = name.removeprefix('observer_')
    out += [shape, plot.text(begin_x + 9, begin_y + 14, label, class_='tick')]
  return markup.tag(
    'svg', *out, viewBox=f'0 0 {width + 70:.0f} {height + 92:.0f}',
    role='img', class_='plan', aria_label='the room from above',
    style=f'max-width:{width + 70:.0f}px',
  )  # fmt: skip


def _mark(x: float, y: float, performer: bool) -> markup.Markup:
  if performer:
    outline = f'M{x:.1f} {y - 7:.1f}l7 12h-14z'
    return markup.tag('path', d=outline, class_='performer')
  return markup.tag('circle', cx=x, cy=y, r=5, class_='start')


def _goal(x: float, y: float) -> markup.Markup:
  cross = f'M{x - 6:.1f} {y - 6:.1f}l12 12m0 -12l-12 12'
  return markup.tag('path', d=cross, class_='goal')


def _axes(x: plot.Scale, y: plot.Scale) -> markup.Markup:
  out = []
  for tick in x.ticks():
    at = float(x(tick))
    out.append(
      markup.tag('line', x1=at, x2=at, y1=y.end, y2=y.begin, class_='grid')
    )
    out.append(plot.text(at, y.begin + 14, f'{tick:g}', class_='tick middle'))
  for tick in y.ticks():
    at = float(y(tick))
    out.append(
      markup.tag('line', x1=x.begin, x2=x.end, y1=at, y2=at, class_='grid')
    )
    out.append(plot.text(x.begin - 6, at + 4, f'{tick:g}', class_='tick end'))
  out.append(plot.text(x.end, y.begin + 30, 'world x, m', class_='tick end'))
  out.append(plot.text(4, y.end + 2, 'y, m', class_='tick'))
  row = y.begin + 58
  out += [
    _mark(x.begin, row - 4, True),
    plot.text(x.begin + 12, row, 'performer', class_='tick'),
    _mark(x.begin + 90, row - 4, False),
    plot.text(x.begin + 100, row, 'start', class_='tick'),
    _goal(x.begin + 156, row - 4),
    plot.text(x.begin + 168, row, 'commanded', class_='tick'),
    markup.tag(
      'line', x1=x.begin + 250, x2=x.begin + 272, y1=row - 4, y2=row - 4,
      class_='line a',
    ),
    plot.text(x.begin + 277, row, 'flown', class_='tick'),
  ]  # fmt: skip
  return markup.join(out)
