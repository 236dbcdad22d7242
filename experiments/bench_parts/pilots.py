"""What it takes to fly vehicles, by each dynamics."""

import dataclasses

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.bench_parts import loops, processes
from waggle_tasks.protocol import limits, reference


@dataclasses.dataclass(frozen=True)
class Flying:
  """What broadcasts took, in turns, by their dynamics.

  Attributes:
    whole: Broadcasts with everything.
    step_s: Seconds of a control step in which nobody sees anything.
  """

  whole: dict[str, list[loops.Loop]]
  step_s: dict[str, list[float]]


def measure(
  scene: scenario.Scenario, repeats: int, clock: processes.Clock
) -> Flying:
  """Flies a broadcast by each dynamics, once with eyes and once without."""
  scenes = [
    dataclasses.replace(scene, dynamics=each) for each in limits.DYNAMICS
  ]
  found = loops.repeat(scenes, repeats, clock)
  blind_s = [[_step_s(each, clock) for each in scenes] for _ in range(repeats)]
  count = len(scenes)
  return Flying(
    {name: found[k::count] for k, name in enumerate(limits.DYNAMICS)},
    {name: [s[k] for s in blind_s] for k, name in enumerate(limits.DYNAMICS)},
  )


def _step_s(scene: scenario.Scenario, clock: processes.Clock) -> float:
  """Seconds of a control step, of a whole dance before closed eyes."""
  environment = registry.environment(scene)
  for each in environment.task.observers:
    each.observables.camera.enabled = False
  try:
    timestep = environment.reset()
    action = [
      reference.Reference.hover(seen['position_m']).to_array()
      for seen in timestep.observation
    ]
    begin_s, steps = clock(), 0
    while not timestep.last():
      timestep, steps = environment.step(action), steps + 1
    return (clock() - begin_s) / steps
  finally:
    environment.close()
