"""What an observer's eye delivers, and what can spoil it."""

from collections.abc import Callable
import itertools
import math

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import appearance
from waggle_tasks.entities import eye
from waggle_tasks.protocol import gestures, timing

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]
Film = Callable[[composer.Environment], np.ndarray]


@pytest.fixture
def dancing(load: Load) -> Load:
  """Makes environments of 0.4 s in which the performer moves at once."""

  def make(**changes: object) -> composer.Environment:
    at_once = {
      'codebook': gestures.v_codebook(0.1, 0.3, duration_s=0.8),
      'pauses': timing.Timing(0.0, 0.0, 0.0, 0.0),
      'duration_s': 0.4,
      'observers': 2,
    }
    return load('broadcast', **(at_once | changes))

  return make


@pytest.fixture
def film(episode: Fixture, hover: Fixture) -> Film:
  """All images of an episode: (observers, T, 480, 640, 3)."""

  def run(environment: composer.Environment) -> np.ndarray:
    steps = [
      [each['camera'].copy() for each in timestep.observation]
      for timestep in episode(environment, hover)
    ]
    return np.stack(steps, axis=1)

  return run


def test_there_is_one_new_image_every_0_04_s(dancing: Load, film: Film) -> None:
  images = film(dancing())
  assert images.shape == (2, 11, 480, 640, 3)
  for each in images:
    later = each[2:]  # The dance begins slowly.
    assert all((a != b).any() for a, b in itertools.pairwise(later))


def test_an_image_that_is_kept_does_not_change(
  dancing: Load, episode: Fixture, hover: Fixture
) -> None:
  kept, copies = [], []
  for timestep in episode(dancing(), hover):
    kept += [each['camera'] for each in timestep.observation]
    copies += [each['camera'].copy() for each in timestep.observation]
  np.testing.assert_array_equal(np.stack(kept), np.stack(copies))


def test_both_cameras_give_the_same_picture(dancing: Load, film: Film) -> None:
  np.testing.assert_array_equal(
    film(dancing(camera='incremental')), film(dancing(camera='full'))
  )


@pytest.mark.parametrize('observers', [1, 3])
def test_the_performance_area_is_in_the_middle_of_each_image(
  observers: int, load: Load
) -> None:
  environment = load('no_send', observers=observers)
  seen = [o['camera'].copy() for o in environment.reset().observation]
  physics, task = environment.physics, environment.task
  task.performer.set_pose(physics, np.array([0.0, 0.0, 6.0]))
  physics.forward()
  for index, image in enumerate(seen):
    empty = task.observables[index]['camera'](physics)
    rows, columns = np.nonzero((empty != image).any(axis=2))
    assert len(rows) > 100
    assert columns.mean() == pytest.approx(320, abs=10)
    assert rows.mean() == pytest.approx(240, abs=10)


@pytest.mark.parametrize(
  ('side_m', 'up_m'), [(0.4, 0.0), (0.0, 0.4), (-0.4, -0.4)]
)
def test_the_eye_is_a_pinhole_of_60_degrees(
  side_m: float, up_m: float, load: Load
) -> None:
  environment = load('no_send', observers=1)
  environment.reset()
  physics, task = environment.physics, environment.task
  camera = task.observables[0]['camera']
  task.performer.set_pose(physics, np.array([0.0, 0.0, 6.0]))
  physics.forward()
  empty = camera(physics).copy()
  task.performer.set_pose(physics, np.array([side_m, 0.0, 1.3 + up_m]))
  physics.forward()
  rows, columns = np.nonzero((empty != camera(physics)).any(axis=2))
  # Its eye is a little ahead of it, so nearer than 1.3 m to the performer.
  focal_px = 240 / math.tan(math.radians(30)) / (1.3 - eye.OFFSET_M)
  middle = (columns.min() + columns.max()) / 2, (rows.min() + rows.max()) / 2
  expected = 320 + focal_px * side_m, 240 - focal_px * up_m
  assert middle == pytest.approx(expected, abs=6)


def test_observers_never_see_shadows(load: Load) -> None:
  images = [
    load(
      'no_send', observers=1, appearance=appearance.Appearance(shadows=shadows)
    )
    .reset()
    .observation[0]['camera']
    for shadows in (False, True)
  ]
  np.testing.assert_array_equal(*images)


