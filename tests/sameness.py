"""Whether the incremental camera shows what a full render shows.

Random scenes are changed at random, step by step, in every way in which a
picture can go out of date. After each step the picture of a renderer that
redraws only what changed is set beside that of one that draws everything, and
beside one drawn in a single pass at twice the size and averaged over areas.
"""

from collections.abc import Callable, Iterator, Sequence
import contextlib
import dataclasses
import sys

import cv2
from dm_control import composer, mjcf
import numpy as np

from waggle_tasks import appearance, registry, scenario
from waggle_tasks.entities import crazyflie, renderer
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import camera as camera_lib

MAX_LEVELS = 1  # Most grey levels by which the two may differ.
_PIXELS = camera_lib.Camera.columns * camera_lib.Camera.rows
_MAX_OBSERVERS = 8  # One of them looks at the other vehicles, up to eight.
_STEPS = 20  # Changes of each scene.
_DEPTHS_M = (0.08, 6.0)
_LENS = camera_lib.Camera()
_BEYOND_PX = 60  # How far outside of the picture a vehicle may be.


@dataclasses.dataclass(frozen=True)
class Difference:
  """How two pictures differ.

  Attributes:
    levels: The largest difference of a value, 0 to 255.
    pixels: How many pixels differ at all.
  """

  levels: int
  pixels: int

  @classmethod
  def of(cls, one: np.ndarray, other: np.ndarray) -> 'Difference':
    """The difference of two pictures, (H, W, 3) uint8 each."""
    levels = cv2.absdiff(one, other)
    pixels = cv2.transform(levels, np.ones((1, 3)))  # Sums of their channels.
    return cls(int(levels.max()), int(np.count_nonzero(pixels)))


@dataclasses.dataclass(frozen=True)
class Comparison:
  """One picture, drawn in three ways.

  Attributes:
    change: What was changed before it.
    vehicles: How many vehicles were in the scene beside the one that looks.
    incremental: How the incremental picture differs from the full one.
    single_pass: How the full one differs from the single pass.
  """

  change: str
  vehicles: int
  incremental: Difference
  single_pass: Difference


class _Scene:
  """A random scene, and the ways in which it can change."""

  def __init__(
    self, environment: composer.Environment, rng: np.random.RandomState
  ) -> None:
    self._environment = environment
    self._rng = rng
    task = environment.task
    self._observers = task.observers
    self._vehicles = (task.performer, *task.observers)
    self._others = (task.performer, *task.observers[1:])
    self._eyes = [each.eye for each in task.observers]
    for each in task.observers:  # Drawn here, and not by the environment.
      each.observables.camera.enabled = False
    environment.reset()
    self.physics: mjcf.Physics = environment.physics

  @property
  def cameras(self) -> Sequence[int]:
    """Indices of the observers' cameras."""
    return self.physics.bind(self._eyes).element_id

  def nothing(self) -> None:
    """Changes nothing."""

  def vehicles(self) -> None:
    """Puts some vehicles anywhere in the first camera's view, or near it."""
    for vehicle in self._some(self._others):
      self._put(vehicle, self._pixel(), self._depth_m())

  def crossing(self) -> None:
    """Puts vehicles in front of and behind one another."""
    pixel = self._pixel()
    for vehicle in self._some(self._others):
      aside_px = self._rng.uniform(-15, 15, 2)
      self._put(vehicle, pixel + aside_px, self._depth_m())

  def a_little(self) -> None:
    """Moves some vehicles by less than a pixel or by a few."""
    for vehicle in self._some(self._others):
      self._nudge(vehicle, 10 ** self._rng.uniform(-4, -2))

  def settling(self) -> None:
    """Moves vehicles by hardly anything, as they do when they come to rest."""
    for vehicle in self._vehicles:
      self._nudge(vehicle, 10 ** self._rng.uniform(-9, -5))

  def camera(self) -> None:
    """Moves some observers, and with them their cameras, as in flight."""
    for vehicle in self._some(self._observers):
      self._nudge(vehicle, 10 ** self._rng.uniform(-4, -1))

  def looks(self) -> None:
    """Changes the colour of something, or a light."""
    model = self.physics.model
    if self._rng.rand() < 0.5:
      geom = self._rng.randint(model.ngeom)
      model.geom_rgba[geom, :3] = self._rng.uniform(size=3)
    else:
      light = self._rng.randint(model.nlight)
      model.light_diffuse[light] = self._rng.uniform(0.0, 0.4, size=3)

  def reset(self) -> None:
    """Begins another episode."""
    self._environment.reset()
    self.physics = self._environment.physics

  def _some(
    self, vehicles: Sequence[crazyflie.Crazyflie]
  ) -> list[crazyflie.Crazyflie]:
    chosen = [each for each in vehicles if self._rng.rand() < 0.5]
    return chosen or [vehicles[self._rng.randint(len(vehicles))]]

  def _pixel(self) -> np.ndarray:  # (2,)
    return self._rng.uniform(-_BEYOND_PX, np.array(_LENS.size) + _BEYOND_PX)

  def _depth_m(self) -> float:
    return float(np.exp(self._rng.uniform(*np.log(_DEPTHS_M))))

  def _put(
    self, vehicle: crazyflie.Crazyflie, pixel: np.ndarray, depth_m: float
  ) -> None:
    """Puts a vehicle where the first camera sees a pixel, turned anyhow."""
    eye = self.physics.bind(self._eyes[0])
    x_px, y_px = (pixel - np.array(_LENS.size) / 2) / _LENS.focal_px
    in_eye = np.array([x_px, -y_px, -1.0]) * depth_m
    position_m = eye.xpos + eye.xmat.reshape(3, 3) @ in_eye
    turn = self._rng.normal(size=4)
    vehicle.set_pose(self.physics, position_m, turn / np.linalg.norm(turn))
    self.physics.forward()

  def _nudge(self, vehicle: crazyflie.Crazyflie, size: float) -> None:
    position_m, turn = vehicle.get_pose(self.physics)
    turn = turn + self._rng.normal(size=4) * size
    vehicle.set_pose(
      self.physics,
      position_m + self._rng.normal(size=3) * size,
      turn / np.linalg.norm(turn),
    )
    self.physics.forward()


