"""What a broadcast takes at each level of fidelity, and what a swarm takes."""

from collections.abc import Sequence
import dataclasses
import statistics

from waggle_tasks import fidelity, scenario
from waggle_tasks.experiments.bench_parts import processes
from waggle_tasks.experiments.episodes import colony_swarm, colony_worlds
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.studies import (
  link_conditions,
  sweep_cases,
  sweep_flight,
)

_CONDITIONS = 'calm', 'noise', 'mocap'
_VALUES = {'language': 'swift', 'observers': 1}
_RECEIVER = 'joint'
_SWARM = colony_swarm.Swarm(vehicles=1000, qualities=(1.0, 0.9))


@dataclasses.dataclass(frozen=True)
class Levels:
  """Broadcasts of `swift` to one observer, and swarms, in turns.

  Attributes:
    broadcast_s: Seconds of a whole broadcast, by its condition and its level.
    swarm: For each swarm of 1000 vehicles that chose, how many seconds it
      lived, and how many it took.
  """

  broadcast_s: dict[str, dict[str, list[float]]]
  swarm: list[tuple[float, float]]


def measure(
  _: scenario.Scenario, repeats: int, clock: processes.Clock
) -> Levels:
  """Flies the same broadcasts at both levels, one after the other."""
  found: dict[str, dict[str, list[float]]] = {}
  for condition in _CONDITIONS:
    seconds: dict[str, list[float]] = {}
    for repeat in range(-1, repeats):  # The first one warms up.
      for level in (fidelity.PIXELS, fidelity.TRACKS):
        took_s = _broadcast_s(condition, level, max(repeat, 0), clock)
        if repeat >= 0:
          seconds.setdefault(level, []).append(took_s)
    found[condition] = seconds
  return Levels(found, [_swarm(seed, clock) for seed in range(repeats)])


def _broadcast_s(
  condition: str, level: str, repeat: int, clock: processes.Clock
) -> float:
  values = {
    **scenario_fields.defaults(), **_VALUES, 'fidelity': level,
    **link_conditions.CONDITIONS[condition].values,
  }  # fmt: skip
  case = sweep_cases.draw({}, values, repeat)
  begin_s = clock()
  sweep_flight.fly(lambda done_s: None, case, _RECEIVER, '', 0)
  return clock() - begin_s


def _swarm(seed: int, clock: processes.Clock) -> tuple[float, float]:
  begin_s = clock()
  choice = colony_worlds.run(_SWARM, 1, seed)
  return float(choice.steps[0] * _SWARM.step_s), clock() - begin_s


def ratios(found: Levels) -> dict[str, float]:
  """How much faster tracks are, and swarms than real time."""
  out = {
    f'tracks / pixels, {condition}': _ratio(
      levels[fidelity.PIXELS], levels[fidelity.TRACKS]
    )
    for condition, levels in found.broadcast_s.items()
  }
  lived_s, took_s = zip(*found.swarm, strict=True)
  out['life of a swarm of 1000 / time'] = _ratio(lived_s, took_s)
  return out


def _ratio(one: Sequence[float], other: Sequence[float]) -> float:
  return statistics.median(a / b for a, b in zip(one, other, strict=True))


def text(found: Levels) -> str:
  """Seconds of a broadcast by condition and level, for people."""
  header = ('one broadcast of swift, s', fidelity.PIXELS, fidelity.TRACKS)
  rows = [
    (
      condition,
      table.number(statistics.median(levels[fidelity.PIXELS])),
      table.number(statistics.median(levels[fidelity.TRACKS]), 3),
    )
    for condition, levels in found.broadcast_s.items()
  ]
  return table.render(header, rows)
