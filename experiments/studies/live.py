"""What every observer has read so far, in the terminal, while it flies."""

from collections.abc import Iterator, Sequence
import contextlib
import sys

import tqdm

from waggle_tasks import scenario
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.record import episode, story


class Lines:
  """One line for each name that is written anew where it stands.

  What is no terminal, such as a file, gets a line for every change.
  """

  def __init__(self, names: Sequence[str]) -> None:
    """Makes room for a line of each name, below a bar that is there."""
    self._width = max(map(len, names))
    self._shown: dict[str, str] = {}
    self._bars: dict[str, tqdm.tqdm] = {}
    if sys.stderr.isatty():
      self._bars = {
        name: tqdm.tqdm(bar_format='{desc}', position=number)
        for number, name in enumerate(names, 1)
      }

  def show(self, name: str, text: str, time_s: float) -> None:
    """Shows what a name has to say at a time, if it is new."""
    if self._shown.get(name) == text:
      return
    self._shown[name] = text
    line = f'{name:{self._width}}  {time_s:6.2f} s  {text}'
    if self._bars:
      self._bars[name].set_description_str(line)
    else:
      tqdm.tqdm.write(line, file=sys.stderr)

  def close(self) -> None:
    """Leaves the last lines where they are."""
    for bar in self._bars.values():
      bar.close()


@contextlib.contextmanager
def onlookers(
  scene: scenario.Scenario, wanted: bool
) -> Iterator[list[episode.Onlooker]]:
  """What shows how far every observer of a scenario is, if it is wanted."""
  if not wanted:
    yield []
    return
  names = layouts.names(scene.observers)
  lines = Lines(names)
  readings = [story.Reading(scene.agreement)] * len(names)
  told = [0] * len(names)

  def watch(step: episode.Step) -> None:
    time_s = float(step.environment.physics.time())
    for number, agent in enumerate(step.team.agents):
      for event in agent.events[told[number] :]:
        readings[number] = readings[number].after(event)
      told[number] = len(agent.events)
      lines.show(names[number], _line(readings[number]), time_s)

  try:
    yield [watch]
  finally:
    lines.close()


def _line(reading: story.Reading) -> str:
  """The motions of the frame under way, and what comes next."""
  seen = ' '.join(mark.label for mark in reading.symbols)
  return f'{seen:24}  {reading.status}' if seen else reading.status
