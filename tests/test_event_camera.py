"""Events that an event camera would have sent between two images."""

from collections.abc import Sequence
import itertools

import numpy as np
import pytest

from waggle_tasks.agents import event_camera, group

SHAPE = 24, 32, 3


def flat(level: int) -> np.ndarray:
  return np.full(SHAPE, level, np.uint8)


def seen(levels: Sequence[int], **numbers: float) -> list[event_camera.Events]:
  """What one pixel after another sends, of images of one brightness each."""
  camera = event_camera.EventCamera(event_camera.Pixels(**numbers))
  return [camera.step(flat(k), 0.04 * n) for n, k in enumerate(levels)]


def test_a_brightness_that_stays_sends_nothing() -> None:
  assert all(not len(each.times_s) for each in seen([80, 80, 80]))


def test_an_event_comes_each_time_that_the_logarithm_moved_by_a_threshold() -> (
  None
):
  _, up = seen([50, 100])  # By 0.693.
  assert len(up.times_s) == 3 * 24 * 32
  assert (up.signs == 1).all()
  # On a straight line, 0.2, 0.4 and 0.6 of 0.693 are crossed.
  shares = np.array([0.2, 0.4, 0.6]) / np.log(2)
  np.testing.assert_allclose(np.unique(up.times_s), 0.04 * shares, atol=0.0011)
  assert (np.diff(up.times_s) >= 0).all()


def test_times_are_steps_of_the_rate() -> None:
  _, up = seen([50, 100], event_rate_hz=100.0)
  assert set(np.rint(up.times_s * 1e6)) <= {10_000, 20_000, 30_000, 40_000}
  assert up.times_s.max() <= 0.04


def test_who_is_as_bright_as_at_first_has_sent_as_many_of_each_sign() -> None:
  rng = np.random.default_rng(0)
  levels = [60, *rng.integers(0, 256, 300), 60]
  sums = sum(int(each.signs.sum()) for each in seen(levels))
  assert sums == 0


def test_the_same_images_send_the_same_events() -> None:
  rng = np.random.default_rng(1)
  images = rng.integers(0, 256, (5, *SHAPE)).astype(np.uint8)
  runs = []
  for _ in range(2):
    camera = event_camera.EventCamera(event_camera.Pixels())
    runs.append([camera.step(im, 0.1 * n) for n, im in enumerate(images)])
  for one, other in zip(*runs, strict=True):
    for name in ('times_s', 'rows', 'columns', 'signs'):
      np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


def test_a_larger_threshold_sends_fewer() -> None:
  counts = [
    len(seen([50, 100], contrast=c)[1].times_s) for c in (0.1, 0.2, 0.5, 1.0)
  ]
  assert all(a > b for a, b in itertools.pairwise(counts))
  assert counts[-1] == 0


@pytest.mark.parametrize(
  ('numbers', 'error'),
  [
    ({'contrast': 0.0}, '`contrast` must be between 0.02 and 2'),
    ({'contrast': float('nan')}, '`contrast` must be'),
    ({'event_rate_hz': 1.0}, '`event_rate_hz` must be between 10 and'),
  ],
)
def test_pixels_that_cannot_be_are_refused(
  numbers: dict[str, float], error: str
) -> None:
  with pytest.raises(group.ReceiverError, match=error):
    event_camera.Pixels(**numbers)
