"""Where a gesture begins and ends in a track, at the paper's limits."""

from collections.abc import Iterable

import numpy as np
import pytest

from waggle_tasks.agents import config, klt, segmenter

STILL = [0.0] * 10
# 0.68 s pass between the first and the eighteenth frame of 0.04 s.
END_FRAMES = 18


def track(index: int, speed_px_s: float | None) -> klt.Track:
  """A frame of a target that moves to the right; None for a lost one."""
  valid = speed_px_s is not None
  centre_px = np.array([320.0 + index, 240.0])
  support = 20 if valid else 3
  return klt.Track(
    index * 0.04, centre_px, speed_px_s or 0.0, support, 0.9, valid
  )


def cut(
  speeds: Iterable[float | None],
) -> tuple[segmenter.Segmenter, list[segmenter.Segment]]:
  each = segmenter.Segmenter(config.Motion(), config.Tracking())
  segments = [each.step(track(i, speed)) for i, speed in enumerate(speeds)]
  return each, [segment for segment in segments if segment is not None]


def test_the_limits_are_the_papers() -> None:
  assert config.Motion() == config.Motion(3.5, 0.08, 2.5, 0.68)


@pytest.mark.parametrize(
  ('speed_px_s', 'frames', 'begins'),
  [
    (3.51, 3, True),  # 0.08 s pass between the first and the third.
    (3.51, 2, False),
    (3.5, 100, False),
    (200.0, 2, False),
  ],
)
def test_motion_begins_above_3_5_px_s_for_0_08_s(
  speed_px_s: float, frames: int, begins: bool
) -> None:
  each, _ = cut(STILL + [speed_px_s] * frames)
  assert each.active is begins


def test_one_slow_frame_begins_the_0_08_s_anew() -> None:
  each, _ = cut(STILL + [9.0, 9.0, 3.0] * 20)
  assert not each.active


@pytest.mark.parametrize(
  ('speed_px_s', 'frames', 'ends'),
  [
    (2.49, END_FRAMES, True),
    (2.49, END_FRAMES - 1, False),
    (2.5, 100, False),
    (0.0, END_FRAMES - 1, False),
  ],
)
def test_motion_ends_below_2_5_px_s_for_0_68_s(
  speed_px_s: float, frames: int, ends: bool
) -> None:
  each, segments = cut(STILL + [9.0] * 20 + [speed_px_s] * frames)
  assert each.active is not ends
  assert len(segments) == ends


def test_a_pause_at_a_corner_does_not_end_a_gesture() -> None:
  pause = [0.0] * (END_FRAMES - 1)
  each, segments = cut(STILL + ([9.0] * 20 + pause) * 3)
  assert each.active
  assert segments == []


def test_a_segment_holds_the_path_from_stillness_to_stillness() -> None:
  each, (segment,) = cut(STILL + [9.0] * 20 + [0.0] * END_FRAMES)
  # It began with frame 10 and was slow from frame 30 on.
  assert segment.begin_s == pytest.approx(10 * 0.04)
  assert segment.end_s == pytest.approx(30 * 0.04)
  assert segment.loss is None
  np.testing.assert_array_equal(segment.path_px[-1], (350, 240))
  assert 329 <= segment.path_px[0, 0] <= 330
  assert (np.diff(segment.path_px[:, 0]) == 1).all()
  assert not each.active


def test_each_gesture_is_a_segment_of_its_own() -> None:
  gesture = [9.0] * 20 + [0.0] * 50
  _, segments = cut(STILL + gesture * 3)
  assert len(segments) == 3
  begins_s = [segment.begin_s for segment in segments]
  np.testing.assert_allclose(begins_s, [0.4, 3.2, 6.0])
  assert all(len(segment.path_px) < 25 for segment in segments)


@pytest.mark.parametrize('lost', [1, 5])
def test_a_gesture_survives_a_few_lost_frames(lost: int) -> None:
  speeds = STILL + [9.0] * 10 + [None] * lost + [9.0] * 10 + [0.0] * END_FRAMES
  _, (segment,) = cut(speeds)
  assert segment.loss is None


def test_a_gesture_whose_track_is_lost_says_why() -> None:
  each, (segment,) = cut(STILL + [9.0] * 10 + [None] * 6)
  assert segment.loss == 'support 3 < 5'
  assert segment.end_s == pytest.approx(25 * 0.04)
  assert not each.active


def test_a_gesture_lost_twice_for_a_while_survives() -> None:
  lost = [None] * 5 + [9.0]
  _, (segment,) = cut(STILL + [9.0] * 10 + lost * 4 + [0.0] * END_FRAMES)
  assert segment.loss is None


def test_loss_without_a_gesture_is_no_segment() -> None:
  each, segments = cut(STILL + [None] * 50 + STILL)
  assert segments == []
  assert not each.active


def test_motion_that_is_lost_before_it_counts_begins_anew() -> None:
  each, segments = cut(STILL + [9.0, 9.0] + [None] * 10 + [9.0, 9.0])
  assert not each.active
  assert segments == []


def test_what_is_lost_from_the_beginning_stays_quiet() -> None:
  each, segments = cut([None] * 200)
  assert (each.active, segments) == (False, [])
