"""Receivers that read somebody else's tracks."""

import numpy as np
import pytest
import tracks_kit as kit

from waggle_tasks import scenario
from waggle_tasks.agents import group, tracks
from waggle_tasks.protocol import frame, performance, schedule
from waggle_tasks.protocol.symbols import BITS, Symbol


def scene(language: str, payload: str = '101101') -> scenario.Scenario:
  return scenario.Scenario(language=language, payload=payload)


@pytest.mark.parametrize(
  ('name', 'width_px'),
  [
    ('view_bank', np.nan),
    pytest.param('absolute', np.nan, marks=pytest.mark.long),
    pytest.param('view_bank', 40.0, marks=pytest.mark.long),
  ],
)
def test_every_symbol_of_the_papers_language_is_read(
  name: str, width_px: float
) -> None:
  dance = scene('paper')
  times_s, places = kit.seen(dance.agreement, dance.performance)
  work = tracks.make(name, dance.agreement)
  events = [
    event
    for time_s, (x, y) in zip(times_s, places, strict=True)
    for event in work.step(tracks.place(x, y, width_px), float(time_s))
  ]
  assert [e.symbol for e in events] == [*frame.events(dance.message)]
  assert kit.said(events) == '101101'


@pytest.mark.parametrize('language', ['swift', 'brisk'])
def test_frames_are_read_as_a_whole(language: str) -> None:
  dance = scene(language)
  rows = kit.seen(dance.agreement, dance.performance, noise_px=0.5)
  assert kit.said(kit.read('joint', dance.agreement, rows)) == '101101'


@pytest.mark.parametrize('angle_deg', [0.0, 60.0])
@pytest.mark.parametrize('motion', ['broken off', 'a climb', 'a slope'])
@pytest.mark.parametrize(
  ('language', 'name'),
  [
    ('brisk', 'joint'),
    pytest.param('gentle', 'joint', marks=pytest.mark.slow),
    pytest.param('paper', 'view_bank', marks=pytest.mark.slow),
  ],
)
def test_what_is_only_like_a_symbol_makes_no_message(
  language: str, name: str, motion: str, angle_deg: float
) -> None:
  dance = scene(language)
  times_s, places = kit.seen(dance.agreement, dance.performance, angle_deg)
  slots = dance.performance.schedule.slots
  third = [slot for slot in slots if slot.gesture.symbol in BITS][2]
  share = (times_s - third.begin_s) / (third.end_s - third.begin_s)
  inside = (share > 0) & (share < 1)
  size_px = np.ptp(places[inside], axis=0).max()
  home, other = places[:20].mean(axis=0), places.copy()
  up = -size_px * np.sin(np.pi * share)
  if motion == 'broken off':
    other[inside & (share > 0.5)] = home
  else:
    aside = up if motion == 'a slope' else 0 * up
    other[inside] = home + np.stack([aside, up], axis=1)[inside]
  for rows, expected in ((places, '101101'), (other, None)):
    events = kit.read(name, dance.agreement, (times_s, rows))
    assert kit.said(events) == expected


@pytest.mark.parametrize(
  ('bits', 'flown'),
  [
    ('010110', (2, 7, 0, 3)),
    ('011111', (3, 7, 7, 0)),
    ('101101', (4, 4, 6, 1)),
  ],
)
def test_a_word_that_was_seen_is_not_mended(
  bits: str, flown: tuple[int, ...]
) -> None:
  # One level beside a word of the code, in one place or in two.
  dance = scene('swift')
  near = np.array(dance.agreement.word(bits))
  assert np.abs(near - flown).max() == 1
  slots = dance.agreement.spoken.fly([[Symbol.START, *flown, Symbol.END]])
  other = performance.Performance(schedule.Schedule(slots))
  rows = kit.seen(dance.agreement, other, angle_deg=0.0)
  assert kit.said(kit.read('joint', dance.agreement, rows)) is None


