"""The tracker follows the dancer in real images, and knows when it does not."""

from collections.abc import Iterable

import cv2
import numpy as np
import pytest

from waggle_tasks.agents import config, klt

BLACK = np.zeros((480, 640, 3), np.uint8)
MOVING = 95  # A frame of START's first leg, 3.8 s.


def tracks(
  images: Iterable[np.ndarray],
  times_s: Iterable[float],
  **changes: float,
) -> list[klt.Track]:
  tracker = klt.KltTracker(config.Tracking(**changes))
  return [
    tracker.step(image, time_s)
    for image, time_s in zip(images, times_s, strict=True)
  ]


def test_the_dancer_is_followed_within_a_pixel_or_two(clip: object) -> None:
  seen = tracks(clip.images, clip.times_s)
  assert all(track.valid for track in seen[1:])
  centres_px = np.array([track.centre_px for track in seen])
  moved_px = clip.target_px - clip.target_px[0]
  errors_px = np.abs(centres_px - centres_px[0] - moved_px).max(axis=1)
  assert np.ptp(moved_px, axis=0).min() > 60
  assert errors_px.max() < 2.0
  assert [track.time_s for track in seen] == clip.times_s


def test_its_speed_is_that_of_the_image(clip: object) -> None:
  seen = tracks(clip.images, clip.times_s)
  steps_px = np.hypot(*np.diff(clip.target_px, axis=0).T)
  speeds = np.array([track.speed_px_s for track in seen[1:]])
  assert steps_px.max() * 25 > 150
  np.testing.assert_allclose(speeds, steps_px * 25, atol=10)


def test_it_begins_at_the_dancer_near_the_middle(clip: object) -> None:
  tracker = klt.KltTracker(config.Tracking())
  assert tracker.anchor_px is None
  tracker.step(clip.images[0], 0.0)
  np.testing.assert_allclose(tracker.anchor_px, clip.target_px[0], atol=10)
  first_px = tracker.anchor_px.copy()
  for image, time_s in zip(clip.images, clip.times_s, strict=True):
    track = tracker.step(image, time_s + 0.04)
  np.testing.assert_array_equal(tracker.anchor_px, first_px)
  np.testing.assert_allclose(track.centre_px, first_px, atol=2)


def test_a_repeated_image_is_stillness(clip: object) -> None:
  still = tracks([clip.images[0]] * 10, np.arange(10) * 0.04)
  assert all(track.valid for track in still[1:])
  assert [track.speed_px_s for track in still] == [0.0] * 10


def test_an_image_is_neither_kept_nor_changed(clip: object) -> None:
  """Environments may hand the same buffer over again and again."""
  buffer = np.empty_like(BLACK)
  tracker = klt.KltTracker(config.Tracking())
  expected = tracks(clip.images[:150], clip.times_s[:150])
  for index, track in enumerate(expected):
    buffer[:] = clip.images[index]
    got = tracker.step(buffer, clip.times_s[index])
    np.testing.assert_array_equal(got.centre_px, track.centre_px)
    np.testing.assert_array_equal(buffer, clip.images[index])


def test_black_images_hold_nothing_to_follow() -> None:
  tracker = klt.KltTracker(config.Tracking())
  for index in range(20):
    track = tracker.step(BLACK, index * 0.04)
    assert not track.valid
    assert track.loss(config.Tracking()) == 'support 0 < 5'
  assert tracker.anchor_px is None


def test_it_begins_with_the_first_image_that_shows_something(
  clip: object,
) -> None:
  seen = tracks([BLACK] * 5 + clip.images[:10], np.arange(15) * 0.04)
  assert not any(track.valid for track in seen[:6])
  assert all(track.valid for track in seen[6:])
  np.testing.assert_allclose(seen[-1].centre_px, clip.target_px[0], atol=10)


def test_a_lost_target_is_taken_up_where_it_was(clip: object) -> None:
  images = [*clip.images[:MOVING], BLACK, *clip.images[MOVING : MOVING + 5]]
  seen = tracks(images, clip.times_s[: len(images)])
  lost, found = seen[MOVING], seen[MOVING + 2]
  assert not lost.valid
  assert lost.speed_px_s == 0
  np.testing.assert_array_equal(lost.centre_px, seen[MOVING - 1].centre_px)
  assert found.valid


@pytest.mark.parametrize(('gap_s', 'valid'), [(0.29, True), (0.31, False)])
def test_a_gap_between_two_images_breaks_the_track(
  gap_s: float, valid: bool, clip: object
) -> None:
  times_s = [0.0, 0.04, 0.04 + gap_s, 0.08 + gap_s]
  seen = tracks(clip.images[:4], times_s)
  assert [track.valid for track in seen[1:]] == [True, valid, True]


def test_the_smallest_support_counts_as_enough(clip: object) -> None:
  pair, times_s = clip.images[84:86], clip.times_s[84:86]
  enough = tracks(pair, times_s, min_support=1)[-1].support
  assert enough >= 5
  for limit, valid in [(enough, True), (enough + 1, False)]:
    track = tracks(pair, times_s, min_support=limit)[-1]
    assert track.valid is valid
    if not valid:
      limits = config.Tracking(min_support=limit)
      assert track.loss(limits) == f'support {enough} < {limit}'


def test_the_smallest_quality_counts_as_enough(clip: object) -> None:
  spoilt = clip.images[1].copy()
  x, y = clip.target_px[0].astype(int)
  spoilt[y - 40 : y + 40, x - 60 : x - 20] = 90  # A rotor is hidden.
  pair, times_s = [clip.images[0], spoilt], [0.0, 0.04]
  quality = tracks(pair, times_s, min_support=1, min_quality=0.01)[-1].quality
  assert 0.05 < quality < 0.95
  for limit, valid in [(quality, True), (quality + 1e-6, False)]:
    changes = {'min_support': 1, 'min_quality': limit}
    track = tracks(pair, times_s, **changes)[-1]
    assert track.valid is valid
    if not valid:
      reason = track.loss(config.Tracking(**changes))
      assert reason.startswith(f'forward-backward ratio {quality:.2f} < ')


def test_noise_alone_is_not_followed() -> None:
  rng = np.random.RandomState(0)
  noise = [rng.randint(0, 256, BLACK.shape, np.uint8) for _ in range(10)]
  seen = tracks(noise, np.arange(10) * 0.04)
  assert not any(track.valid for track in seen)


def test_a_target_that_leaves_the_picture_is_lost(clip: object) -> None:
  shifted = [
    cv2.warpAffine(
      clip.images[0],
      np.array([[1.0, 0.0, 8.0 * step], [0.0, 1.0, 0.0]]),
      (640, 480),
    )
    for step in range(60)
  ]
  seen = tracks(shifted, np.arange(60) * 0.04)
  assert seen[10].valid
  assert not seen[-1].valid
  assert np.isfinite([track.centre_px for track in seen]).all()


@pytest.mark.parametrize('size', [(320, 240), (64, 48), (40, 200), (8, 8)])
def test_images_of_any_size_are_taken(
  size: tuple[int, int], clip: object
) -> None:
  images = [cv2.resize(image, size) for image in clip.images[80:110]]
  seen = tracks(images, clip.times_s[80:110])
  assert np.isfinite([track.centre_px for track in seen]).all()
