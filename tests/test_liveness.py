"""Whether a camera lives: what is noticed, and what cannot be."""

from collections.abc import Iterator

import numpy as np

from waggle_tasks.agents import liveness


def pictures(count: int) -> Iterator[np.ndarray]:
  rng = np.random.RandomState(0)
  for _ in range(count):
    yield rng.randint(0, 256, (48, 64, 3), np.uint8)


def lives(
  images: list[np.ndarray], looks: list[int], max_repeated: float = 0.5
) -> list[bool]:
  """What is told after so many images each, of a scene at rest."""
  alive, told = liveness.Liveness(max_repeated), []
  for number, image in enumerate(images, 1):
    alive.step(image)
    if number in looks:
      told.append(alive.lives())
  return told


def test_a_camera_that_freezes_is_noticed() -> None:
  images = [*pictures(75)]
  assert lives(images + [images[-1]] * 75, [75, 90, 125]) == [True, True, False]


def test_a_recording_that_is_played_again_is_noticed() -> None:
  images = [*pictures(100)]
  assert lives(images + images[20:80], [75, 160]) == [True, False]


def test_a_camera_that_wakes_up_lives_again() -> None:
  images = [*pictures(150)]
  frozen = images[:75] + [images[74]] * 75 + images[75:]
  assert lives(frozen, [75, 150, 225]) == [True, False, True]


def test_a_few_repetitions_are_no_death() -> None:
  images = [*pictures(150)]
  images[101::4] = images[100:-1:4]
  assert lives(images, [75, 150]) == [True, True]


def test_motion_before_the_first_rest_tells_nothing() -> None:
  images = [*pictures(60)]  # Something moves: all of them differ.
  assert lives(images + [images[-1]] * 150, [135, 210]) == [True, True]


def test_who_asks_for_no_life_finds_it_everywhere() -> None:
  images = [*pictures(75)]
  frozen = images + [images[0]] * 100
  assert lives(frozen, [75, 175], max_repeated=1.0) == [True, True]
