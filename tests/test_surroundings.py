"""Other vehicles, a board, clutter, a sun: seen truly, in nobody's way."""

from collections.abc import Callable, Iterator
import itertools

import cv2
import numpy as np
import pytest

from waggle_tasks import appearance, registry, scenario, suites
from waggle_tasks.arenas import clutter, layouts
from waggle_tasks.entities import bystander, renderer
from waggle_tasks.protocol import reference, timing
from waggle_tasks.tasks import drift, safety, surroundings

Look, Around = appearance.Appearance, surroundings.Surroundings
FAST = timing.Timing(0.2, 0.1, 0.2, 0.1)
DISTURBANCES = {
  'bystanders': {'surroundings': Around(bystanders=4)},
  'occluder': {'surroundings': Around(occluder_every_s=5, occluder_mps=1.0)},
  'clutter': {'appearance': Look(floor='clutter', walls='clutter')},
  'furniture': {'appearance': Look(furniture=3)},
  'fixed sun': {'appearance': Look(sun='fixed')},
  'moving sun': {'appearance': Look(sun='moving')},
  'drift': {'drift': drift.Drift(0.005, 0.005, 0.3)},
  'hover': {
    'drift': drift.Drift(performer_hover='mocap', observer_hover='mocap')
  },
  'all': {
    'drift': drift.Drift(0.005, 0.005, 0.3, observer_hover='lighthouse'),
    'appearance': Look(floor='clutter', walls='clutter', sun='moving'),
    'surroundings': Around(4, 5.0),
  },
}


# What is flown together here, and each of it alone in longer runs.
TOGETHER = [
  name if name == 'all' else pytest.param(name, marks=pytest.mark.long)
  for name in DISTURBANCES
]


def images(
  environment: registry.composer.Environment, frames: int
) -> Iterator[np.ndarray]:
  """The first observer's images while everybody stays; after a reset."""
  timestep = environment.reset()
  hold = [
    reference.Reference.hover(each['position_m']).to_array()
    for each in timestep.observation
  ]
  yield timestep.observation[0]['camera'].copy()
  for _ in range(frames - 1):
    timestep = environment.step(hold)
    yield timestep.observation[0]['camera'].copy()


@pytest.mark.slow
@pytest.mark.parametrize('name', TOGETHER)
def test_both_cameras_see_the_same(name: str, load: Callable) -> None:
  """Over 2.4 s in which the board passes, and shadows and vehicles move."""
  environments = [
    load(
      observers=1,
      camera=camera,
      pauses=FAST,
      seed=4,
      camera_width_px=320,
      camera_height_px=240,
      **DISTURBANCES[name],
    )
    for camera in ('incremental', 'full')
  ]
  worst, frames = 0, 60
  pairs = zip(*(images(each, frames) for each in environments), strict=True)
  first = last = None
  for parts, at_once in pairs:
    worst = max(worst, cv2.absdiff(parts, at_once).max())
    first, last = (parts if first is None else first), parts
  assert worst <= 1
  assert (first != last).any()


@pytest.mark.slow
@pytest.mark.parametrize('name', TOGETHER)
def test_a_picture_kept_up_to_date_is_one_drawn_anew(
  name: str, load: Callable
) -> None:
  environment = load(observers=1, pauses=FAST, **DISTURBANCES[name])
  *_, last = images(environment, 30)
  physics = environment.physics
  camera = physics.model.name2id('observer_1/eye', 'camera')
  anew = renderer.Renderer(physics).image(camera)
  # What is at rest is shown where it came to rest, a millionth of a metre off.
  assert np.count_nonzero(cv2.absdiff(last, anew) > 1) < 60


@pytest.fixture(scope='module')
def usual() -> list[np.ndarray]:
  """2.4 s without a disturbance."""
  environment = registry.load('broadcast', observers=1, pauses=FAST)
  seen = [*images(environment, 60)]
  environment.close()
  return seen


@pytest.mark.slow
@pytest.mark.parametrize('name', [*DISTURBANCES][:-1])
def test_each_disturbance_shows(
  name: str, load: Callable, usual: list[np.ndarray]
) -> None:
  other = load(observers=1, pauses=FAST, **DISTURBANCES[name])
  pairs = zip(usual, images(other, len(usual)), strict=True)
  assert max(np.count_nonzero(a != b) for a, b in pairs) > 300


def test_by_default_nothing_is_there(load: Callable) -> None:
  model = load(observers=1, cameras=False).physics.model
  assert model.nmocap == 0
  assert model.ntex == 0
  assert model.nlight == 3


