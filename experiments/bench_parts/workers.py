"""How much more is done by two processes than by one."""

from collections.abc import Sequence
from concurrent import futures
import contextlib
import dataclasses
import time

from waggle_tasks import scenario
from waggle_tasks.experiments.bench_parts import loops, processes

COUNTS = (1, 2)


def measure(scene: scenario.Scenario, repeats: int) -> dict[int, list[float]]:
  """Simulated seconds per second of wall time, by the number of processes.

  Every process runs the same broadcast at once, builds its environment and
  closes it. Processes start, and run a broadcast of two frames, before they
  are measured.
  """
  out: dict[int, list[float]] = {count: [] for count in COUNTS}
  with contextlib.ExitStack() as stack:
    team = [stack.enter_context(processes.worker()) for _ in range(max(COUNTS))]
    two_s = 2 * scene.agreement.frame_s
    _run(team, dataclasses.replace(scene, duration_s=two_s))
    for _ in range(repeats):
      for count in COUNTS:
        out[count].append(_run(team[:count], scene))
  return out


def _run(team: Sequence[futures.Executor], scene: scenario.Scenario) -> float:
  begin_s = time.perf_counter()
  jobs = [executor.submit(loops.run, scene) for executor in team]
  simulated_s = sum(job.result().simulated_s for job in jobs)
  return simulated_s / (time.perf_counter() - begin_s)
