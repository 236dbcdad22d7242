"""Receivers undo what is known of their camera, of places."""

import math

import cv2
import numpy as np
import pytest

from waggle_tasks.agents import bent_turns, calibrated, klt, turns
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import lens as lens_lib

FISHEYE = camera_lib.Camera.of(640, 480, 80.0, lens_lib.Lens('fisheye'))
UP = camera_lib.Camera.of(640, 480, 60.0, pitch_deg=8.0)


def track(x: float, y: float) -> klt.Track:
  return klt.Track(1.0, np.array([x, y]), 50.0, 9, 1.0, True, width_px=20.0)


def test_a_plain_camera_changes_nothing() -> None:
  made = calibrated.Calibrated(camera_lib.Camera())
  image, seen = np.zeros((480, 640, 3), np.uint8), track(100, 80)
  assert made.part(image) is image
  assert made.levelled(seen) is seen
  assert made.seen(seen) is seen
  assert made.bends is None


def test_a_straight_way_through_a_fisheye_is_straight_again() -> None:
  straight = np.linspace([150, 120], [500, 200], 9)
  seen = FISHEYE.shown(straight)
  made = calibrated.Calibrated(FISHEYE)
  found = [made.levelled(track(*each)).centre_px for each in seen]
  np.testing.assert_allclose(found, straight, atol=1e-6)
  assert np.abs(seen - straight).max() > 5


def test_speed_and_width_grow_as_what_is_seen_does() -> None:
  made = calibrated.Calibrated(FISHEYE)
  off_px = 240.0  # A fisheye shows angles: far from its axis all is smaller.
  angle = off_px / FISHEYE.focal_px
  along, across = 1 / math.cos(angle) ** 2, math.tan(angle) / angle
  found = made.levelled(track(320 + off_px, 240))
  expected = math.sqrt(along * across)
  assert found.speed_px_s == pytest.approx(50 * expected, rel=1e-3)
  assert found.width_px == pytest.approx(20 * expected, rel=1e-3)


def test_trackers_of_a_camera_that_looks_up_begin_at_the_level() -> None:
  made = calibrated.Calibrated(UP)
  image = np.zeros((480, 640, 3), np.uint8)
  below = round(240 + UP.focal_px * math.tan(math.radians(8)))
  image[below - 1 : below + 1, 319:321] = 255
  part = made.part(image)
  assert part.shape[1] == 640
  middle = part.shape[0] // 2
  assert part[middle - 1 : middle + 1, 319:321].mean() > 120
  # What is level ahead is in the middle of a level pinhole.
  level = made.levelled(track(part.shape[1] / 2, part.shape[0] / 2))
  np.testing.assert_allclose(level.centre_px, [320, 240], atol=1.0)
  shown = made.seen(track(part.shape[1] / 2, part.shape[0] / 2))
  np.testing.assert_allclose(shown.centre_px, [320, below], atol=1.0)


def test_a_rolled_camera_s_tracks_are_upright() -> None:
  rolled = camera_lib.Camera.of(640, 480, 60.0, roll_deg=20)
  made = calibrated.Calibrated(rolled)
  level = np.array([[320, 240], [320, 140]])
  shown = rolled.shown(level)
  assert abs(shown[1, 0] - 320) > 30
  found = [made.levelled(track(*each)).centre_px for each in shown]
  np.testing.assert_allclose(found, level, atol=1e-6)


def test_turns_of_a_pinhole_are_those_of_its_calibration() -> None:
  plain = turns.Turns((640, 480), camera_lib.Camera.focal_px)
  bent = bent_turns.BentTurns(camera_lib.Camera(), np.zeros(2), (640, 480))
  places = np.random.RandomState(0).uniform(50, 400, (2, 30))
  np.testing.assert_allclose(bent.flow(places), plain.flow(places), atol=1e-3)
  motion = np.array([5.0, -3.0, 8.0])
  for one, other in ((bent, plain), (bent.smaller(4), plain.smaller(4))):
    np.testing.assert_allclose(
      one.moved(places / 8, motion), other.moved(places / 8, motion), atol=1e-3
    )


def test_a_turn_through_a_fisheye_is_undone() -> None:
  grey = np.full((480, 640), 90, np.uint8)
  random_state = np.random.RandomState(0)
  for x, y in random_state.uniform(60, 420, (60, 2)):
    cv2.circle(grey, (int(x * 1.3), int(y)), 12, int(x) % 200 + 50, -1)
  grey = cv2.GaussianBlur(grey, (0, 0), 2.0)
  bent = calibrated.Calibrated(FISHEYE).bends
  motion = np.array([6.0, -4.0, 10.0])
  moved = bent.undone(grey, -motion, grey)  # Turned the other way.
  back = bent.undone(moved, motion, grey)
  inside = slice(60, -60), slice(60, -60)
  before = np.abs(moved[inside].astype(int) - grey[inside]).mean()
  after = np.abs(back[inside].astype(int) - grey[inside]).mean()
  assert after < before / 5
