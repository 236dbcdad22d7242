"""A background follows a camera that moves aside, but not what moves."""

import numpy as np
import pytest

from waggle_tasks.agents import config, difference, parallax

GATE = slice(200, 280), slice(280, 360)


def near(shift_px: float) -> np.ndarray:
  """A wall that stays, and a floor of soft stripes that moves aside."""
  image = np.full((480, 640), 120, np.uint8)
  image[100:200, 60:580:80] = 40
  columns = np.arange(640) - shift_px
  stripes = 110 + 60 * np.sin(2 * np.pi * columns / 64)
  image[320:] = np.rint(stripes)
  return image


def follow(images: list[np.ndarray], known: difference.Background) -> int:
  """How often a background was changed by images of 25 Hz."""
  made = parallax.Parallax(config.Differencing())
  return sum(
    made.step(image, GATE, number / 25, known)
    for number, image in enumerate(images)
  )


def test_what_moves_slowly_aside_is_followed() -> None:
  known = difference.Background(near(0.0))
  shifts_px = np.linspace(0.0, 12.0, 100)
  assert follow([near(each) for each in shifts_px], known) > 5
  off = np.abs(known.grey.astype(int) - near(12.0))[330:]
  assert np.quantile(off, 0.9) <= 20  # It moved by 70 levels.
  assert known.slack is not None


def test_the_target_is_never_taken_for_background() -> None:
  known = difference.Background(near(0.0))
  seen = near(0.0)
  seen[210:270, 290:350] = 250  # It rests in its gate.
  follow([seen] * 100, known)
  np.testing.assert_array_equal(known.grey[GATE], near(0.0)[GATE])


@pytest.mark.parametrize('speed_px', [2, 6])
def test_what_flies_by_leaves_nothing_behind(speed_px: int) -> None:
  known = difference.Background(near(0.0))
  images = []
  for number in range(100):
    seen = near(0.0)
    left = 20 + speed_px * number
    seen[220:260, left : left + 40] = 250
    images.append(seen)
  follow(images, known)
  assert np.abs(known.grey.astype(int) - near(0.0))[200:300].max() <= 6
