"""The parts of the benchmark by name: what each runs, and where."""

from collections.abc import Sequence
import dataclasses

from waggle_tasks import errors, registry, scenario
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.bench_parts import (
  cameras,
  loops,
  memory,
  pilots,
  processes,
  readers,
  stages,
  workers,
)
from waggle_tasks.protocol import agreement, checks, symbols

OBSERVERS = (1, 2, 4, 8, 16)
BROADCASTS = 20  # How many in one process, for its memory.
# An arc on which 16 observers stand 0.18 m apart, and fewer see the same.
_HALF_SPAN_DEG = 60.0
_MEMORY_S = 2.0


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


def measure_cameras(settings: Settings) -> cameras.Cameras:
  """One image of every camera."""
  return processes.alone(
    cameras.measure, settings.whole, settings.repeats, settings.clock
  )


def measure_stages(settings: Settings) -> list[dict[str, float]]:
  """The loop's stages."""
  return processes.alone(
    stages.measure, settings.whole, settings.repeats, settings.clock
  )


def measure_receivers(settings: Settings) -> list[dict[str, list[float]]]:
  """Receivers on the same images."""
  names = settings.receivers or [*receivers.RECEIVERS]
  return processes.alone(
    readers.measure, settings.whole, settings.repeats, settings.clock,
    [*dict.fromkeys([loops.RECEIVER, *names])],
  )  # fmt: skip


def measure_realtime(settings: Settings) -> list[loops.Loop]:
  """The default broadcast, everything included."""
  return processes.alone(
    loops.repeat, [settings.whole], settings.repeats, settings.clock
  )


def measure_dynamics(settings: Settings) -> pilots.Flying:
  """The default broadcast by each dynamics, in turns."""
  return processes.alone(
    pilots.measure, settings.whole, settings.repeats, settings.clock
  )


def measure_observers(settings: Settings) -> list[loops.Loop]:
  """Broadcasts of different numbers of observers, in turns."""
  scenes = [
    dataclasses.replace(
      settings.gesture, observers=count, half_span_deg=_HALF_SPAN_DEG
    )
    for count in OBSERVERS
  ]
  return processes.alone(loops.repeat, scenes, settings.repeats, settings.clock)


def measure_memory(settings: Settings) -> Memory:
  """Peak memory, and whether it stays where it is."""
  (whole_mb,) = processes.alone(memory.measure, settings.whole, 1)
  return Memory(
    whole_mb, processes.alone(memory.measure, settings.glimpse, BROADCASTS)
  )


def measure_workers(settings: Settings) -> dict[int, list[float]]:
  """The throughput of one process and of two."""
  return workers.measure(settings.gesture, settings.repeats)


SECTIONS = {
  'cameras': measure_cameras,
  'stages': measure_stages,
  'receivers': measure_receivers,
  'realtime': measure_realtime,
  'dynamics': measure_dynamics,
  'observers': measure_observers,
  'memory': measure_memory,
  'workers': measure_workers,
}


def chosen(names: Sequence[str]) -> list[str]:
  """The names of `SECTIONS` that were asked for, all when none was.

  Raises:
    BenchError: if a name is not known.
  """
  for name in names:
    checks.choice('only', name, [*SECTIONS], BenchError)
  return [name for name in SECTIONS if not names or name in names]
