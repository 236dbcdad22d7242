"""Pictures are brought back to their reference, or refused."""

import cv2
import numpy as np
import pytest

from waggle_tasks.agents import alignment, difference, turns

RNG = np.random.RandomState(0)


def scene(seed: int = 0) -> np.ndarray:
  """Soft blobs and some edges, (480, 640, 3) uint8."""
  rng = np.random.RandomState(seed)
  tiles = rng.randint(60, 200, (12, 16, 1)).astype(np.uint8)
  tiles = cv2.resize(tiles, (640, 480), interpolation=cv2.INTER_NEAREST)
  return np.repeat(cv2.GaussianBlur(tiles, (0, 0), 1.5)[..., None], 3, axis=2)


def room(image: np.ndarray) -> alignment.Alignment:
  return alignment.Alignment(image, turns.Turns((640, 480), 415.7))


def moved(image: np.ndarray, x_px: float, y_px: float) -> np.ndarray:
  matrix = np.array([[1.0, 0.0, x_px], [0.0, 1.0, y_px]])
  return cv2.warpAffine(
    image, matrix, (640, 480), borderMode=cv2.BORDER_REFLECT
  )


def turned(image: np.ndarray, *angles_deg: float) -> np.ndarray:
  """What a camera of 60 degrees sees, turned about x, y and z."""
  lens = np.array([[415.7, 0, 319.5], [0, 415.7, 239.5], [0, 0, 1]])
  turn, _ = cv2.Rodrigues(np.radians(angles_deg))
  plane = lens @ turn @ np.linalg.inv(lens)
  return cv2.warpPerspective(
    image, plane, (640, 480), borderMode=cv2.BORDER_REFLECT
  )


def noisy(image: np.ndarray, sigma: float) -> np.ndarray:
  noise = RNG.normal(0, sigma, image.shape)
  return np.clip(np.rint(image + noise), 0, 255).astype(np.uint8)


@pytest.mark.parametrize('shift_px', [(0.2, -0.15), (0.4, 0.0), (-0.5, 0.6)])
@pytest.mark.parametrize('sigma', [0.0, 5.0])
def test_a_swaying_picture_is_brought_back(
  shift_px: tuple[float, float], sigma: float
) -> None:
  image = scene()
  align = room(image)
  back = align.step(noisy(moved(image, *shift_px), sigma))
  assert align.moving
  np.testing.assert_allclose(align.shift_px, shift_px, atol=0.1)
  wrong = cv2.absdiff(back, difference.grey(image))[8:-8, 8:-8]
  # Noise of a grey value is less than that of a colour.
  assert np.quantile(wrong, 0.9) <= 4 + 1.2 * sigma


@pytest.mark.slow
@pytest.mark.parametrize('sigma', [0.0, 10.0])
@pytest.mark.parametrize('degrees', [0.1, 0.3, 1.0])
def test_a_camera_that_turns_to_and_fro_is_brought_back(
  degrees: float, sigma: float
) -> None:
  image = scene()
  align = room(image)
  for share in (1.0, -0.5, 0.0, 0.7):
    angles = share * degrees * np.array([0.8, -1.0, 0.7])
    back = align.step(noisy(turned(image, *angles), sigma))
  assert align.moving
  # But for what the camera no longer sees.
  wrong = cv2.absdiff(back, difference.grey(image))[40:-40, 40:-40]
  assert np.quantile(wrong, 0.9) <= 4 + 1.2 * sigma


@pytest.mark.parametrize(('gain', 'offset'), [(1.2, 0), (0.6, 0), (0.9, 20)])
def test_light_is_taken_out(gain: float, offset: float) -> None:
  image = scene()
  align = room(image)
  back = align.step(cv2.convertScaleAbs(image, alpha=gain, beta=offset))
  assert not align.moving
  wrong = cv2.absdiff(back, difference.grey(image))
  assert np.quantile(wrong, 0.99) <= 3


@pytest.mark.slow
@pytest.mark.parametrize('sigma', [0.0, 5.0, 20.0])
def test_a_picture_of_a_resting_camera_is_left_alone(sigma: float) -> None:
  image = scene()
  align = room(image)
  for _ in range(10):
    seen = noisy(image, sigma)
    assert align.step(seen) is not None
    assert not align.moving
  assert align.step(image) is image


def test_what_moves_in_the_picture_does_not_move_the_picture() -> None:
  image = scene()
  align = room(image)
  seen = image.copy()
  seen[200:300, 50:250] = moved(image, 9, 5)[200:300, 50:250]
  align.step(seen)
  assert not align.moving


@pytest.mark.parametrize('other', [np.zeros_like(scene()), scene(1)])
def test_another_picture_is_refused(other: np.ndarray) -> None:
  assert room(scene()).step(other) is None


def test_edges_that_have_left_the_picture_are_not_missed() -> None:
  flat = np.full_like(scene(), 120)
  image = flat.copy()
  image[430:, 60:600] = scene()[430:, 60:600]  # As of a floor far below.
  image[90:100, 100:540:40] = 30
  align = room(image)
  for degrees in (
    -1.0,
    -2.5,
    -4.0,
    -5.0,
  ):  # The nose goes down, the floor leaves.
    back = align.step(turned(image, degrees, 0.0, 0.0))
    assert back is not None
    np.testing.assert_allclose(
      align.shift_px[1], -415.7 * np.radians(degrees), atol=1.5
    )


def test_nothing_is_told_from_a_reference_without_contrast() -> None:
  flat = np.full_like(scene(), 90)
  other = scene()
  align = room(flat)
  assert align.step(other) is other
  assert not align.tells_shifts
