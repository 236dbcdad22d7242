"""The benchmark's numbers for people: ratios first, then where they are from.

Every number is a median over repeats; a ratio is the median of the ratios of
numbers that were measured one after the other.
"""

from collections.abc import Callable, Mapping, Sequence
import statistics
from typing import Any

from waggle_tasks.experiments.bench_parts import (
  cameras,
  loops,
  pilots,
  sections,
  stages,
)
from waggle_tasks.experiments.machine import table

Ratios = dict[str, float]
_FEW, _MANY = 2, sections.OBSERVERS[-1]
_FASTER = {
  f'{cameras.STOCK} camera': cameras.STOCK,
  cameras.STOCK_PLAIN: cameras.STOCK_PLAIN,
  'our full render': cameras.FULL,
}


def _ratio(one: Sequence[float], other: Sequence[float]) -> float:
  pairs = zip(one, other, strict=True)
  return statistics.median(a / b for a, b in pairs)


def _number(value: float, digits: int = 2) -> str:
  return table.number(value, digits)


def _by_observers(found: Sequence[loops.Loop]) -> dict[int, list[float]]:
  """Seconds for each image, by the number of observers."""
  out: dict[int, list[float]] = {}
  for loop in found:
    out.setdefault(loop.observers, []).append(loop.receiver_frame_s)
  return out


def _camera_ratios(found: cameras.Cameras) -> Ratios:
  ours = found.mean_s[cameras.INCREMENTAL]
  return {
    f'{title} / incremental camera': _ratio(found.mean_s[name], ours)
    for title, name in _FASTER.items()
  }


def _cameras(found: cameras.Cameras) -> str:
  header = ('one 640x480 image', 'ms', 'of the frames', 'images')
  rows = [
    (
      name,
      _number(1e3 * statistics.median(seconds), 3),
      '',
      str(found.images[name]),
    )
    for name, seconds in found.mean_s.items()
  ]
  rows += [
    (
      f'  {phase}',
      _number(1e3 * statistics.median(seconds), 3),
      f'{found.share[phase]:.0%}',
      '',
    )
    for phase, seconds in found.phase_s.items()
  ]
  return table.render(header, rows)


def _stages(found: Sequence[Mapping[str, float]]) -> str:
  header = ('one receiver and frame of the loop', 'us', 'share')
  median_s = {
    name: statistics.median(each[name] for each in found) for name in found[0]
  }
  total_s = sum(median_s.values())
  rest_s = median_s.pop(stages.OTHER)
  order = sorted(median_s, key=lambda name: median_s[name], reverse=True)
  shown = {name: median_s[name] for name in order}
  shown |= {stages.OTHER: rest_s, 'all of it': total_s}
  rows = [
    (name, _number(1e6 * seconds, 0), f'{seconds / total_s:.0%}')
    for name, seconds in shown.items()
  ]
  return table.render(header, rows)


def _receiver_ratios(found: Sequence[Mapping[str, Sequence[float]]]) -> Ratios:
  mean_s = {
    name: [statistics.fmean(each[name]) for each in found] for name in found[0]
  }
  return {
    f'{loops.RECEIVER} receiver / {name}': _ratio(
      mean_s[loops.RECEIVER], seconds
    )
    for name, seconds in mean_s.items()
    if name != loops.RECEIVER
  }


def _receivers(found: Sequence[Mapping[str, Sequence[float]]]) -> str:
  header = ('one image of the default broadcast', 'median us', 'mean us')
  rows = []
  for name in found[0]:
    middle_s = statistics.median(statistics.median(e[name]) for e in found)
    mean_s = statistics.median(statistics.fmean(e[name]) for e in found)
    rows.append((name, _number(1e6 * middle_s, 0), _number(1e6 * mean_s, 0)))
  return table.render(header, rows)


def _realtime_ratios(found: Sequence[loops.Loop]) -> Ratios:
  simulated_s = [loop.simulated_s for loop in found]
  wall_s = [loop.whole_s for loop in found]
  return {'simulated time / time on one core': _ratio(simulated_s, wall_s)}


def _realtime(found: Sequence[loops.Loop]) -> str:
  header = ('default broadcast on one core', 's', 'faster than real time')
  wall = {
    'simulated': [loop.simulated_s for loop in found],
    'everything': [loop.whole_s for loop in found],
    'everything, processor time': [loop.cpu_s for loop in found],
    'the loop alone': [loop.loop_s for loop in found],
  }
  rows = [
    (
      name,
      _number(statistics.median(seconds)),
      _number(_ratio(wall['simulated'], seconds), 1),
    )
    for name, seconds in wall.items()
  ]
  return table.render(header, rows)


