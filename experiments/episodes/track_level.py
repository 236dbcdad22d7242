"""An episode without pictures: receivers read tracks with measured errors."""

from collections.abc import Iterator, Sequence
import dataclasses
import math
from typing import cast

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.agents import (
  elapsed,
  joint_receiver,
  klt,
  receiver,
  receivers,
)
from waggle_tasks.experiments.episodes import (
  ladder_table,
  sight_lines,
  track_errors,
)

_STILL_PX = 2.0  # A target that moves by less rests, as the tracker has it.
_BEGUN_PX = 0.1  # Of a motion.
_STREAM = 18  # Of a seed: what is drawn here is drawn by nobody else.


@dataclasses.dataclass(frozen=True, eq=False)
class Step:
  """What a tracker makes of one image.

  Attributes:
    tracks: See `JointReceiver.follow`.
    anchor_px: The same.
    time_s: The same.
  """

  tracks: Sequence[klt.Track]
  anchor_px: np.ndarray | None
  time_s: float


def check_receiver(name: str, scene: scenario.Scenario) -> None:
  """Refuses a receiver that cannot be given tracks.

  Raises:
    LadderError: naming it.
  """
  made, _ = receivers.configured(name)
  if made is not joint_receiver.JointReceiver:
    raise ladder_table.LadderError(
      f"`receiver` must be 'joint' at fidelity {scene.fidelity!r}: got"
      f' {name!r}, whose stages were not measured apart'
    )


def make(name: str, scene: scenario.Scenario) -> joint_receiver.JointReceiver:
  """A receiver that reads tracks.

  Raises:
    LadderError: if the receiver cannot be given tracks.
  """
  check_receiver(name, scene)
  reader = receivers.make(name, scene.agreement)
  return cast(joint_receiver.JointReceiver, reader)


def check(scene: scenario.Scenario, table: ladder_table.Table) -> None:
  """Refuses a scenario of which a table does not tell.

  Raises:
    LadderError: naming the field, the rule and the value.
  """
  for name, pose in scene.poses().items():
    x_m, y_m, _ = pose.position_m
    if name != 'performer':
      angle_deg = math.degrees(math.atan2(x_m, -y_m))
      track_errors.cells(table, scene, math.hypot(x_m, y_m), angle_deg)


def read(
  scene: scenario.Scenario,
  receiver_name: str,
  table: ladder_table.Table | None = None,
) -> list[list[receiver.Event]]:
  """What every observer reads, up to its first message: a list of events each.

  Args:
    scene: The scenario.
    receiver_name: Who reads.
    table: What was measured; None for that of the package.

  Raises:
    LadderError: if the receiver or the scenario was not measured.
  """
  known = table or ladder_table.read()
  out = []
  for number, sight in enumerate(sight_lines.of(scene)):
    reader = make(receiver_name, scene)
    rng = np.random.default_rng([scene.seed, number, _STREAM])
    events: list[receiver.Event] = []
    for step in _steps(scene, sight, known, rng):
      news = reader.follow(step.tracks, step.anchor_px, step.time_s)
      events += news
      if any(event.message is not None for event in news):
        break
    out.append(events)
  return out


def _steps(
  scene: scenario.Scenario,
  sight: sight_lines.Sight,
  table: ladder_table.Table,
  rng: np.random.Generator,
) -> Iterator[Step]:
  """What the tracker makes of every image that comes."""
  track, scale = track_errors.pick(table, scene, sight, rng)
  places_px, seen = track_errors.draw(sight, track, scale, rng)
  tracking = joint_receiver.JointReceiver.DEFAULT.tracking
  follower = _Follower(places_px, seen)
  learner = _Learner(
    sight, tracking.learn_s, tracking.forget_s, scale * track.moved_px
  )
  following, seen_s = False, math.inf
  for time_s, frame in sight.images():
    if not following:
      found = learner.step(time_s, frame)
      following = bool(found)
      if not found:
        rests = frame >= 0 and bool(sight.inside[frame])
        yield Step([follower.resting(time_s, rests)], None, time_s)
        continue
      news = [follower.track(*each) for each in found]
    else:
      news = [follower.track(time_s, frame)]
    seen_s = next((t.time_s for t in news[::-1] if t.valid), seen_s)
    anchor_px = sight.places_px[learner.home] + scale * np.array(track.bias_px)
    yield Step(news, anchor_px, time_s)
    if time_s - seen_s > tracking.relearn_s:
      following, seen_s = False, math.inf
      learner.forget()


class _Follower:
  """Makes tracks of frames."""

  def __init__(
    self,
    places_px: np.ndarray,  # (T, 2)
    seen: np.ndarray,  # (T,)
  ) -> None:
    self._places_px, self._seen = places_px, seen
    self._last_px = places_px[0]

  def track(self, time_s: float, frame: int) -> klt.Track:
    """What is seen in a frame, -1 for a black one."""
    if frame < 0 or not self._seen[frame]:
      return klt.Track(time_s, self._last_px, 0.0, 0, 0.0, False)
    self._last_px = self._places_px[frame]
    return klt.Track(time_s, self._last_px, 0.0, 1, 1.0, True)

  def resting(self, time_s: float, seen: bool) -> klt.Track:
    """What is seen before the target has left its place."""
    return klt.Track(time_s, self._last_px, 0.0, 0, float(seen), seen)


class _Learner:
  """Learns where the target rests, and notices that it has left.

  Attributes:
    home: The frame in which it rested.
  """

  def __init__(
    self,
    sight: sight_lines.Sight,
    learn_s: float,
    forget_s: float,
    moved_px: float,
  ) -> None:
    self._sight = sight
    self._learn_s, self._forget_s, self._moved_px = learn_s, forget_s, moved_px
    self.forget()

  def forget(self) -> None:
    """Begins anew with the next image."""
    self.home = -1
    self._since_s = self._black_s = math.nan
    self._learned = False
    self._moving: list[tuple[float, int]] = []

  def step(self, time_s: float, frame: int) -> list[tuple[float, int]]:
    """Takes an image; once the target has left, all since it began to."""
    if frame < 0:
      if math.isnan(self._black_s):
        self._black_s = time_s
      if elapsed.lasted(self._black_s, time_s, self._forget_s):
        self.forget()
      elif self._moving:
        self._moving.append((time_s, frame))
      return []
    self._black_s = math.nan
    if not self._sight.inside[frame]:
      self.forget()
      return []
    away_px = 0.0
    if self.home >= 0:
      away_px = self._sight.moved_px(frame, self.home)
    if not self._learned:
      if self.home < 0 or away_px > max(self._moved_px, _STILL_PX):
        self.home, self._since_s = frame, time_s
      self._learned = elapsed.lasted(self._since_s, time_s, self._learn_s)
      return []
    if not self._moving and away_px <= _BEGUN_PX:
      return []
    self._moving.append((time_s, frame))
    if away_px < self._moved_px or not any(
      self._sight.moved_px(each, self.home) >= self._moved_px
      for at_s, each in self._moving
      if time_s - at_s > ladder_table.LAG_S - 1e-6 and each >= 0
    ):
      return []
    return self._moving
