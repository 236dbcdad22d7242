"""Whole broadcasts by the clock, and what they take of memory and cores."""

from collections.abc import Sequence
from concurrent import futures
import contextlib
import dataclasses
import resource
import sys
import time

from waggle_tasks import scenario
from waggle_tasks.experiments.bench_parts import processes
from waggle_tasks.experiments.episodes import rollout
from waggle_tasks.experiments.record import episode
from waggle_tasks.protocol import agreement

RECEIVER, READER = 'klt', 'joint'  # Of the paper's language, and of others.
COUNTS = (1, 2)  # Of processes.
# `ru_maxrss` is in kilobytes on Linux and in bytes on macOS (getrusage(2)).
_UNIT_MB = 2**-20 if sys.platform == 'darwin' else 2**-10


@dataclasses.dataclass(frozen=True)
class Loop:
  """What one broadcast took.

  Attributes:
    observers: How many observers it had.
    frames: Control steps; each gave every observer an image.
    loop_s: Seconds in the loop of these steps, by the clock that was given.
    whole_s: Seconds that passed in all, with building and closing.
    cpu_s: Processor seconds of the same, of all threads.
    frame_s: Simulated seconds of a control step.
  """

  observers: int
  frames: int
  loop_s: float
  whole_s: float
  cpu_s: float
  frame_s: float = agreement.Agreement().frame_s

  @property
  def simulated_s(self) -> float:
    """How long the broadcast was."""
    return self.frames * self.frame_s

  @property
  def receiver_frame_s(self) -> float:
    """Seconds in the loop for one image of one observer."""
    return self.loop_s / (self.frames * self.observers)


class _Watch:
  """An onlooker that notes when the first and the last step ended."""

  def __init__(self, clock: processes.Clock) -> None:
    self._clock = clock
    self.first_s = self.last_s = 0.0
    self.steps = 0

  def __call__(self, step: episode.Step) -> None:
    self.last_s = self._clock()
    if step.timestep.first():
      self.first_s = self.last_s
    else:
      self.steps += 1


def run(
  scene: scenario.Scenario,
  clock: processes.Clock = time.perf_counter,
  onlookers: Sequence[episode.Onlooker] = (),
) -> Loop:
  """Runs a broadcast with the paper's receiver, or who reads its language.

  Args:
    scene: The scenario.
    clock: What the loop is measured by.
    onlookers: What else looks on.
  """
  watch = _Watch(clock)
  cpu_s, begin_s = time.process_time(), time.perf_counter()
  rollout.run(scene, receiver(scene), [*onlookers, watch])
  return Loop(
    scene.observers,
    watch.steps,
    watch.last_s - watch.first_s,
    time.perf_counter() - begin_s,
    time.process_time() - cpu_s,
    scene.agreement.frame_s,
  )


def receiver(scene: scenario.Scenario) -> str:
  """Who reads what is spoken."""
  return RECEIVER if scene.agreement.language is None else READER


def repeat(
  scenes: Sequence[scenario.Scenario], repeats: int, clock: processes.Clock
) -> list[Loop]:
  """Runs every scenario once, then all of them again, and so on.

  Returns:
    The loops in the order in which they ran.
  """
  run(two_frames(scenes[0]))
  return [run(scene, clock) for _ in range(repeats) for scene in scenes]


def peaks_mb(scene: scenario.Scenario, broadcasts: int) -> list[float]:
  """The peak memory of this process so far after each of some broadcasts."""
  out = []
  for _ in range(broadcasts):
    run(scene)
    usage = resource.getrusage(resource.RUSAGE_SELF)
    out.append(usage.ru_maxrss * _UNIT_MB)
  return out


def throughput(
  scene: scenario.Scenario, repeats: int
) -> dict[int, list[float]]:
  """Simulated seconds per second of wall time, by the number of processes.

  Every process runs the same broadcast at once, builds its environment and
  closes it. Processes start, and run a broadcast of two frames, before they
  are measured.
  """
  out: dict[int, list[float]] = {count: [] for count in COUNTS}
  with contextlib.ExitStack() as stack:
    team = [stack.enter_context(processes.worker()) for _ in range(max(COUNTS))]
    _together(team, two_frames(scene))
    for _ in range(repeats):
      for count in COUNTS:
        out[count].append(_together(team[:count], scene))
  return out


def _together(
  team: Sequence[futures.Executor], scene: scenario.Scenario
) -> float:
  begin_s = time.perf_counter()
  jobs = [executor.submit(run, scene) for executor in team]
  simulated_s = sum(job.result().simulated_s for job in jobs)
  return simulated_s / (time.perf_counter() - begin_s)


def two_frames(scene: scenario.Scenario) -> scenario.Scenario:
  """What comes before a measurement, as first calls are slow."""
  return dataclasses.replace(scene, duration_s=2 * scene.agreement.frame_s)
