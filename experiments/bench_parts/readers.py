"""What each receiver costs, all of them on the same images."""

from collections.abc import Sequence

from waggle_tasks import scenario
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.experiments.bench_parts import loops, processes
from waggle_tasks.experiments.record import episode


class Readers:
  """An onlooker that lets several receivers read what each observer sees.

  Attributes:
    seconds: By receiver, what each image took until it had the message.
  """

  def __init__(
    self,
    scene: scenario.Scenario,
    clock: processes.Clock,
    names: Sequence[str],
  ) -> None:
    """Makes new receivers for every observer of a scenario."""
    self._clock = clock
    self._readers: dict[str, list[receiver.Receiver | None]] = {
      name: [
        receivers.make(name, scene.agreement) for _ in range(scene.observers)
      ]
      for name in names
    }
    self.seconds: dict[str, list[float]] = {n: [] for n in self._readers}

  def __call__(self, step: episode.Step) -> None:
    """Shows a time step's images to those who still read."""
    for name, readers in self._readers.items():
      for index, each in enumerate(step.timestep.observation):
        reader = readers[index]
        if reader is None:
          continue
        time_s = float(each['time_s'])
        begin_s = self._clock()
        events = receiver.step(reader, each['camera'], time_s)
        self.seconds[name].append(self._clock() - begin_s)
        if any(event.message for event in events):
          readers[index] = None


def measure(
  scene: scenario.Scenario,
  repeats: int,
  clock: processes.Clock,
  names: Sequence[str],
) -> list[dict[str, list[float]]]:
  """Runs a broadcast for several receivers at a time.

  Args:
    scene: The broadcast.
    repeats: How often.
    clock: What images are measured by.
    names: The receivers beside the paper's; empty for all that have a name.

  Returns:
    For each repeat, by receiver, the seconds of every image.
  """
  names = [*dict.fromkeys([loops.RECEIVER, *(names or receivers.RECEIVERS)])]
  out = []
  for _ in range(repeats):
    readers = Readers(scene, clock, names)
    loops.run(scene, clock, [readers])
    out.append(readers.seconds)
  return out
