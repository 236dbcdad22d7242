"""The benchmark's numbers for people: ratios first, then where they are from.

Every number is a median over repeats; a ratio is the median of the ratios of
numbers that were measured one after the other.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
import statistics
from typing import Any

from waggle_tasks.experiments.bench_parts import (
  cameras,
  eye_costs,
  fidelities,
  learners,
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


def _middle(seconds: Iterable[float], digits: int, scale: float = 1.0) -> str:
  return table.number(statistics.median(seconds), digits, scale)


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
    (name, _middle(seconds, 3, 1e3), '', str(found.images[name]))
    for name, seconds in found.mean_s.items()
  ]
  rows += [
    (f'  {phase}', _middle(seconds, 3, 1e3), f'{found.share[phase]:.0%}', '')
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
  shown = sorted(median_s.items(), key=lambda each: -each[1])
  rows = [
    (name, table.number(seconds, 0, 1e6), f'{seconds / total_s:.0%}')
    for name, seconds in (
      *shown, (stages.OTHER, rest_s), ('all of it', total_s),
    )
  ]  # fmt: skip
  return table.render(header, rows)


def _receiver_ratios(found: Sequence[Mapping[str, Sequence[float]]]) -> Ratios:
  mean_s = {
    name: [statistics.fmean(each[name]) for each in found] for name in found[0]
  }
  paper_s = mean_s.pop(loops.RECEIVER)
  return {
    f'{loops.RECEIVER} receiver / {name}': _ratio(paper_s, seconds)
    for name, seconds in mean_s.items()
  }


def _receivers(found: Sequence[Mapping[str, Sequence[float]]]) -> str:
  header = ('one image of the default broadcast', 'median us', 'mean us')
  kinds = statistics.median, statistics.fmean
  rows = [
    (name, *(_middle((k(e[name]) for e in found), 0, 1e6) for k in kinds))
    for name in found[0]
  ]
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
      name, _middle(seconds, 2),
      table.number(_ratio(wall['simulated'], seconds), 1),
    )
    for name, seconds in wall.items()
  ]  # fmt: skip
  return table.render(header, rows)


def _by_languages(
  found: Sequence[loops.Loop],
) -> dict[str, Sequence[loops.Loop]]:
  count = len(sections.LANGUAGES)
  return {name: found[k::count] for k, name in enumerate(sections.LANGUAGES)}


def _speeds(found: Sequence[loops.Loop]) -> list[float]:
  """How many times as fast as real time, with everything."""
  return [loop.simulated_s / loop.whole_s for loop in found]


def _language_ratios(found: Sequence[loops.Loop]) -> Ratios:
  (paper, usual), *others = _by_languages(found).items()
  return {
    f'speed of a broadcast, {name} / {paper}': _ratio(
      _speeds(own), _speeds(usual)
    )
    for name, own in others
  }


def _languages(found: Sequence[loops.Loop]) -> str:
  header = (
    'default broadcast', 'simulated s', 's with everything',
    'faster than real time',
  )  # fmt: skip
  rows = [
    (
      name, _middle([loop.simulated_s for loop in own], 2),
      _middle([loop.whole_s for loop in own], 2), _middle(_speeds(own), 1),
    )
    for name, own in _by_languages(found).items()
  ]  # fmt: skip
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
        name, _middle(wall_s, 2), table.number(_ratio(simulated_s, wall_s), 1),
        _middle(found.step_s[name], 0, 1e6),
      )
    )  # fmt: skip
  return table.render(header, rows)


def _learner_ratios(found: learners.Learning) -> Ratios:
  seen_s = found.step_s['pictures']
  return {
    f'steps of a learner, {name} / pictures': _ratio(seen_s, step_s)
    for name, step_s in found.step_s.items()
    if name != 'pictures'
  }


def _learners(found: learners.Learning) -> str:
  rows = [
    (name, f'{1 / statistics.median(step_s):,.0f}')
    for name, step_s in found.step_s.items()
  ]
  return table.render(('one agent', 'steps a second'), rows)


def _observer_ratios(found: Sequence[loops.Loop]) -> Ratios:
  cost_s = _by_observers(found)
  title = f'cost of a receiver and frame, {_MANY} observers / {_FEW}'
  return {title: _ratio(cost_s[_MANY], cost_s[_FEW])}


def _observers(found: Sequence[loops.Loop]) -> str:
  header = ('observers', 'us for each and frame', f'of that with {_FEW}')
  cost_s = _by_observers(found)
  rows = [
    (
      str(count), _middle(seconds, 0, 1e6),
      table.number(_ratio(seconds, cost_s[_FEW])),
    )
    for count, seconds in cost_s.items()
  ]  # fmt: skip
  return table.render(header, rows)


def _memory(found: sections.Memory) -> str:
  after_mb = found.after_mb
  rows = {
    'one default broadcast': found.whole_mb,
    'broadcast 1 in another process': after_mb[0],
    'broadcast 2': after_mb[1],
    f'broadcast {len(after_mb)}': after_mb[-1],
  }
  return table.render(
    ('peak memory of a process', 'MB'),
    [(name, table.number(each_mb, 0)) for name, each_mb in rows.items()],
  )


def _worker_ratios(found: Mapping[int, Sequence[float]]) -> Ratios:
  return {'throughput, 2 processes / 1': _ratio(found[2], found[1])}


def _workers(found: Mapping[int, Sequence[float]]) -> str:
  rows = [(str(count), _middle(each, 1)) for count, each in found.items()]
  return table.render(('processes', 'simulated s a second'), rows)


# How each part is told, and the ratios that follow from it.
_PARTS: dict[str, tuple[Callable[..., str], Callable[..., Ratios]]] = {
  'cameras': (_cameras, _camera_ratios),
  'eyes': (eye_costs.text, eye_costs.ratios),
  'stages': (_stages, lambda found: {}),
  'receivers': (_receivers, _receiver_ratios),
  'realtime': (_realtime, _realtime_ratios),
  'languages': (_languages, _language_ratios),
  'dynamics': (_dynamics, _dynamics_ratios),
  'fidelities': (fidelities.text, fidelities.ratios),
  'learners': (_learners, _learner_ratios),
  'observers': (_observers, _observer_ratios),
  'memory': (_memory, lambda found: {}),
  'workers': (_workers, _worker_ratios),
}


def ratios(results: Mapping[str, Any]) -> Ratios:
  """Every ratio, by its title.

  Args:
    results: What parts of `sections.SECTIONS` measured, by name.
  """
  out: Ratios = {}
  for name, found in results.items():
    out |= _PARTS[name][1](found)
  return out


def text(results: Mapping[str, Any]) -> str:
  """Every ratio, then a table for each part."""
  parts = []
  if all_ratios := ratios(results):
    rows = [(name, table.number(value)) for name, value in all_ratios.items()]
    parts.append(table.render(('ratio', ''), rows))
  parts += [_PARTS[name][0](found) for name, found in results.items()]
  return '\n\n'.join(parts)
