"""Noise has the size that is asked for, in every image anew."""

import math

import numpy as np
import pytest

from waggle_tasks.entities import corruptors

SHAPE = (480, 640, 3)


def noise(count: int = 4, level: int = 128, **size: float) -> np.ndarray:
  """What is added to images of one level: (count, 480, 640, 3)."""
  add = corruptors.SensorNoise(
    size.get('sigma', 0.0), size.get('photons', 0.0), SHAPE,
    np.random.RandomState(4),
  )  # fmt: skip
  images = np.full((count, *SHAPE), level, np.uint8)
  for image in images:
    add(image)
  return images.astype(float) - level


@pytest.mark.parametrize('sigma', [2.0, 5.0, 20.0])
def test_gaussian_noise_has_its_size(sigma: float) -> None:
  added = noise(sigma=sigma)
  assert added.std() == pytest.approx(sigma, rel=0.02)
  assert added.mean() == pytest.approx(0.0, abs=0.005 * sigma)
  within = (np.abs(added) <= 1.5 * sigma).mean()
  edge = (math.floor(1.5 * sigma) + 0.5) / sigma  # Levels are whole.
  assert within == pytest.approx(math.erf(edge / math.sqrt(2)), abs=0.003)


@pytest.mark.parametrize('level', [30, 90, 128, 200])
@pytest.mark.parametrize('sigma', [0.0, 5.0])
def test_shot_noise_grows_with_the_light(level: int, sigma: float) -> None:
  added = noise(level=level, sigma=sigma, photons=1000.0)
  expected = math.sqrt(sigma**2 + 255 * level / 1000)
  assert added.std() == pytest.approx(expected, rel=0.02)
  assert added.mean() == pytest.approx(0.0, abs=0.03)


def test_there_is_no_shot_noise_in_the_dark() -> None:
  assert not noise(level=0, photons=100.0).any()


@pytest.mark.parametrize('size', [{'sigma': 5.0}, {'photons': 500.0}])
def test_noise_of_images_that_follow_each_other_is_independent(
  size: dict[str, float],
) -> None:
  added = noise(count=12, **size).reshape(12, -1)
  related = np.corrcoef(added)
  for first in range(11):
    assert abs(related[first, first + 1]) < 0.005
  differences = np.diff(added, axis=0)
  alternate = np.corrcoef(differences[0], differences[2])[0, 1]
  assert abs(alternate) < 0.005
  # Nor is one the other moved by a pixel, which would look like motion.
  for by in (3, -3, 1920, -1920):
    moved = np.roll(added[1], by)
    assert abs(np.corrcoef(added[0], moved)[0, 1]) < 0.005


@pytest.mark.parametrize('level', [0, 255])
@pytest.mark.parametrize('photons', [0.0, 1000.0])
def test_noise_is_clipped_and_not_wrapped(level: int, photons: float) -> None:
  added = noise(level=level, sigma=20.0, photons=photons)
  assert np.abs(added).max() < 150
  assert (added == 0).mean() == pytest.approx(0.5, abs=0.02)
