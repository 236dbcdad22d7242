"""What observers saw of a flight, kept small, to be shown again and again."""

from collections.abc import Callable, Iterator
import dataclasses

import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.record import provenance
from waggle_tasks.protocol import reference

Stream = Iterator[tuple[np.ndarray, float]]  # Images and their times.
_Part = tuple[tuple[slice, slice], np.ndarray]
_REPORT_IMAGES = 50  # How often a flight says that it is alive.


@dataclasses.dataclass(eq=False)
class Tape:
  """The images of one observer: the first, and where later ones differ.

  Attributes:
    first: (H, W, 3) uint8.
    renderer: The GL renderer that drew them.
    times_s: Their times.
    parts: For each image where it differs from the first and what is there, or
      None.
  """

  first: np.ndarray
  renderer: str
  times_s: list[float] = dataclasses.field(default_factory=list)
  parts: list[_Part | None] = dataclasses.field(default_factory=list)

  def add(self, image: np.ndarray, time_s: float) -> None:
    """Takes an image of the same size."""
    part = None
    rows = _differing(image, self.first)
    if rows.start < rows.stop:
      # Along rows, as images lie in memory, all of it is compared; across
      # them, only where something is.
      turned = (each[rows].swapaxes(0, 1) for each in (image, self.first))
      columns = _differing(*turned)
      part = (rows, columns), image[rows, columns].copy()
    self.times_s.append(time_s)
    self.parts.append(part)

  def play(self) -> Stream:
    """The images, each valid until the next is asked for, and their times."""
    image, last = self.first.copy(), None
    for part, time_s in zip(self.parts, self.times_s, strict=True):
      if last is not None:
        image[last] = self.first[last]
      last = None
      if part is not None:
        last, seen = part
        image[last] = seen
      yield image, time_s


def _differing(image: np.ndarray, other: np.ndarray) -> slice:
  """From the first to the last row that differs; empty where none does."""
  changed = image.reshape(len(image), -1) != other.reshape(len(other), -1)
  rows = np.flatnonzero(changed.any(axis=1))
  return slice(int(rows[0]), int(rows[-1]) + 1) if len(rows) else slice(0, 0)


def record(
  scene: scenario.Scenario, report: Callable[[float], None]
) -> list[Tape]:
  """Flies a scenario before observers who only watch: a tape for each.

  Args:
    scene: The scenario.
    report: Told now and then how many seconds are done.
  """
  environment = registry.environment(scene)
  try:
    timestep = environment.reset()
    homes = [each['position_m'].copy() for each in timestep.observation]
    rest = [reference.Reference.hover(home).to_array() for home in homes]
    renderer = provenance.renderer_name(environment.physics)
    tapes = [
      Tape(each['camera'].copy(), renderer) for each in timestep.observation
    ]
    while True:
      for tape, seen in zip(tapes, timestep.observation, strict=True):
        tape.add(seen['camera'], float(seen['time_s']))
      if timestep.last():
        return tapes
      if len(tapes[0].times_s) % _REPORT_IMAGES == 0:
        report(tapes[0].times_s[-1])
      timestep = environment.step(rest)
  finally:
    environment.close()