CHANGES: tuple[Callable[[_Scene], None], ...] = (
  _Scene.vehicles,
  _Scene.crossing,
  _Scene.a_little,
  _Scene.settling,
  _Scene.camera,
  _Scene.looks,
  _Scene.reset,
  _Scene.nothing,
)
_ODDS = (0.2, 0.15, 0.15, 0.2, 0.15, 0.06, 0.04, 0.05)


def compare(
  scenes: int,
  seed: int,
  incremental: type[renderer.Renderer] = renderer.Renderer,
) -> Iterator[Comparison]:
  """Draws random pictures in every way.

  Args:
    scenes: How many scenes; each is changed 20 times, and after each change
      two of its cameras are looked through.
    seed: Of what is random.
    incremental: What draws the incremental pictures.
  """
  rng = np.random.RandomState(seed)
  for number in range(scenes):
    scene = _random_scenario(1 + number % _MAX_OBSERVERS, rng)
    environment = registry.environment(scene)
    with contextlib.closing(environment):
      yield from _compare(_Scene(environment, rng), incremental, rng)


def _compare(
  scene: _Scene,
  incremental: type[renderer.Renderer],
  rng: np.random.RandomState,
) -> Iterator[Comparison]:
  ours, whole = incremental(scene.physics), renderer.Renderer(scene.physics)
  for number in rng.choice(len(CHANGES), size=_STEPS, p=_ODDS):
    change = CHANGES[number]
    change(scene)
    first, *others = scene.cameras
    for camera in [first, *rng.permutation(others)[:1]]:
      picture = ours.image(camera)
      full = whole.image(camera, incremental=False)
      yield Comparison(
        change.__name__,
        len(scene.cameras),
        Difference.of(picture, full),
        Difference.of(full, _single_pass(scene.physics, camera)),
      )


def _random_scenario(
  observers: int, rng: np.random.RandomState
) -> scenario.Scenario:
  return registry.find(
    'broadcast',
    observers=observers,
    half_span_deg=150.0,
    distance_m=rng.uniform(0.8, 2.0),
    seed=int(rng.randint(2**31)),
    jitter_m=0.01,
    appearance=appearance.Appearance(
      floor=str(rng.choice(appearance.FLOORS)), brightness=rng.uniform(0.5, 1.5)
    ),
  )


def _single_pass(physics: mjcf.Physics, camera: int) -> np.ndarray:
  """A picture drawn as a whole at twice the size, averaged over areas."""
  width, height = _LENS.size
  large = physics.render(2 * height, 2 * width, int(camera))
  return cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)


def report(found: Sequence[Comparison]) -> str:
  """How pictures differ, by what was changed before them."""
  header = (
    'changed before', 'pictures', 'not equal', 'pixels', 'grey levels',
    'pixels', 'grey levels',
  )  # fmt: skip
  names = dict.fromkeys(each.change for each in found)
  rows = [
    _row(name.replace('_', ' '), [e for e in found if e.change == name])
    for name in names
  ]
  rows.append(_row('all of them', found))
  worst = worst_levels(found)
  share = sum(e.single_pass.pixels for e in found) / (len(found) * _PIXELS)
  return '\n'.join(
    [
      'Incremental against full render, then full render against a single pass',
      '',
      table.render(header, rows),
      '',
      f'Incremental and full render differ by {worst} grey levels at most in'
      f' {len(found)} pictures:',
      f'{_verdict(worst)}, {MAX_LEVELS} is allowed. {share:.4%} of'
      ' pixels differ from a single pass.',
    ]
  )


def worst_levels(found: Sequence[Comparison]) -> int:
  """The largest difference between incremental and full pictures."""
  return max(each.incremental.levels for each in found)


def _verdict(levels: int) -> str:
  return 'the same' if levels <= MAX_LEVELS else 'NOT the same'


def _row(name: str, found: Sequence[Comparison]) -> Sequence[str]:
  cells = [sum(each.incremental.pixels > 0 for each in found)]
  for kind in ('incremental', 'single_pass'):
    differences = [getattr(each, kind) for each in found]
    cells.append(sum(each.pixels for each in differences))
    cells.append(max(each.levels for each in differences))
  return name, str(len(found)), *map(str, cells)


if __name__ == '__main__':
  sys.stdout.write(f'{report(list(compare(scenes=24, seed=0)))}\n')
