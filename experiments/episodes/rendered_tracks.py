"""What a tracker does on rendered pictures, beside what is truly there."""

from collections.abc import Callable
import dataclasses

import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.agents import absolute, receiver
from waggle_tasks.experiments.episodes import (
  ladder_table,
  sight_lines,
  track_errors,
  track_level,
)
from waggle_tasks.experiments.record import provenance
from waggle_tasks.protocol import reference

_REPORT_FRAMES = 50  # How often it says that it is alive.


@dataclasses.dataclass(frozen=True, eq=False)
class Watched:
  """What one observer made of its pictures, until its first message.

  Attributes:
    events: What it read.
    track: The errors of its tracker; None where it hardly saw anything.
  """

  events: list[receiver.Event]
  track: ladder_table.Track | None


class _Watcher:
  """One observer: its tracker and its receiver, which stays where it is."""

  def __init__(
    self, scene: scenario.Scenario, name: str, sight: sight_lines.Sight
  ) -> None:
    self._reader = track_level.make(name, scene)
    self._tracker = absolute.AbsoluteTracker(self._reader.DEFAULT.tracking)
    self._sight, self._images = sight, iter(sight.images())
    self._rows: list[tuple[int, tuple[float, float], bool]] = []
    self._frames: dict[float, int] = {}
    self._moved_px, self._lag = 0.0, scene.agreement.frames(ladder_table.LAG_S)
    self.events: list[receiver.Event] = []
    self.done = False

  def step(self, image: np.ndarray, time_s: float) -> None:
    """Takes an image; an old one is passed over."""
    if self.done or time_s in self._frames:
      return
    at_s, frame = next(self._images)
    if abs(at_s - time_s) > 1e-6:
      raise ladder_table.LadderError(
        f'an image of {time_s:g} s came where one of {at_s:g} s was told'
      )
    self._frames[time_s] = frame
    tracks = self._tracker.step(image, time_s)
    ghost = self._tracker.ghost
    if ghost is not None:
      if not self._rows:
        self._moved_px = self._sight.moved_px(frame - self._lag)
      self._rows += [
        (self._frames[each.time_s], tuple(each.centre_px), each.valid)
        for each in tracks
        if self._frames[each.time_s] >= 0
      ]
    anchor_px = None if ghost is None else ghost.anchor_px
    news = self._reader.follow(tracks, anchor_px, time_s)
    self.events += news
    self.done = any(event.message is not None for event in news)

  def watched(self) -> Watched:
    """What came of it."""
    if not self._rows:
      return Watched(self.events, None)
    frames, centres_px, valid = map(list, zip(*self._rows, strict=True))
    errors = track_errors.fit(
      self._sight, frames, np.array(centres_px), np.array(valid),
      self._moved_px,
    )  # fmt: skip
    return Watched(self.events, errors)


def watch(
  scene: scenario.Scenario,
  receiver_name: str,
  report: Callable[[float], None],
) -> tuple[list[Watched], str]:
  """Renders a scenario before observers who stay where they are.

  Args:
    scene: The scenario, of fidelity 'pixels'.
    receiver_name: Who reads.
    report: Told now and then how many seconds are done.

  Returns:
    What each observer made of it, and the GL renderer.
  """
  sights = sight_lines.of(scene)
  watchers = [_Watcher(scene, receiver_name, sight) for sight in sights]
  environment = registry.environment(scene)
  try:
    timestep = environment.reset()
    renderer = provenance.renderer_name(environment.physics)
    rest = [
      reference.Reference.hover(each['position_m'].copy()).to_array()
      for each in timestep.observation
    ]
    frame = 0
    while True:
      for watcher, seen in zip(watchers, timestep.observation, strict=True):
        watcher.step(seen['camera'], float(seen['time_s']))
      frame += 1
      if timestep.last() or all(each.done for each in watchers):
        return [each.watched() for each in watchers], renderer
      if frame % _REPORT_FRAMES == 0:
        report(frame * scene.agreement.frame_s)
      timestep = environment.step(rest)
  finally:
    environment.close()