@pytest.mark.slow
@pytest.mark.parametrize('seed', range(8))
def test_bystanders_are_in_nobodys_way(seed: int) -> None:
  flyers = _bystanders(seed)
  times_s = np.arange(0, 60, 0.1)
  ways_m = [np.stack([f.place_m(t) for t in times_s]) for f in flyers]
  for one, other in itertools.combinations(ways_m, 2):
    nearest_m = np.linalg.norm(one - other, axis=1).min()
    assert nearest_m > safety.MINIMUM_SPACING_M
  for way_m in ways_m:
    assert way_m[:, 1].min() > 0.9
    assert way_m[:, 1].max() < 1.7
    assert way_m[:, 2].min() > 0.8
    speed_mps = np.linalg.norm(np.diff(way_m, axis=0), axis=1) / 0.1
    assert speed_mps.max() < 0.75
    assert speed_mps.min() < 1e-3  # It rests now and then.


def _bystanders(seed: int) -> list[bystander.Bystander]:
  environment = registry.load(
    'broadcast', observers=1, seed=seed, surroundings=Around(bystanders=4)
  )
  environment.task.observers[0].observables.camera.enabled = False
  environment.reset()
  flyers = [
    each
    for each in environment.task.root_entity.iter_entities()
    if isinstance(each, bystander.Bystander)
  ]
  assert len(flyers) == 4
  environment.close()
  return flyers


@pytest.mark.slow
def test_bystanders_differ_by_seed() -> None:
  places = [_bystanders(seed)[0].place_m(5.0) for seed in (1, 1, 2)]
  np.testing.assert_array_equal(places[0], places[1])
  assert np.linalg.norm(places[0] - places[2]) > 0.01


@pytest.mark.slow
def test_nothing_touches_anything(load: Callable, episode: Callable) -> None:
  environment = load(
    'random_walk',
    cameras=False,
    observers=3,
    surroundings=Around(4, 5.0),
    duration_s=30.0,
  )
  homes = environment.reset().observation
  hold = [
    reference.Reference.hover(each['position_m']).to_array() for each in homes
  ]
  discounts = [
    timestep.discount for timestep in episode(environment, lambda _: hold)
  ]
  assert discounts[1:] == [1.0] * 750


@pytest.mark.slow
@pytest.mark.parametrize(
  'changes',
  [{}, {'half_span_deg': 75.0}, {'distance_m': 0.6}, {'bearing_deg': 120.0}],
)
def test_a_board_passes_every_observer_and_runs_into_none(
  changes: dict[str, float], load: Callable
) -> None:
  scene = registry.find(
    'broadcast', surroundings=Around(occluder_every_s=20.0), **changes
  )
  environment = registry.environment(scene)
  for each in environment.task.observers:
    each.observables.camera.enabled = False
  environment.reset()
  (board,) = (
    each
    for each in environment.task.root_entity.iter_entities()
    if each.mjcf_model.model == 'occluder'
  )
  way_m = np.array([board.place(t)[:2] for t in np.arange(0, 100, 0.04)])
  environment.close()
  assert np.linalg.norm(way_m, axis=1).min() > 0.44  # Around the dance.
  steps_m = np.linalg.norm(np.diff(way_m, axis=0), axis=1)
  assert steps_m.max() < 0.5 * 0.04 + 1e-9  # It never jumps.
  for name, pose in scene.poses().items():
    if name == 'performer':
      continue
    place_m = np.array(pose.position_m[:2])
    assert np.linalg.norm(way_m - place_m, axis=1).min() > 0.1
    toward = place_m / np.linalg.norm(place_m)
    along_m, aside_m = way_m @ toward, way_m @ (-toward[1], toward[0])
    between = (np.abs(aside_m) < 0.02) & (along_m > 0)
    assert between.sum() >= 3
    assert (along_m[between] < np.linalg.norm(place_m)).all()


