"""What an observer's eye delivers."""

from collections.abc import Callable
import itertools
import math

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import appearance
from waggle_tasks.entities import optics

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]
Film = Callable[[composer.Environment], np.ndarray]


def test_there_is_one_new_image_every_0_04_s(dancing: Load, film: Film) -> None:
  images = film(dancing())
  assert images.shape == (2, 11, 480, 640, 3)
  for each in images:
    later = each[2:]  # The dance begins slowly.
    assert all((a != b).any() for a, b in itertools.pairwise(later))


@pytest.mark.slow
def test_an_image_that_is_kept_does_not_change(
  dancing: Load, episode: Fixture, hover: Fixture
) -> None:
  kept, copies = [], []
  for timestep in episode(dancing(), hover):
    kept += [each['camera'] for each in timestep.observation]
    copies += [each['camera'].copy() for each in timestep.observation]
  np.testing.assert_array_equal(np.stack(kept), np.stack(copies))


@pytest.mark.slow
@pytest.mark.parametrize('choice', [{'buffer_size': 3}, {'delay': 20}])
def test_images_that_composer_keeps_are_those_of_their_time(
  choice: dict[str, int], dancing: Load, film: Film
) -> None:
  images = film(dancing(observers=1))[0]
  environment = dancing(observers=1)
  environment.task.observables[0]['camera'].configure(**choice)
  kept = film(environment)[0]
  if 'delay' in choice:
    np.testing.assert_array_equal(kept[4:], images[2:-2])
  else:
    for index in range(2, len(images)):
      np.testing.assert_array_equal(kept[index], images[index - 2 : index + 1])


@pytest.mark.slow
def test_both_cameras_give_the_same_picture(dancing: Load, film: Film) -> None:
  np.testing.assert_array_equal(
    film(dancing(camera='incremental')), film(dancing(camera='full'))
  )


@pytest.mark.slow
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
  focal_px = 240 / math.tan(math.radians(30)) / (1.3 - optics.OFFSET_M)
  middle = (columns.min() + columns.max()) / 2, (rows.min() + rows.max()) / 2
  expected = 320 + focal_px * side_m, 240 - focal_px * up_m
  assert middle == pytest.approx(expected, abs=6)


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
