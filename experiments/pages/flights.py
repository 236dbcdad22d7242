"""Where everybody flew in numbers, and how near to each other."""

import itertools
from typing import Any

import numpy as np

from waggle_tasks import plain
from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments.pages import markup
from waggle_tasks.experiments.record import archive
from waggle_tasks.tasks import drift, estimators, safety

_PAIRS = 10  # The nearest ones; many observers have many pairs.


def commanded(
  run: archive.Run, name: str
) -> tuple[np.ndarray, np.ndarray] | None:
  """Where an observer took its command, and where that leads, (3,) each."""
  event = _start(run, name)
  if event is None:
    return None
  frame = int(np.abs(run.times_s - event.time_s).argmin())
  begin_m = run.positions_m[name][frame]
  target_m = np.array(event.target_m)
  if run.scenario['safety'] == 'avoid':
    target_m = safety.settled_m(
      target_m,
      run.positions_m[name][0],
      [run.positions_m['performer'][0]],
      _kept_m(run.scenario),
    )
  return begin_m, target_m


def begun_s(run: archive.Run, name: str) -> float | None:
  """When an observer took its command; None if it never did."""
  event = _start(run, name)
  return None if event is None else event.time_s


def _start(run: archive.Run, name: str) -> observer_agent.Navigation | None:
  for event in run.events[name]:
    if (
      isinstance(event, observer_agent.Navigation)
      and event.deed is observer_agent.Deed.START
    ):
      return event
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


def _kept_m(scene: dict[str, Any]) -> float:
  """How far apart vehicles of a scenario are kept, of its plain data."""
  wander = plain.from_plain(drift.Drift, scene['drift'], 'drift')
  return safety.kept_m(wander.near_m + estimators.near_m(scene['estimator']))


def _rule(run: archive.Run) -> str:
  """What is done about vehicles that would meet."""
  least_m = safety.MINIMUM_SPACING_M
  if run.scenario['safety'] == 'avoid':
    return f'Vehicles avoid each other, to stay {least_m:g} m apart'
  return f'A flight that would pass under {least_m:g} m is refused'


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
    _rule(run) + (note if left_out else '') + '.',
  )