def _dynamics_ratios(found: pilots.Flying) -> Ratios:
  usual, *others = found.whole
  out: Ratios = {}
  for name in others:
    loop_s = [loop.whole_s for loop in found.whole[name]]
    simulated_s = [loop.simulated_s for loop in found.whole[name]]
    more_s = [
      (one - other) * loop.frames / loop.whole_s
      for one, other, loop in zip(
        found.step_s[name], found.step_s[usual], found.whole[name], strict=True
      )
    ]
    out[f'simulated time / time on one core, {name}'] = _ratio(
      simulated_s, loop_s
    )
    out[f'share of a broadcast that {name} add'] = statistics.median(more_s)
  return out


def _dynamics(found: pilots.Flying) -> str:
  header = (
    'default broadcast', 's', 'faster than real time', 'us a step, no images'
  )  # fmt: skip
  rows = []
  for name, whole in found.whole.items():
    wall_s = [loop.whole_s for loop in whole]
    simulated_s = [loop.simulated_s for loop in whole]
    rows.append(
      (
        name,
        _number(statistics.median(wall_s)),
        _number(_ratio(simulated_s, wall_s), 1),
        _number(1e6 * statistics.median(found.step_s[name]), 0),
      )
    )
  return table.render(header, rows)


def _observer_ratios(found: Sequence[loops.Loop]) -> Ratios:
  cost_s = _by_observers(found)
  title = f'cost of a receiver and frame, {_MANY} observers / {_FEW}'
  return {title: _ratio(cost_s[_MANY], cost_s[_FEW])}


def _observers(found: Sequence[loops.Loop]) -> str:
  header = ('observers', 'us for each and frame', f'of that with {_FEW}')
  cost_s = _by_observers(found)
  rows = [
    (
      str(count),
      _number(1e6 * statistics.median(seconds), 0),
      _number(_ratio(seconds, cost_s[_FEW])),
    )
    for count, seconds in cost_s.items()
  ]
  return table.render(header, rows)


def _memory(found: sections.Memory) -> str:
  after_mb = found.after_mb
  header = ('peak memory of a process', 'MB')
  rows = [
    ('one default broadcast', _number(found.whole_mb, 0)),
    ('broadcast 1 in another process', _number(after_mb[0], 0)),
    ('broadcast 2', _number(after_mb[1], 0)),
    (f'broadcast {len(after_mb)}', _number(after_mb[-1], 0)),
  ]
  return table.render(header, rows)


def _worker_ratios(found: Mapping[int, Sequence[float]]) -> Ratios:
  return {'throughput, 2 processes / 1': _ratio(found[2], found[1])}


def _workers(found: Mapping[int, Sequence[float]]) -> str:
  header = ('processes', 'simulated s a second')
  rows = [
    (str(count), _number(statistics.median(each), 1))
    for count, each in found.items()
  ]
  return table.render(header, rows)


_TABLES: dict[str, Callable[..., str]] = {
  'cameras': _cameras,
  'stages': _stages,
  'receivers': _receivers,
  'realtime': _realtime,
  'dynamics': _dynamics,
  'observers': _observers,
  'memory': _memory,
  'workers': _workers,
}
_RATIOS: dict[str, Callable[..., Ratios]] = {
  'cameras': _camera_ratios,
  'receivers': _receiver_ratios,
  'realtime': _realtime_ratios,
  'dynamics': _dynamics_ratios,
  'observers': _observer_ratios,
  'workers': _worker_ratios,
}


def ratios(results: Mapping[str, Any]) -> Ratios:
  """Every ratio, by its title.

  Args:
    results: What parts of `sections.SECTIONS` measured, by name.
  """
  out: Ratios = {}
  for name, found in results.items():
    if name in _RATIOS:
      out |= _RATIOS[name](found)
  return out


def text(results: Mapping[str, Any]) -> str:
  """Every ratio, then a table for each part."""
  parts = []
  if all_ratios := ratios(results):
    rows = [(name, _number(value)) for name, value in all_ratios.items()]
    parts.append(table.render(('ratio', ''), rows))
  parts += [_TABLES[name](found) for name, found in results.items()]
  return '\n\n'.join(parts)
