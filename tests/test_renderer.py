"""Pictures drawn in parts are the pictures that are drawn at once."""

from collections.abc import Callable, Iterator
import itertools
import math

from dm_control import mjcf
import mujoco
import numpy as np
import pytest

from waggle_tasks import appearance
from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import observer, performer, renderer

WIDTH, HEIGHT = 640, 480
WHOLE_PX = WIDTH * HEIGHT
LEVEL = (1.0, 0.0, 0.0, 0.0)


class Studio:
  """Vehicles in a room, the first of them the performer, and two renderers.

  One draws what has changed; the other always draws everything.
  """

  def __init__(
    self, vehicles: int, look: appearance.Appearance | None = None
  ) -> None:
    room = flight_room.FlightRoom(look)
    observers = range(1, vehicles)
    flyers = [performer.Performer()]
    flyers += [observer.Observer(f'observer_{i}') for i in observers]
    poses = [layouts.performer_pose()]
    if vehicles > 1:
      poses += layouts.Arc(1.3, 1.0).poses(vehicles - 1)
    joints = [
      room.add_vehicle(flyer, pose).freejoint
      for flyer, pose in zip(flyers, poses, strict=True)
    ]
    self.physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
    self._joints = joints
    self._parts = renderer.Renderer(self.physics)
    self._at_once = renderer.Renderer(self.physics)

  def camera(self, name: str = 'observer_1/eye') -> int:
    return self.physics.model.name2id(name, 'camera')

  def place(
    self, vehicle: int, position_m: np.ndarray, quat: tuple[float, ...] = LEVEL
  ) -> None:
    self.physics.bind(self._joints[vehicle]).qpos = [*position_m, *quat]
    self.physics.forward()

  def place_before(
    self, vehicle: int, offset_m: tuple[float, float, float], turn: np.ndarray
  ) -> None:
    """Puts a vehicle right, up and ahead of the first observer's eye."""
    data, camera = self.physics.data, self.camera()
    right, up, ahead = offset_m
    away = data.cam_xmat[camera].reshape(3, 3) @ (right, up, -ahead)
    self.place(vehicle, data.cam_xpos[camera] + away, tuple(turn))

  def image(self, camera: int) -> np.ndarray:
    """A copy of the picture, where only what changed was drawn."""
    return self._parts.image(camera).copy()

  def full(self, camera: int) -> np.ndarray:
    return self._at_once.image(camera, incremental=False).copy()

  def anew(self, camera: int) -> np.ndarray:
    """A picture by a renderer that has drawn nothing before."""
    return renderer.Renderer(self.physics).image(camera).copy()

  def differing_px(self, camera: int) -> int:
    """Pixels that differ from MuJoCo's own picture, drawn at twice the size.

    Rounding may put a sample on the other side of a triangle's edge.
    """
    samples = self.physics.render(2 * HEIGHT, 2 * WIDTH, camera_id=camera)
    grid = samples.reshape(HEIGHT, 2, WIDTH, 2, 3)
    levels = np.abs(self.image(camera) - grid.mean(axis=(1, 3)))
    return np.count_nonzero(levels.max(axis=2) > 1.5)


@pytest.fixture
def studio() -> Iterator[Callable[..., Studio]]:
  made = []

  def make(*arguments: object) -> Studio:
    made.append(Studio(*arguments))
    return made[-1]

  yield make
  for each in made:
    each.physics.free()


