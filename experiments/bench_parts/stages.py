"""Where the loop's time goes: public calls, timed from outside.

While a broadcast is measured, and in that process only, the calls of `STAGES`
are replaced by ones that tell a clock which stage begins and ends. A stage
inside another is not counted twice.
"""

import collections
from collections.abc import Callable, Iterator
import contextlib
import dataclasses
import functools

import cv2
from dm_control import mjcf
from dm_control.composer.observation import updater

from waggle_tasks import scenario
from waggle_tasks.agents import image_chain, navigator, receivers
from waggle_tasks.entities import renderer
from waggle_tasks.experiments.bench_parts import loops, processes
from waggle_tasks.experiments.record import episode
from waggle_tasks.tasks import broadcast

OTHER = 'other'
_RECEIVER = receivers.RECEIVERS[loops.RECEIVER]
_READING = 'receiver: rest'


@dataclasses.dataclass(frozen=True)
class Call:
  """A public call and the stage that it is.

  Attributes:
    owner: The class or module that it is looked up in.
    name: Its name there.
    stage: What it is counted as.
    inside: Only counted so inside of this stage, if not empty.
  """

  owner: object
  name: str
  stage: str
  inside: str = ''


STAGES = (
  Call(broadcast.Broadcast, 'before_step', 'task: references and checks'),
  Call(broadcast.Broadcast, 'after_step', 'task: references and checks'),
  Call(mjcf.Physics, 'step', 'physics'),
  Call(renderer.Renderer, 'image', 'rendering'),
  Call(updater.Updater, 'prepare_for_next_control_step', 'observation copies'),
  Call(updater.Updater, 'update', 'observation copies'),
  Call(updater.Updater, 'get_observation', 'observation copies'),
  Call(image_chain.Chain, 'add', 'provenance hash'),
  Call(_RECEIVER, 'step', _READING),
  Call(cv2, 'cvtColor', 'receiver: grey', _READING),
  Call(cv2, 'calcOpticalFlowPyrLK', 'receiver: optical flow', _READING),
  Call(cv2, 'goodFeaturesToTrack', 'receiver: features', _READING),
  Call(navigator.Navigator, 'step', 'navigator'),
)


class Timer:
  """Counts seconds for the stage that runs now, and for that one alone.

  As an onlooker of a rollout it begins with the first step and ends with the
  last.
  """

  def __init__(self, clock: processes.Clock) -> None:
    """Makes a timer.

    Args:
      clock: What it reads.
    """
    self._clock = clock
    self.seconds: dict[str, float] = collections.defaultdict(float)
    self.steps = 0
    self._stage = OTHER
    self._since_s = 0.0

  def __call__(self, step: episode.Step) -> None:
    """Takes a time step."""
    self._enter(OTHER)
    if step.timestep.first():
      self.seconds.clear()
    else:
      self.steps += 1

  def _enter(self, stage: str) -> str:
    """Begins a stage and returns the one before."""
    now_s = self._clock()
    self.seconds[self._stage] += now_s - self._since_s
    before, self._stage, self._since_s = self._stage, stage, now_s
    return before

  def timed(self, function: Callable, stage: str, inside: str) -> Callable:
    """The same function, counted as a stage."""

    @functools.wraps(function)
    def call(*arguments: object, **named: object) -> object:
      if inside and self._stage != inside:
        return function(*arguments, **named)
      before = self._enter(stage)
      try:
        return function(*arguments, **named)
      finally:
        self._enter(before)

    return call

  @contextlib.contextmanager
  def watching(self) -> Iterator[None]:
    """Times the calls of `STAGES` in this process."""
    with contextlib.ExitStack() as undo:
      for each in STAGES:
        own = vars(each.owner).get(each.name)
        if own is None:  # It is inherited.
          undo.callback(delattr, each.owner, each.name)
        else:
          undo.callback(setattr, each.owner, each.name, own)
        function = getattr(each.owner, each.name)
        timed = self.timed(function, each.stage, each.inside)
        setattr(each.owner, each.name, timed)
      yield


def measure(
  scene: scenario.Scenario, repeats: int, clock: processes.Clock
) -> list[dict[str, float]]:
  """Seconds for each receiver and frame of a broadcast, by stage.

  Returns:
    For each repeat the stages in the order of `STAGES`, and the rest.
  """
  loops.run(loops.two_frames(scene))
  names = dict.fromkeys([*(each.stage for each in STAGES), OTHER])
  out = []
  for _ in range(repeats):
    timer = Timer(clock)
    with timer.watching():
      loops.run(scene, clock, [timer])
    count = timer.steps * scene.observers
    out.append({name: timer.seconds[name] / count for name in names})
  return out
