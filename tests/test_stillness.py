"""When stillness is a null, at the paper's limits: one for each rest."""

from collections.abc import Iterable
import dataclasses

import numpy as np
import pytest

from waggle_tasks.agents import config, klt, stillness

ANCHOR_PX = np.array([320.0, 240.0])
# 3 s pass between the first and the seventy-sixth frame of 0.04 s.
FRAMES = 76


@dataclasses.dataclass(frozen=True)
class Frame:
  """One frame of a target, and the time since the frame before."""

  away_px: tuple[float, float] = (0.0, 0.0)
  speed_px_s: float = 0.0
  valid: bool = True
  moving: bool = False
  gap_s: float = 0.04


REST = Frame()


def nulls(frames: Iterable[Frame]) -> list[float]:
  """The times of the nulls in a sequence of frames that begins at 0 s."""
  limits = config.Stillness()
  detector = stillness.StillnessDetector(limits, config.Tracking().max_gap_s)
  time_s, out = -0.04, []
  for each in frames:
    time_s += each.gap_s
    track = klt.Track(
      time_s, ANCHOR_PX + each.away_px, each.speed_px_s, 20, 0.9, each.valid
    )
    if detector.step(track, ANCHOR_PX, each.moving):
      out.append(time_s)
  return out


def test_the_limits_are_the_papers() -> None:
  assert config.Stillness() == config.Stillness(15.0, 2.5, 3.0)
  assert config.Tracking().min_quality == 0.2


def test_a_rest_of_3_s_is_a_null_and_no_sooner() -> None:
  # The first frame has none before it, so the rest begins with the second.
  (time_s,) = nulls([REST] * 100)
  assert time_s == pytest.approx(3.0, abs=0.041)
  moved = [*[Frame(moving=True)] * 10, *[REST] * FRAMES]
  (time_s,) = nulls(moved)
  assert time_s == pytest.approx(0.4 + 3.0)
  assert nulls(moved[:-1]) == []


@pytest.mark.parametrize(
  ('width_px', 'speed_px_s', 'rests'),
  [(None, 2.4, True), (None, 2.6, False), (10.0, 2.4, True),
   (10.0, 2.6, False), (50.0, 9.9, True), (50.0, 10.1, False)],
)  # fmt: skip
def test_speed_may_be_limited_in_apparent_widths(
  width_px: float | None, speed_px_s: float, rests: bool
) -> None:
  limits = config.Stillness(max_widths_s=0.2)
  detector = stillness.StillnessDetector(limits, 0.2)
  found = [
    detector.step(
      klt.Track(
        0.04 * index, ANCHOR_PX, speed_px_s, 20, 0.9, True, width_px=width_px
      ),
      ANCHOR_PX,
      False,
    )
    for index in range(FRAMES + 1)
  ]
  assert any(found) is rests


def test_a_rest_is_one_null_however_long() -> None:
  assert len(nulls([REST] * 2000)) == 1


@pytest.mark.parametrize(
  ('away_px', 'near'),
  [
    ((15.0, 0.0), True),
    ((15.01, 0.0), False),
    ((0.0, -15.0), True),
    ((0.0, -15.01), False),
    ((10.6, 10.6), True),
    ((10.7, 10.7), False),  # 15.1 px on the diagonal.
  ],
)
def test_a_null_is_within_15_px_of_the_anchor(
  away_px: tuple[float, float], near: bool
) -> None:
  assert len(nulls([Frame(away_px)] * 200)) == near


@pytest.mark.parametrize(
  ('speed_px_s', 'still'), [(2.49, True), (2.5, False), (3.0, False)]
)
def test_a_null_is_slower_than_2_5_px_s(speed_px_s: float, still: bool) -> None:
  assert len(nulls([Frame(speed_px_s=speed_px_s)] * 200)) == still


@pytest.mark.parametrize(
  'breach',
  [
    Frame(speed_px_s=2.6),
    Frame(away_px=(0.0, 16.0)),
    Frame(valid=False),
    Frame(moving=True),
    Frame(gap_s=0.34),
  ],
  ids=['fast', 'far', 'lost', 'gesture', 'gap'],
)
def test_one_breach_begins_the_3_s_anew(breach: Frame) -> None:
  before = [REST] * (FRAMES - 2)
  assert nulls([*before, breach, *before]) == []
  (time_s,) = nulls([*before, breach, *[REST] * (FRAMES + 1)])
  last_s = 0.04 * (len(before) - 1) + breach.gap_s
  assert time_s == pytest.approx(last_s + 3.04, abs=0.041)


def test_a_short_gap_is_no_breach() -> None:
  frames = [REST] * 40 + [Frame(gap_s=0.28)] + [REST] * 40
  assert len(nulls(frames)) == 1


def test_each_gesture_allows_one_more_null() -> None:
  gesture = [Frame((0.0, 40.0), 90.0, moving=True)] * 50
  frames = [REST] * 100
  for _ in range(8):
    frames += gesture + [REST] * 100
  assert len(nulls(frames)) == 9


def test_a_breach_that_is_no_gesture_allows_no_second_null() -> None:
  for breach in (Frame(speed_px_s=2.6), Frame(valid=False), Frame(gap_s=1.0)):
    assert len(nulls([REST] * 100 + [breach] * 3 + [REST] * 200)) == 1


def test_nothing_is_confirmed_before_there_is_an_anchor() -> None:
  detector = stillness.StillnessDetector(config.Stillness(), 0.2)
  for index in range(200):
    lost = klt.Track(0.04 * index, ANCHOR_PX, 0.0, 0, 0.0, False)
    assert not detector.step(lost, None, False)
