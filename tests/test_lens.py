"""Lenses bend lines as their published models say, and can be undone."""

import math

import cv2
import numpy as np
import pytest

from waggle_tasks import errors, eyes
from waggle_tasks.entities import lenses
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import lens as lens_lib

BROWN = lens_lib.Lens('brown', 0.12, -0.26, 0.003, -0.002, 0.1)
FISHEYE = lens_lib.Lens('fisheye', 0.05, -0.01, k3=0.002, k4=-0.0003)
PLACES = np.random.RandomState(0).uniform(-0.5, 0.5, (100, 2))


def test_brown_is_opencv_s_own_model() -> None:
  numbers = np.array([BROWN.k1, BROWN.k2, BROWN.p1, BROWN.p2, BROWN.k3])
  rays = np.c_[PLACES, np.ones(len(PLACES))]
  at = np.zeros(3)
  expected, _ = cv2.projectPoints(rays, at, at, np.eye(3), numbers)
  np.testing.assert_allclose(BROWN.shown(PLACES), expected[:, 0], atol=1e-12)


def test_fisheye_is_opencv_s_own_model() -> None:
  numbers = np.array([FISHEYE.k1, FISHEYE.k2, FISHEYE.k3, FISHEYE.k4])
  wide = 5 * PLACES
  expected = cv2.fisheye.distortPoints(wide[:, None], np.eye(3), numbers)
  np.testing.assert_allclose(FISHEYE.shown(wide), expected[:, 0], atol=1e-12)


@pytest.mark.parametrize('lens', [BROWN, FISHEYE, lens_lib.Lens()])
def test_what_a_lens_does_can_be_undone(lens: lens_lib.Lens) -> None:
  np.testing.assert_allclose(lens.seen(lens.shown(PLACES)), PLACES, atol=1e-9)
  np.testing.assert_array_equal(lens.seen(np.zeros((1, 2))), [[0, 0]])


def test_what_a_lens_never_shows_is_no_place() -> None:
  folded = lens_lib.Lens('brown', k1=-0.5)  # Nothing is farther out than 0.54.
  assert np.isnan(folded.seen(np.array([0.6, 0.0]))).all()
  assert np.isnan(lens_lib.Lens('fisheye').seen(np.array([1.6, 0.0]))).all()


def test_the_field_of_view_is_that_through_the_lens() -> None:
  wide = camera_lib.Camera.of(640, 480, 82.5, lens_lib.Lens('fisheye'))
  assert wide.focal_px == pytest.approx(240 / math.radians(82.5 / 2))
  bent = camera_lib.Camera.of(
    640, 480, 41.728, lens_lib.Lens('brown', 0.12, -0.26, k3=0.1)
  )
  assert bent.fovy_deg == pytest.approx(41.728)
  assert camera_lib.Camera.of(640, 480, 60.0) == camera_lib.Camera()


def test_a_camera_that_looks_up_shows_the_level_below_its_middle() -> None:
  up = camera_lib.Camera.of(640, 480, 60.0, pitch_deg=10.0)
  below_px = up.focal_px * math.tan(math.radians(10))
  ahead = up.shown(np.array([320.0, 240.0]))
  np.testing.assert_allclose(ahead, [320, 240 + below_px])


def test_a_camera_that_rolls_clockwise_turns_its_picture_back() -> None:
  rolled = camera_lib.Camera.of(640, 480, 60.0, roll_deg=90.0)
  # What is to the right is above.
  right = rolled.shown(np.array([420.0, 240.0]))
  np.testing.assert_allclose(right, [320, 140], atol=1e-9)


@pytest.mark.parametrize('lens', [BROWN, FISHEYE])
def test_mount_and_lens_are_undone_together(lens: lens_lib.Lens) -> None:
  seen_with = camera_lib.Camera.of(640, 480, 40.0, lens, 8.0, -20.0)
  places = np.random.RandomState(0).uniform(100, 380, (50, 2))
  np.testing.assert_allclose(
    seen_with.levelled(seen_with.shown(places)), places, atol=1e-6
  )


def _line(
  lens: lens_lib.Lens, fovy_deg: float, off: float
) -> tuple[float, np.ndarray]:
  """How far below its middle a pinhole would show a line, about `off`.

  And (N, 2) the line in the eye's picture, both in focal lengths.
  """
  seen_with = camera_lib.Camera.of(640, 480, fovy_deg, lens)
  eye = eyes.Eye('ideal', lens=lens.model, k1=lens.k1)
  larger = lenses.drawn(seen_with, eye)
  picture = np.zeros(larger.shape, np.uint8)
  row = round(larger.rows / 2 + off * larger.focal_px)
  picture[row - 2 : row + 2] = 255
  projection = lenses.Projection(seen_with, eye, np.random.RandomState(0))
  light = projection.picture(picture, 0.0)[..., 0].astype(float)
  columns = np.arange(20, 620, 20)
  rows = np.arange(480) + 0.5
  y = [rows @ light[:, c] / light[:, c].sum() for c in columns]
  off = (row - larger.rows / 2) / larger.focal_px
  shown = np.c_[columns + 0.5 - 320, np.array(y) - 240] / seen_with.focal_px
  return off, shown


@pytest.mark.slow
def test_a_straight_line_bends_as_far_as_brown_says() -> None:
  off, shown = _line(lens_lib.Lens('brown', k1=-0.2), 50.0, 0.3)
  x, y = shown.T
  # Places on the line are shown (1 - 0.2 r^2) times as far from the middle.
  wide = np.linspace(-1, 1, 2001)
  shrink = 1 - 0.2 * (wide**2 + off**2)
  expected = np.interp(x, wide * shrink, off * shrink)
  np.testing.assert_allclose(y, expected, atol=0.5 / 538)
  assert np.ptp(y) * 538 > 10  # px: it does bend.


def test_a_straight_line_bends_as_far_as_a_fisheye_says() -> None:
  off, shown = _line(lens_lib.Lens('fisheye'), 70.0, 0.4)
  x, y = shown.T
  wide = np.linspace(-2, 2, 4001)
  far = np.hypot(wide, off)
  expected = np.interp(
    x, wide * np.arctan(far) / far, off * np.arctan(far) / far
  )
  np.testing.assert_allclose(y, expected, atol=0.5 / 390)
  assert np.ptp(y) * 390 > 20


@pytest.mark.parametrize(
  ('make', 'error'),
  [
    (lambda: lens_lib.Lens('fish'), '`lens` must be one of .*fisheye'),
    (lambda: lens_lib.Lens(k1=0.1), '`k1` must be 0 for the lens .pinhole.'),
    (lambda: lens_lib.Lens('brown', k4=0.1), '`k4` must be 0'),
    (lambda: lens_lib.Lens('brown', k1=math.nan), '`k1` must be a finite'),
    (
      lambda: camera_lib.Camera.of(
        640, 480, 60.0, lens_lib.Lens('brown', -3.0)
      ),
      '`lens` must',
    ),
    (
      lambda: camera_lib.Camera.of(640, 480, 120.0, lens_lib.Lens('fisheye')),
      '`lens` must see the whole picture once, within 75 degrees',
    ),
  ],
)
def test_a_lens_that_makes_no_picture_is_refused(
  make: object, error: str
) -> None:
  with pytest.raises(errors.WaggleError, match=error):
    make()
