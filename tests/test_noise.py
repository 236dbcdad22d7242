"""How noisy images are, from two of them."""

import numpy as np
import pytest

from waggle_tasks.agents import noise

LEVELS = np.repeat(np.linspace(40, 200, 400, dtype=np.uint8)[None], 300, axis=0)


def seen(deviation: np.ndarray | float, seed: int) -> np.ndarray:
  draw = np.random.RandomState(seed).normal(0, 1, LEVELS.shape)
  return np.clip(np.rint(LEVELS + deviation * draw), 0, 255).astype(np.uint8)


@pytest.mark.parametrize('sigma', [3.0, 10.0, 20.0])
def test_noise_that_is_the_same_everywhere(sigma: float) -> None:
  found = noise.CameraNoise(seen(sigma, 0), seen(sigma, 1))
  assert found.overall == pytest.approx(sigma, rel=0.05)
  variance = found.variance(LEVELS)
  np.testing.assert_allclose(variance, sigma**2, rtol=0.15)


def test_noise_of_few_photons_grows_with_light() -> None:
  deviation = np.sqrt(LEVELS * 0.5)
  found = noise.CameraNoise(seen(deviation, 0), seen(deviation, 1))
  bright = found.variance(np.full((1, 1), 190, np.uint8))
  assert float(bright.item()) == pytest.approx(190 * 0.5, rel=0.15)


def test_images_without_noise_have_none() -> None:
  assert noise.CameraNoise(LEVELS, LEVELS).overall == 0.0


def test_what_moves_is_no_noise() -> None:
  other = LEVELS.copy()
  other[100:140, 100:160] = 255
  assert noise.CameraNoise(LEVELS, other).overall == 0.0
