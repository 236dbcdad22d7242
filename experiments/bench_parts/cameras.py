"""One image of an observer's camera: the stock observable's, and ours.

Every camera draws the same flight in a Physics of its own, in turns: a stretch
of the flight with one, then with the next, so that a machine that grows faster
or slower does so for all.
"""

from collections.abc import Callable, Iterator, Mapping
import contextlib
import dataclasses

from dm_control import mjcf
from dm_control.composer.observation import observable
import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.agents import config, navigator
from waggle_tasks.entities import observer
from waggle_tasks.experiments.bench_parts import processes
from waggle_tasks.tasks import broadcast

STOCK = 'stock'
STOCK_PLAIN = 'stock, no shadows or multisampling'
FULL = 'full'
INCREMENTAL = 'incremental'
MOVES, RESTS, FLIES = 'performer moves', 'all rest', 'observers fly'
PHASES = (MOVES, RESTS, FLIES)

_STRETCHES = 12
# MuJoCo's defaults (XML reference, visual/quality and visual/global).
_STOCK_SAMPLES, _STOCK_BUFFER_PX = 4, (640, 480)
# What moves less in a frame, in m or parts of a unit quaternion, rests.
_STILL = 1e-6


@dataclasses.dataclass(frozen=True)
class Cameras:
  """Seconds for one image.

  Attributes:
    mean_s: By camera, for each repeat: the mean over the flight.
    phase_s: By phase, for each repeat: the incremental camera's mean.
    share: By phase, its share of the flight's frames.
    images: By camera, how many images a mean is made from.
  """

  mean_s: dict[str, list[float]]
  phase_s: dict[str, list[float]]
  share: dict[str, float]
  images: dict[str, int]


@dataclasses.dataclass(frozen=True, eq=False)
class FlownBroadcast:
  """A broadcast as it was flown.

  Attributes:
    qpos: (T, nq) positions of everything, frame by frame.
    phases: For each frame which of `PHASES` it belongs to.
  """

  qpos: np.ndarray
  phases: tuple[str, ...]


def fly(scene: scenario.Scenario) -> FlownBroadcast:
  """Flies a broadcast without images; observers follow it all the same."""
  environment = registry.environment(scene)
  task, qpos = environment.task, []
  for each in task.observers:
    each.observables.camera.enabled = False
  pilots = [navigator.Navigator(scene.agreement) for _ in task.observers]
  command = navigator.Command(scene.message, 'what was sent')
  release = scene.agreement.frames(
    scene.performance.end_s + config.Config().stillness.hold_s
  )
  with contextlib.closing(environment):
    timestep = environment.reset()
    while True:
      qpos.append(environment.physics.data.qpos.copy())
      if timestep.last():
        break
      action = []
      for pilot, seen in zip(pilots, timestep.observation, strict=True):
        position_m, time_s = seen['position_m'], float(seen['time_s'])
        if len(qpos) - 1 == release:
          pilot.accept(command, position_m, time_s)
        action.append(pilot.step(position_m, time_s).to_array())
      timestep = environment.step(action)
  whole = np.stack(qpos)
  return FlownBroadcast(whole, tuple(_phases(whole)))


def _phases(qpos: np.ndarray) -> Iterator[str]:
  """The phase of each frame of (T, 7 N) positions, the performer's first."""
  change = np.abs(np.diff(qpos, axis=0, prepend=qpos[:1]))
  moving = change.reshape(len(qpos), -1, 7).max(axis=2) > _STILL  # (T, N)
  for performer, *observers in moving:
    yield FLIES if any(observers) else MOVES if performer else RESTS


class _Studio:
  """A Physics of its own, with one kind of camera for every observer."""

  def __init__(
    self,
    task: broadcast.Broadcast,
    camera: Callable[[observer.Observer], observable.Observable],
    clock: processes.Clock,
  ) -> None:
    self._clock, self._frame_s = clock, task.agreement.frame_s
    self._physics = mjcf.Physics.from_mjcf_model(task.root_entity.mjcf_model)
    self._draw = [
      camera(each).observation_callable(self._physics)
      for each in task.observers
    ]

  def draw(self, qpos: np.ndarray) -> float:
    """Draws an image for every observer; returns the seconds of one."""
    data = self._physics.data
    data.qpos[:] = qpos
    data.time += self._frame_s
    self._physics.forward()
    begin_s = self._clock()
    for draw in self._draw:
      draw()
    return (self._clock() - begin_s) / len(self._draw)

  def close(self) -> None:
    """Frees the Physics and its GL context."""
    self._physics.free()


def _stock(
  scene: scenario.Scenario, clock: processes.Clock, shadows: bool, samples: int
) -> _Studio:
  look = dataclasses.replace(scene.appearance, shadows=shadows)
  task = registry.build(dataclasses.replace(scene, appearance=look))
  visual = task.root_entity.mjcf_model.visual
  visual.quality.offsamples = samples
  width_px, height_px = _STOCK_BUFFER_PX
  getattr(visual, 'global').set_attributes(
    offwidth=width_px, offheight=height_px
  )
  return _Studio(
    task,
    lambda each: observable.MJCFCamera(each.eye, height_px, width_px),
    clock,
  )


def _ours(
  scene: scenario.Scenario, clock: processes.Clock, camera: str
) -> _Studio:
  task = registry.build(dataclasses.replace(scene, camera=camera))
  return _Studio(task, lambda each: each.observables.camera, clock)


def measure(
  scene: scenario.Scenario, repeats: int, clock: processes.Clock
) -> Cameras:
  """Draws one broadcast with every camera.

  The incremental camera draws all of its frames, the others one of each
  stretch, as their images all take alike.

  Args:
    scene: The scenario.
    repeats: How often.
    clock: What images are measured by.
  """
  flight = fly(scene)
  with contextlib.ExitStack() as stack:
    studios = {
      STOCK: _stock(scene, clock, shadows=True, samples=_STOCK_SAMPLES),
      STOCK_PLAIN: _stock(scene, clock, shadows=False, samples=0),
      FULL: _ours(scene, clock, 'full'),
      INCREMENTAL: _ours(scene, clock, 'incremental'),
    }
    for studio in studios.values():
      stack.callback(studio.close)
      studio.draw(flight.qpos[0])  # A first image takes longer.
    passes = [_draw_flight(studios, flight) for _ in range(repeats)]
  phases = np.array(flight.phases)
  ours = [np.array(spent[INCREMENTAL]) for spent in passes]
  present = [phase for phase in PHASES if phase in flight.phases]
  return Cameras(
    {name: [float(np.mean(s[name])) for s in passes] for name in studios},
    {p: [float(s[phases == p].mean()) for s in ours] for p in present},
    {phase: float(np.mean(phases == phase)) for phase in present},
    {n: len(s) * scene.observers for n, s in passes[0].items()},
  )


def _draw_flight(
  studios: Mapping[str, _Studio], flight: FlownBroadcast
) -> dict[str, list[float]]:
  """Seconds for an image, by camera, of each frame that it drew."""
  spent: dict[str, list[float]] = {name: [] for name in studios}
  stretches = min(_STRETCHES, len(flight.qpos))
  for stretch in np.array_split(flight.qpos, stretches):
    for name, studio in studios.items():
      middle = len(stretch) // 2
      frames = stretch if name == INCREMENTAL else stretch[middle : middle + 1]
      spent[name] += [studio.draw(qpos) for qpos in frames]
  return spent
