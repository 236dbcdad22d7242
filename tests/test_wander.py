"""Targets that hover as real ones do: what is a motion, and what is a rest."""

import math

import numpy as np
import pytest

from waggle_tasks.agents import config, excursion, klt, segmenter, stillness

WIDTH_PX = 36.0
HOME_PX = np.array([320.0, 240.0])
LEAST_S = 5.0
DURATION_S = 7.5
# Of the hover of real vehicles under motion capture, in px at 1.3 m.
SLOW_PX, FAST_PX = 3.0, 1.0


def hover_px(time_s: float, amount: float) -> np.ndarray:
  return amount * np.array(
    [
      SLOW_PX * math.sin(0.6 * time_s) + FAST_PX * math.sin(2.3 * time_s),
      SLOW_PX * math.cos(0.5 * time_s) + FAST_PX * math.sin(2.9 * time_s + 1),
    ]
  )


def v_px(time_s: float, begin_s: float) -> np.ndarray:
  """Out, home, out to the other side and home, with a stop at each corner."""
  corners = np.array([(0, 0), (-90, -90), (0, 0), (90, -90), (0, 0)], float)
  share = np.clip((time_s - begin_s) / DURATION_S, 0, 1) * 4
  leg = min(int(share), 3)
  s = share - leg
  smooth = s**3 * (10 - 15 * s + 6 * s**2)
  return corners[leg] + smooth * (corners[leg + 1] - corners[leg])


def watched(
  amount: float, seconds: float = 14.0, begin_s: float = 4.0
) -> tuple[list[segmenter.Segment], list[float]]:
  """The motions of a target that dances a V, and when its nulls came."""
  cut = excursion.ExcursionSegmenter(
    config.Excursion(), HOME_PX, WIDTH_PX, least_s=LEAST_S
  )
  rests = stillness.StillnessDetector(config.ABSOLUTE.stillness, 0.2)
  times_s = np.arange(0, seconds, 0.04)
  places = [HOME_PX + hover_px(t, amount) + v_px(t, begin_s) for t in times_s]
  segments, nulls = [], []
  tracks = []
  for time_s, place in zip(times_s, places, strict=True):
    past = places[max(len(tracks) - 10, 0)]
    elapsed_s = 0.04 * min(len(tracks), 10) or 1.0
    speed = float(np.hypot(*(place - past))) / elapsed_s
    track = klt.Track(
      float(time_s), place, speed, 9, 1.0, True, False, WIDTH_PX
    )
    tracks.append(track)
    if len(tracks) == 1:
      continue
    if (found := cut.step(track)) is not None:
      segments.append(found)
    moving = cut.active and not cut.returned
    if rests.step(track, HOME_PX, moving, cut.wander):
      nulls.append(float(time_s))
  return segments, nulls


@pytest.mark.parametrize('amount', [0.0, 0.25, 0.5, 1.0])
def test_a_gesture_is_one_motion_however_much_its_dancer_hovers(
  amount: float,
) -> None:
  (segment,), nulls = watched(amount)
  assert segment.loss is None
  assert segment.begin_s == pytest.approx(4.4, abs=0.5)
  assert segment.end_s == pytest.approx(11.4, abs=0.6)
  # It ends where it began, but for what it has wandered meanwhile.
  assert np.hypot(*(segment.path_px[-1] - segment.path_px[0])) < 20
  assert len(nulls) == 1  # Before it; there is no time for one after it.


@pytest.mark.parametrize('amount', [0.0, 0.5, 1.0])
def test_a_rest_is_proven_before_and_after(amount: float) -> None:
  _, nulls = watched(amount, seconds=16.0)
  assert len(nulls) == 2
  assert nulls[0] < 4.0
  assert 14.0 < nulls[1] < 15.6


def test_a_target_at_rest_for_long_never_moves() -> None:
  segments, nulls = watched(1.0, seconds=60.0, begin_s=1000.0)
  assert segments == []
  assert len(nulls) == 1


def test_a_wanderer_that_goes_half_a_width_aside_has_moved() -> None:
  """However much it has wandered before."""
  cut = excursion.ExcursionSegmenter(config.Excursion(), HOME_PX, WIDTH_PX)
  moved_s = []
  for time_s in np.arange(0, 30, 0.04):
    aside_px = np.array([0.7 * WIDTH_PX * min(max(time_s - 20, 0), 1), 0])
    place = HOME_PX + hover_px(time_s, 1.0) + aside_px
    cut.step(klt.Track(time_s, place, 3.0, 9, 1.0, True, False, WIDTH_PX))
    moved_s += [time_s] * cut.active
  assert cut.wander.sways
  assert 20 < moved_s[0] < 21


def test_what_was_seen_before_a_departure_tells_how_a_target_hovers() -> None:
  cut = excursion.ExcursionSegmenter(config.Excursion(), HOME_PX, WIDTH_PX)
  tracks = [
    klt.Track(
      time_s, HOME_PX + hover_px(time_s, 1.5) + v_px(time_s, 4.0), 3.0, 9, 1.0,
      True, False, WIDTH_PX,
    )
    for time_s in np.arange(0, 5, 0.04)
  ]  # fmt: skip
  cut.wander.prime(tracks, config.Excursion().lead_s)
  assert cut.wander.sways
  left_s = [t.time_s for t in tracks if cut.step(t) or cut.active]
  assert left_s[0] > 4.1
