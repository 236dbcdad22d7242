"""Whether a camera lives: what is noticed, and what cannot be."""

from collections.abc import Iterator

import numpy as np
import pytest

from waggle_tasks.agents import liveness


def pictures(count: int) -> Iterator[np.ndarray]:
  rng = np.random.RandomState(0)
  for _ in range(count):
    yield rng.randint(0, 256, (48, 64, 3), np.uint8)


def watch(
  images: list[np.ndarray], resting: bool = True, max_repeated: float = 0.5
) -> list[bool]:
  alive = liveness.Liveness(max_repeated)
  return [alive.step(image, resting) for image in images]


def test_a_frozen_camera_with_noise_is_noticed_within_a_second() -> None:
  images = [*pictures(50)]
  lives = watch(images + [images[-1]] * 25)
  assert all(lives[:60])
  assert not any(lives[63:])


def test_a_recording_that_is_played_again_is_noticed() -> None:
  images = [*pictures(100)]
  assert not watch(images + images[20:60])[-1]


def test_a_camera_that_wakes_up_lives_again() -> None:
  images = [*pictures(80)]
  lives = watch(images[:50] + [images[49]] * 50 + images[50:])
  assert not lives[99]
  assert all(lives[-10:])


def test_a_few_repetitions_are_no_death() -> None:
  images = [*pictures(200)]
  images[5::4] = images[4::4][: len(images[5::4])]  # Each fourth again.
  images[60:] = pictures(140)
  images[61::4] = images[60::4]
  assert all(watch(images))


@pytest.mark.parametrize('resting', [True, False])
def test_without_noise_nothing_can_be_told(resting: bool) -> None:
  (image,) = pictures(1)
  moving = [*pictures(40)] if not resting else []
  alive = liveness.Liveness(0.5)
  assert all(alive.step(each, False) for each in moving)
  assert all(alive.step(image, True) for _ in range(100))


def test_who_asks_for_no_life_finds_it_everywhere() -> None:
  images = [*pictures(50)]
  assert all(watch(images + [images[0]] * 100, max_repeated=1.0))
