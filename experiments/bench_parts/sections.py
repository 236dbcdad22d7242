"""The parts of the benchmark by name: what each runs, and where."""

from collections.abc import Callable, Sequence
import dataclasses
from typing import Any, TypeVar

from waggle_tasks import errors, registry, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.bench_parts import (
  cameras,
  eye_costs,
  fidelities,
  learners,
  loops,
  pilots,
  processes,
  readers,
  stages,
)
from waggle_tasks.protocol import agreement, checks, languages, symbols

OBSERVERS = (1, 2, 4, 8, 16)
LANGUAGES = (scenario.PAPER, *languages.LANGUAGES)
BROADCASTS = 20  # How many in one process, for its memory.
# An arc on which 16 observers stand 0.18 m apart, and fewer see the same.
_HALF_SPAN_DEG = 60.0
_MEMORY_S = 2.0

_Result = TypeVar('_Result')


class BenchError(errors.WaggleError):
  """A measurement that cannot be made."""


@dataclasses.dataclass(frozen=True)
class Settings:
  """How much is measured.

  Attributes:
    renderer: The GL renderer.
    repeats: How often each part is measured, 1 to 1000.
    simulated_s: Length of each broadcast, up to 600 s; None for whole ones,
      and the first gesture with its pauses where many are needed.
    long: Whether memory is watched over whole broadcasts.
    receivers: Those that are measured beside the paper's; without any, all of
      `receivers.RECEIVERS`.
  """

  renderer: str
  repeats: int = 3
  simulated_s: float | None = None
  long: bool = False
  receivers: tuple[str, ...] = ()

  def __post_init__(self) -> None:
    checks.integer('repeats', self.repeats, 1, 1000, BenchError)
    for name in self.receivers:
      receivers.make(name)
    if self.simulated_s is not None:
      low, high = 2 * agreement.Agreement().frame_s, 600.0
      checks.number('simulated_s', self.simulated_s, low, high, BenchError)

  @property
  def clock(self) -> processes.Clock:
    """What images and loops are measured by."""
    return processes.clock(self.renderer)

  @property
  def whole(self) -> scenario.Scenario:
    """The default broadcast."""
    return registry.find('broadcast', duration_s=self.simulated_s)

  @property
  def gesture(self) -> scenario.Scenario:
    """Its first hover, START, and the pause after it."""
    scene = self.whole
    seconds = scene.pauses.initial_hover_s + scene.pauses.pause_s
    seconds += scene.codebook[symbols.Symbol.START].duration_s
    return self._first(seconds)

  @property
  def spoken(self) -> list[scenario.Scenario]:
    """The default broadcast in the paper's language, and in each other."""
    return [
      dataclasses.replace(self.whole, language=name) for name in LANGUAGES
    ]

  @property
  def crowds(self) -> list[scenario.Scenario]:
    """The same for different numbers of observers."""
    return [
      dataclasses.replace(
        self.gesture, observers=count, half_span_deg=_HALF_SPAN_DEG
      )
      for count in OBSERVERS
    ]

  @property
  def glimpse(self) -> scenario.Scenario:
    """Its first two seconds; all of it with `long`."""
    return self.whole if self.long else self._first(_MEMORY_S)

  def _first(self, seconds: float) -> scenario.Scenario:
    return dataclasses.replace(
      self.whole, duration_s=self.simulated_s or seconds
    )


@dataclasses.dataclass(frozen=True)
class Memory:
  """Peak memory of processes.

  Attributes:
    whole_mb: Of one that ran one whole broadcast.
    after_mb: Of another, after each of its broadcasts.
  """

  whole_mb: float
  after_mb: list[float]


def _memory(settings: Settings) -> Memory:
  (whole_mb,) = processes.alone(loops.peaks_mb, settings.whole, 1)
  after_mb = processes.alone(loops.peaks_mb, settings.glimpse, BROADCASTS)
  return Memory(whole_mb, after_mb)


def _alone(
  measure: Callable[..., _Result],
  settings: Settings,
  *more: object,
  what: object = None,
) -> _Result:
  """Measures the default broadcast, or something else, in a new process."""
  return processes.alone(
    measure, what or settings.whole, settings.repeats, settings.clock, *more
  )


# What each part measures.
SECTIONS: dict[str, Callable[[Settings], Any]] = {
  'cameras': lambda settings: _alone(cameras.measure, settings),
  'eyes': lambda settings: _alone(eye_costs.measure, settings),
  'stages': lambda settings: _alone(stages.measure, settings),
  'receivers': lambda settings: _alone(
    readers.measure, settings, settings.receivers
  ),
  'realtime': lambda settings: _alone(
    loops.repeat, settings, what=[settings.whole]
  ),
  'languages': lambda settings: _alone(
    loops.repeat, settings, what=settings.spoken
  ),
  'dynamics': lambda settings: _alone(pilots.measure, settings),
  'fidelities': lambda settings: _alone(fidelities.measure, settings),
  'learners': lambda settings: _alone(learners.measure, settings),
  'observers': lambda settings: _alone(
    loops.repeat, settings, what=settings.crowds
  ),
  'memory': _memory,
  'workers': lambda settings: loops.throughput(
    settings.gesture, settings.repeats
  ),
}


def chosen(names: Sequence[str]) -> list[str]:
  """The names of `SECTIONS` that were asked for, all that can be when none was.

  Raises:
    BenchError: if a name is not known, or takes what is not installed.
  """
  for name in names:
    checks.choice('only', name, [*SECTIONS], BenchError)
  here = learners.installed()
  if 'learners' in names and not here:
    raise BenchError(
      '`only` must not hold learners without the extra rl:'
      " pip install 'waggle-tasks[rl]'"
    )
  wanted = names or [each for each in SECTIONS if here or each != 'learners']
  return [name for name in SECTIONS if name in wanted]