@pytest.mark.slow
def test_a_gap_that_hides_no_gesture_is_bridged_and_a_long_one_is_not() -> None:
  dance = scene('paper')
  times_s, places = kit.seen(dance.agreement, dance.performance)
  slots = dance.performance.schedule.slots
  rest_s = slots[2].end_s + 1.0
  for length_s, expected in ((1.0, '101101'), (9.0, None)):
    hidden = (times_s > rest_s) & (times_s < rest_s + length_s)
    cut = np.where(hidden[:, None], np.nan, places)
    events = kit.read('view_bank', dance.agreement, (times_s, cut))
    assert kit.said(events) == expected


def test_rows_that_are_left_out_are_as_places_not_seen() -> None:
  dance = scene('swift')
  times_s, places = kit.seen(dance.agreement, dance.performance)
  end_s = dance.performance.end_s
  kept = (times_s < end_s - 2.0) | (times_s > end_s)
  rows = times_s[kept], places[kept]
  assert kit.said(kit.read('joint', dance.agreement, rows)) is None


def test_a_track_that_begins_in_motion_gives_no_message() -> None:
  dance = scene('swift')
  times_s, places = kit.seen(dance.agreement, dance.performance)
  late = times_s > dance.performance.schedule.slots[0].begin_s + 0.3
  rows = times_s[late], places[late]
  assert kit.read('joint', dance.agreement, rows) == []


def test_places_grow_with_the_focal_length() -> None:
  dance = scenario.Scenario(
    language='swift', camera_width_px=320, camera_height_px=240
  )
  rows = kit.seen(dance.agreement, dance.performance, noise_px=0.1)
  assert kit.said(kit.read('joint', dance.agreement, rows)) == '000010'


@pytest.mark.parametrize('name', ['klt', 'klt_bank', 'klt:max_rmse=0.2'])
def test_receivers_that_follow_pixels_are_refused(name: str) -> None:
  with pytest.raises(group.ReceiverError, match=r"'absolute', 'view_bank'"):
    tracks.make(name)


@pytest.mark.parametrize(
  ('place', 'time_s', 'match'),
  [
    (np.zeros(2), 1.0, r'array \(3,\)'),
    (tracks.place(1.0, 2.0), 0.5, 'later than 0.5'),
    (tracks.place(1.0, 2.0), np.nan, 'finite number'),
  ],
)
@pytest.mark.parametrize('name', ['view_bank', 'joint'])
def test_what_is_no_place_is_refused(
  name: str, place: np.ndarray, time_s: float, match: str
) -> None:
  work = tracks.make(name)
  work.step(tracks.place(320.0, 240.0), 0.5)
  with pytest.raises(group.ReceiverError, match=match):
    work.step(place, time_s)


@pytest.mark.long
@pytest.mark.parametrize('view', ['upside down', 'upside down and mirrored'])
def test_no_payload_upside_down_is_another_one(view: str) -> None:
  for value in range(64):
    dance = scene('swift', f'{value:06b}')
    rows = kit.seen(dance.agreement, dance.performance, view=view)
    assert kit.said(kit.read('joint', dance.agreement, rows)) is None


# Up and down looks the same from behind; all else is mirrored there.
SAME_FROM_BEHIND = 'swift', 'rapid'


@pytest.mark.slow
@pytest.mark.parametrize('view', kit.VIEWS)
@pytest.mark.parametrize(
  ('language', 'name'),
  [
    ('swift', 'joint'),
    pytest.param('brisk', 'joint', marks=pytest.mark.long),
    pytest.param('paper', 'view_bank', marks=pytest.mark.long),
  ],
)
def test_a_camera_that_is_not_upright_reads_nothing_wrong(
  language: str, name: str, view: str
) -> None:
  for payload in ('101101', '010011')[: 1 if language == 'paper' else None]:
    dance = scene(language, payload)
    rows = kit.seen(dance.agreement, dance.performance, view=view)
    read = kit.said(kit.read(name, dance.agreement, rows))
    same = view == 'upright' or (
      view == 'behind' and language in SAME_FROM_BEHIND
    )
    assert read == (payload if same else None)