@pytest.mark.slow
def test_a_board_hides_the_performer(load: Callable) -> None:
  environment = load(
    observers=1,
    pauses=timing.Timing(initial_hover_s=60),
    surroundings=Around(occluder_every_s=5.0, occluder_width_m=0.3),
  )
  usual = load(observers=1, pauses=timing.Timing(initial_hover_s=60))
  (clear,) = images(usual, 1)
  spot = np.s_[225:255, 295:345]
  same = [
    (image[spot] == clear[spot]).mean() for image in images(environment, 130)
  ]
  assert max(same) == 1
  assert min(same) < 0.05


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'bystanders': 5}, '`bystanders` must be between 0 and 4: got 5'),
    ({'bystanders': 1.0}, '`bystanders` must be an integer: got 1.0'),
    ({'occluder_every_s': 1.0}, '`occluder_every_s` must be between 5 and 600'),
    ({'occluder_every_s': -1}, '`occluder_every_s` must be between 5 and 600'),
    ({'occluder_width_m': 0.0}, '`occluder_width_m` must be between 0.02 and'),
    ({'occluder_mps': 3.0}, '`occluder_mps` must be between 0.1 and 2'),
  ],
)
def test_surroundings_that_cannot_be_are_refused(
  changes: dict[str, object], error: str
) -> None:
  with pytest.raises(surroundings.SurroundingsError, match=error):
    Around(**changes)


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    (
      {'half_span_deg': 120, 'surroundings': Around(bystanders=1)},
      '`bystanders` must have the room behind the performer: observer_1 can'
      ' come 1.25 m behind it, over 0.80 m',
    ),
    (
      {'half_span_deg': 120, 'surroundings': Around(0, 30.0)},
      '`occluder_every_s` must be 0 for observers more than 90 degrees',
    ),
    (
      {'distance_m': 0.5, 'observers': 1, 'surroundings': Around(0, 30.0)},
      '`occluder_every_s` must be 0 for observers nearer than 0.55 m: got 0.50',
    ),
  ],
)
def test_vehicles_in_the_way_are_refused(
  changes: dict[str, object], error: str
) -> None:
  with pytest.raises(surroundings.SurroundingsError, match=error):
    scenario.Scenario(**changes)


def test_surroundings_turn_with_the_audience() -> None:
  poses = {'performer': layouts.performer_pose()}
  places = layouts.Arc(1.3, 0.5, 2.0).poses(3)
  for name, pose in zip('abc', places, strict=True):
    poses[name] = pose
  audience = surroundings.Audience.of(poses)
  assert audience.bearing_rad == pytest.approx(2.0)
  assert audience.half_span_rad == pytest.approx(0.5)
  assert audience.nearest_m == pytest.approx(1.3)
  middle = np.array(poses['b'].position_m[:2]) / 1.3
  np.testing.assert_allclose(
    audience.place_m(0.0, 1.0, 2.0), [*-middle, 2.0], atol=1e-9
  )


def test_a_suite_may_ask_for_all_of_it() -> None:
  (case,) = suites.from_rows(
    [
      {
        'name': 'busy',
        'surroundings': {'bystanders': 2, 'occluder_every_s': 20},
        'appearance': {'floor': 'clutter', 'sun': 'moving'},
      }
    ]
  )
  assert case.scene.surroundings == Around(2, 20)
  assert case.scene.appearance.sun == 'moving'


def test_clutter_is_the_same_each_time_and_has_no_seam() -> None:
  pixels = clutter.texture(256).astype(int)
  np.testing.assert_array_equal(pixels, clutter.texture(256))
  assert pixels.std() > 35
  for axis in (0, 1):
    inside = np.abs(np.diff(pixels, axis=axis)).mean()
    first, last = np.take(pixels, 0, axis), np.take(pixels, -1, axis)
    assert np.abs(first - last).mean() < 3 * inside


@pytest.mark.slow
def test_shadows_lie_on_the_floor_along_the_light(load: Callable) -> None:
  environment = load(
    observers=1, cameras=False, pauses=FAST, appearance=Look(sun='moving')
  )
  (begin,) = environment.reset().observation
  hold = [reference.Reference.hover(begin['position_m']).to_array()]
  data, directions = environment.physics.named.data, []
  for _ in range(150):
    environment.step(hold)
    data = environment.physics.named.data
    directions.append(data.light_xdir['sun'].copy())
    for name in ('performer', 'observer_1'):
      vehicle_m = data.xpos[f'{name}/airframe']
      way_m = data.xpos[f'shadow_{name}'] - vehicle_m
      assert data.xpos[f'shadow_{name}'][2] < 0.01
      way_m = way_m / np.linalg.norm(way_m)
      np.testing.assert_allclose(way_m, directions[-1], atol=2e-3)
  turned_rad = np.arccos(directions[0] @ directions[-1])
  assert turned_rad > 0.02


@pytest.mark.slow
@pytest.mark.parametrize('name', ['bystanders', 'occluder', 'clutter', 'all'])
def test_pictures_are_those_that_mujoco_draws(
  name: str, load: Callable
) -> None:
  environment = load(observers=1, pauses=FAST, **DISTURBANCES[name])
  *_, image = images(environment, 50)
  physics, size = environment.physics, (480, 640)
  camera = physics.model.name2id('observer_1/eye', 'camera')
  samples = physics.render(2 * size[0], 2 * size[1], camera_id=camera)
  grid = samples.reshape(size[0], 2, size[1], 2, 3)
  levels = np.abs(image - grid.mean(axis=(1, 3))).max(axis=2)
  assert np.count_nonzero(levels > 1.5) < 2e-4 * levels.size