@pytest.fixture
def drawn_px(monkeypatch: pytest.MonkeyPatch) -> list[int]:
  """The pixels of a picture that each drawing covered, as they happen."""
  areas, render = [], mujoco.mjr_render

  def spy(area: mujoco.MjrRect, *rest: object) -> None:
    areas.append(area.width * area.height // 4)  # 2 x 2 samples each.
    render(area, *rest)

  monkeypatch.setattr(mujoco, 'mjr_render', spy)
  return areas


def random_turn(rng: np.random.RandomState) -> np.ndarray:  # (4,)
  if rng.rand() < 0.5:
    return np.array(LEVEL)
  turn = rng.normal(size=4)
  return turn / np.linalg.norm(turn)


@pytest.mark.slow
@pytest.mark.parametrize('vehicles', [2, 3, 5, 8])
def test_pictures_in_parts_equal_pictures_at_once(
  vehicles: int, studio: Callable[..., Studio]
) -> None:
  """Near and far, crossing, in and out of view, moving and at rest."""
  stage, rng = studio(vehicles), np.random.RandomState(vehicles)
  cameras = [stage.camera(), stage.camera('overview')]
  for _ in range(12):
    for vehicle in {*range(vehicles)} - {1}:
      if rng.rand() < 0.5:
        continue  # It rests.
      ahead_m = math.exp(rng.uniform(math.log(0.1), math.log(4)))
      right_m, up_m = ahead_m * rng.uniform(-1, 1, 2) * (0.9, 0.7)
      stage.place_before(vehicle, (right_m, up_m, ahead_m), random_turn(rng))
    if rng.rand() < 0.2:  # The eye moves, and then it rests.
      place_m = np.array([rng.uniform(-1, 1), -1.5, 1.3])
      stage.place(1, place_m, (math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    for camera in cameras:
      np.testing.assert_array_equal(stage.image(camera), stage.full(camera))


@pytest.mark.parametrize('vehicles', [1, 2, 5])
def test_pictures_are_those_that_mujoco_draws(
  vehicles: int, studio: Callable[..., Studio]
) -> None:
  stage = studio(vehicles)
  names = ['top', 'overview', 'performer_view']
  names += ['observer_1/eye'] if vehicles > 1 else []
  for name in names:
    camera = stage.camera(name)
    assert stage.differing_px(camera) <= WHOLE_PX * 1e-4


def test_nothing_is_drawn_while_nothing_changes(
  studio: Callable[..., Studio], drawn_px: list[int]
) -> None:
  stage = studio(3)
  eye, overview = stage.camera(), stage.camera('overview')
  first = stage.image(eye), stage.image(overview)
  assert sum(drawn_px) >= 2 * WHOLE_PX
  del drawn_px[:]
  for _ in range(5):
    stage.physics.forward()
    np.testing.assert_array_equal(stage.image(eye), first[0])
    np.testing.assert_array_equal(stage.image(overview), first[1])
  assert drawn_px == []


def test_only_what_moves_is_drawn(
  studio: Callable[..., Studio], drawn_px: list[int]
) -> None:
  stage = studio(3)
  eye = stage.camera()
  before = stage.image(eye)
  del drawn_px[:]
  stage.place(0, np.array([0.1, 0.0, 1.4]))
  after = stage.image(eye)
  assert 0 < sum(drawn_px) < WHOLE_PX / 20
  assert (before != after).any()


def test_motions_of_a_fraction_of_a_pixel_are_seen(
  studio: Callable[..., Studio],
) -> None:
  stage = studio(2)
  eye = stage.camera()
  pictures = []
  for step in range(12):
    stage.place(0, np.array([2e-4 * step, 0.0, 1.3 + 1e-4 * step]))
    pictures.append(stage.image(eye))
    np.testing.assert_array_equal(pictures[-1], stage.full(eye))
  assert all((a != b).any() for a, b in itertools.pairwise(pictures))


def test_what_is_out_of_view_is_not_drawn(
  studio: Callable[..., Studio], drawn_px: list[int]
) -> None:
  stage = studio(2)
  eye = stage.camera()
  before = stage.image(eye)
  stage.place(0, np.array([0.0, -3.0, 1.3]))  # Behind the observer.
  stage.image(eye)
  del drawn_px[:]
  stage.place(0, np.array([0.2, -3.0, 1.3]))
  after = stage.image(eye)
  assert drawn_px == []
  assert (before != after).any()
  np.testing.assert_array_equal(after, stage.full(eye))


@pytest.mark.slow
@pytest.mark.parametrize(
  ('offset_m', 'name'),
  [
    ((0.0, 0.0, 0.05), 'on the lens'),
    ((0.0, 0.0, 0.12), 'filling the picture'),
    ((0.06, 0.04, 0.08), 'half beside the lens'),
    ((0.75, 0.0, 1.0), 'over the right edge'),
    ((-0.4, 0.55, 1.0), 'over the upper edge'),
    ((0.0, 0.0, -0.05), 'around the lens, from behind'),
  ],
)
def test_a_vehicle_very_near_or_over_the_edge_leaves_no_trace(
  offset_m: tuple[float, float, float],
  name: str,
  studio: Callable[..., Studio],
) -> None:
  stage = studio(2)
  eye = stage.camera()
  far = (0.0, 0.0, 1.3)
  stage.place_before(0, far, np.array(LEVEL))
  first = stage.image(eye)
  stage.place_before(0, offset_m, np.array(LEVEL))
  np.testing.assert_array_equal(stage.image(eye), stage.full(eye), name)
  stage.place_before(0, far, np.array(LEVEL))
  np.testing.assert_array_equal(stage.image(eye), first, name)


@pytest.mark.slow
def test_vehicles_that_cross_hide_each_other(
  studio: Callable[..., Studio],
) -> None:
  stage = studio(4)
  eye = stage.camera()
  for step in range(9):
    along_m = 0.2 - 0.05 * step
    level = np.array(LEVEL)
    stage.place_before(0, (along_m, 0.0, 1.3), level)
    stage.place_before(2, (-along_m, 0.01, 0.9), level)
    stage.place_before(3, (0.0, along_m, 1.1), level)
    np.testing.assert_array_equal(stage.image(eye), stage.full(eye))


def test_two_cameras_keep_their_own_pictures(
  studio: Callable[..., Studio],
) -> None:
  stage = studio(3)
  eyes = [stage.camera(f'observer_{i}/eye') for i in (1, 2)]
  for step in range(6):
    stage.place(0, np.array([0.05 * step, 0.0, 1.3]))
    # The second camera looks only now and then.
    for eye in eyes[: 1 + (step % 3 == 2)]:
      np.testing.assert_array_equal(stage.image(eye), stage.full(eye))
  assert (stage.image(eyes[0]) != stage.image(eyes[1])).any()


@pytest.mark.slow
@pytest.mark.parametrize(
  ('field', 'element', 'value'),
  [
    ('geom_rgba', 'wall', (0.8, 0.2, 0.2, 1.0)),
    ('geom_pos', 'wall', (0.3, 0.0, 0.0)),
    ('light_diffuse', 'key', (0.1, 0.1, 0.1)),
    ('light_ambient', 'fill', (0.2, 0.0, 0.0)),
    ('light_active', 'key', 0),
    ('light_dir', 'key', (1.0, 0.0, -0.2)),
    ('cam_fovy', 'observer_1/eye', 40.0),
  ],
)
def test_a_room_that_changes_its_look_is_drawn_anew(
  field: str, element: str, value: object, studio: Callable[..., Studio]
) -> None:
  stage = studio(2)
  eye = stage.camera()
  before = stage.image(eye)
  getattr(stage.physics.named.model, field)[element] = value
  stage.physics.forward()
  after = stage.image(eye)
  assert (after != before).any()
  np.testing.assert_array_equal(after, stage.anew(eye))


def test_a_headlight_that_changes_is_seen(
  studio: Callable[..., Studio],
) -> None:
  stage = studio(2)
  eye = stage.camera()
  before = stage.image(eye)
  stage.physics.model.vis.headlight.ambient[:] = 0.2
  after = stage.image(eye)
  assert after.mean() < before.mean() - 10
  np.testing.assert_array_equal(after, stage.anew(eye))


def test_a_reset_brings_the_first_picture_back(
  studio: Callable[..., Studio],
) -> None:
  stage = studio(3)
  eye = stage.camera()
  first = stage.image(eye)
  for step in range(5):
    stage.place(0, np.array([0.1 * step, 0.0, 1.3]))
    stage.place(1, np.array([-0.5, -1.2 - 0.1 * step, 1.3]))
    moved = stage.image(eye)
  assert (moved != first).any()
  stage.physics.reset()
  stage.physics.forward()
  np.testing.assert_array_equal(stage.image(eye), first)


@pytest.mark.parametrize('size', [(640, 480), (1280, 959), (1279, 960)])
def test_a_buffer_that_is_too_small_is_said_so(size: tuple[int, int]) -> None:
  room = flight_room.FlightRoom()
  getattr(room.mjcf_model.visual, 'global').set_attributes(
    offwidth=size[0], offheight=size[1]
  )
  physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
  error = (
    '`offwidth` and `offheight` must be at least 1280 and 960:'
    rf' got \({size[0]}, {size[1]}\)'
  )
  with pytest.raises(ValueError, match=error):
    renderer.Renderer(physics)
  physics.free()