def test_black_blinds_one_observer_only(dancing: Load, film: Film) -> None:
  environment = dancing()
  environment.task.observers[1].corruptor = lambda: eye.black
  first, second = film(environment)
  clean, _ = film(dancing())
  assert not second.any()
  np.testing.assert_array_equal(first, clean)


def test_noise_has_its_size_and_follows_from_the_seed(
  dancing: Load, film: Film
) -> None:
  noisy = []
  for seed in (0, 0, 1):
    environment = dancing(seed=seed, duration_s=0.08)
    environment.task.observers[0].corruptor = lambda: eye.GaussianNoise(5.0)
    noisy.append(film(environment))
  clean = film(dancing(duration_s=0.08))
  np.testing.assert_array_equal(noisy[0], noisy[1])
  assert (noisy[0][0] != noisy[2][0]).any()
  np.testing.assert_array_equal(noisy[0][1], clean[1])  # The other's eye.
  noise = noisy[0][0].astype(float) - clean[0]
  grey = (clean[0] > 30) & (clean[0] < 225)  # Far from clipping.
  assert noise[grey].mean() == pytest.approx(0.0, abs=0.05)
  assert noise[grey].std() == pytest.approx(5.0, abs=0.05)
  assert noisy[0].dtype == np.uint8


def test_noise_is_clipped_and_not_wrapped() -> None:
  random_state = np.random.RandomState(0)
  for level in (0, 255):
    image = np.full((480, 640, 3), level, np.uint8)
    out = eye.GaussianNoise(20.0)(image, random_state).astype(int)
    assert np.abs(out - level).max() < 120
    assert (out == level).mean() == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize('sigma', [math.nan, -1.0, 129.0])
def test_noise_of_no_sensible_size_is_refused(sigma: float) -> None:
  with pytest.raises(ValueError, match='`sigma` must be'):
    eye.GaussianNoise(sigma)


def test_a_frozen_frame_is_the_first_of_its_episode(
  dancing: Load, film: Film
) -> None:
  changes = {'jitter_m': 0.05, 'seed': 3}
  environment, clean = dancing(**changes), dancing(**changes)
  environment.task.observers[0].corruptor = eye.FrozenFrame
  frozen = []
  for _ in range(2):
    images, other = film(environment)
    real = film(clean)
    np.testing.assert_array_equal(images, [real[0][0]] * 11)
    np.testing.assert_array_equal(other, real[1])
    frozen.append(images[0])
  assert (frozen[0] != frozen[1]).any()


@pytest.mark.parametrize(
  'corruptor', [eye.black, eye.GaussianNoise(20.0), eye.FrozenFrame()]
)
def test_a_spoilt_episode_leaves_the_next_one_clean(
  corruptor: eye.Corruptor, dancing: Load, film: Film
) -> None:
  environment = dancing()
  expected = film(environment)
  environment.task.observers[0].corruptor = lambda: corruptor
  spoilt = film(environment)
  environment.task.observers[0].corruptor = None
  clean = film(environment)
  assert (spoilt[0] != expected[0]).any()
  np.testing.assert_array_equal(clean, expected)


def test_environments_side_by_side_do_not_meet(
  dancing: Load, film: Film, hover: Fixture
) -> None:
  others = [{}, {'payload': '111111', 'layout': 'line'}]
  alone = [film(dancing(**changes)) for changes in others]
  pair = [dancing(**changes) for changes in others]
  steps = [each.reset() for each in pair]
  for frame in range(11):
    for step, expected in zip(steps, alone, strict=True):
      seen = [each['camera'] for each in step.observation]
      np.testing.assert_array_equal(seen, expected[:, frame])
    steps = [
      each.step(hover(step.observation))
      for each, step in zip(pair, steps, strict=True)
    ]


def test_a_model_that_is_compiled_anew_is_seen_anew(
  dancing: Load, film: Film
) -> None:
  expected = film(dancing())
  task = dancing().task
  environment = composer.Environment(
    task, strip_singleton_obs_buffer_dim=True, recompile_mjcf_every_episode=True
  )
  for _ in range(2):
    np.testing.assert_array_equal(film(environment), expected)
  environment.close()
