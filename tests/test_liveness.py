"""Whether a camera lives in the final rest: what is noticed, what cannot be."""

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from waggle_tasks.agents import liveness

FRAME_S = 0.04
REST = 75  # Images of a rest.
PLAIN = np.full((480, 640, 3), 120, np.uint8)


def noisy(count: int, seed: int = 0) -> Iterator[np.ndarray]:
  rng = np.random.RandomState(seed)
  for _ in range(count):
    yield (PLAIN + rng.randint(-9, 10, PLAIN.shape)).astype(np.uint8)


def lives(
  rests: Sequence[Sequence[np.ndarray]], max_stale_s: float = 0.4
) -> bool:
  """What is told at the end of the last of some rests of one frame."""
  alive, time_s = liveness.Liveness(max_stale_s), 0.0
  alive.event(null=False, before_frame=False)
  for number, images in enumerate(rests, 1):
    for image in images:
      alive.step(image, time_s)
      time_s += FRAME_S
    if number < len(rests):
      alive.event(null=True, before_frame=False)
      alive.event(null=False, before_frame=False)
  return alive.lives(time_s - FRAME_S)


@pytest.fixture(scope='module')
def rest() -> list[np.ndarray]:
  return [*noisy(REST)]


@pytest.mark.slow
@pytest.mark.parametrize('alive', [0, 20, 60])
def test_a_noisy_camera_that_freezes_is_noticed(
  rest: list[np.ndarray], alive: int
) -> None:
  frozen = [*noisy(alive, 1), *[rest[-1]] * (REST - alive)]
  assert lives([rest, frozen]) is False


@pytest.mark.slow
def test_a_freeze_at_the_very_end_is_not(rest: list[np.ndarray]) -> None:
  late = [*noisy(REST - 8, 1), *[rest[-1]] * 8]
  assert lives([rest, late])


def test_a_camera_that_wakes_up_lives_again(rest: list[np.ndarray]) -> None:
  assert lives([rest, [*[rest[-1]] * 40, *noisy(REST - 40, 1)]])


def test_old_images_that_are_played_again_are_noticed(
  rest: list[np.ndarray],
) -> None:
  assert lives([rest, rest[5:] + rest[:5]]) is False


def test_pictures_without_noise_may_repeat(rest: list[np.ndarray]) -> None:
  still = [PLAIN] * REST
  assert lives([still, still])
  assert lives([still, rest, still])  # As an encoder's do in some rests.


def test_a_recording_may_show_every_picture_many_times(
  rest: list[np.ndarray],
) -> None:
  slow = [image for image in rest[:6] for _ in range(13)]
  assert lives([slow, slow[::-1]])


def test_light_that_comes_to_rest_is_no_death() -> None:
  rising = [PLAIN + np.uint8(number // 3) for number in range(REST)]
  assert lives([rising, rising, [rising[-1]] * REST])


def test_something_that_passes_by_is_no_noise() -> None:
  passing = []
  for number in range(REST):
    image = PLAIN.copy()
    image[100:140, 8 * number : 8 * number + 40] = 30
    passing.append(image)
  assert lives([passing, [PLAIN] * REST])


def test_who_asks_for_no_life_finds_it_everywhere(
  rest: list[np.ndarray],
) -> None:
  assert lives([rest, [rest[-1]] * REST], max_stale_s=0.0)


def test_a_final_rest_without_others_is_believed(
  rest: list[np.ndarray],
) -> None:
  assert lives([[rest[-1]] * REST])
