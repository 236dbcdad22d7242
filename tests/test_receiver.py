"""The receiver on real images: which events it confirms, and when."""

from collections.abc import Callable

import numpy as np
import pytest

from waggle_tasks import errors
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.protocol import agreement, frame
from waggle_tasks.protocol.symbols import Symbol

BLACK = np.zeros((480, 640, 3), np.uint8)
Read = Callable[..., list[receiver.Event]]


@pytest.fixture
def read(agreed: agreement.Agreement) -> Read:
  """Feeds images and their times to a receiver of the short dance."""

  def run(
    images: list[np.ndarray], times_s: list[float], name: str = 'klt'
  ) -> list[receiver.Event]:
    reader = receivers.make(name, agreed)
    out = []
    for image, time_s in zip(images, times_s, strict=True):
      events = reader.step(image, time_s)
      assert isinstance(events, tuple)
      assert all(event.time_s == time_s for event in events)
      out += events
    return out

  return run


def names(events: list[receiver.Event]) -> str:
  return ' '.join(event.symbol for event in events)


def test_a_dance_is_read_as_it_is_flown(clip: object, read: Read) -> None:
  events = read(clip.images, clip.times_s)
  assert names(events) == 'NULL START NULL 0 NULL'
  times_s = [event.time_s for event in events]
  # Gestures end at 5.2 and 11.6 s; motion ends 0.68 s after it is slow, which
  # is a little before, and a null follows 3 s later.
  np.testing.assert_allclose(times_s, [3.0, 5.84, 8.84, 12.24, 15.24], atol=0.2)
  nulls_s = np.array(times_s[2::2]) - times_s[1::2]
  np.testing.assert_allclose(nulls_s, 3.0, atol=0.05)
  states = [event.state for event in events]
  assert states[0] is frame.State.START
  assert states[1:] == ['separator', 'bit', 'separator', 'bit']
  assert all(event.rejection is event.message is None for event in events)


def test_motions_carry_their_scores_and_nulls_none(
  clip: object, read: Read
) -> None:
  for event in read(clip.images, clip.times_s):
    if event.symbol is Symbol.NULL:
      assert event.recognition is None
      continue
    scores = event.recognition
    assert scores.symbol is scores.best is event.symbol
    assert scores.reason == ''
    assert 0 < scores.rmse < 0.05
    assert scores.margin > 0.2
    assert scores.closure < 0.05
    assert 60 < scores.span_px < 100


def test_the_same_images_are_read_the_same_way(
  clip: object, read: Read
) -> None:
  assert read(clip.images, clip.times_s) == read(clip.images, clip.times_s)


def test_black_images_are_read_as_nothing(read: Read) -> None:
  times_s = [0.04 * index for index in range(500)]
  assert read([BLACK] * 500, times_s) == []


def test_images_that_turn_black_end_in_an_unknown(
  clip: object, read: Read
) -> None:
  in_start = 105  # 4.2 s: at the top of START.
  images = clip.images[:in_start] + [BLACK] * 200
  events = read(images, clip.times_s[: len(images)])
  assert names(events) == 'NULL UNKNOWN'
  assert events[-1].recognition.reason == 'track lost: support 0 < 5'
  assert 'expected START, got UNKNOWN' in events[-1].rejection


def test_a_short_loss_is_survived(clip: object, read: Read) -> None:
  images = [*clip.images]
  images[150:153] = [BLACK] * 3  # Between two gestures.
  assert names(read(images, clip.times_s)) == 'NULL START NULL 0 NULL'


def test_images_that_are_missing_break_a_gesture(
  clip: object, read: Read
) -> None:
  """For 0.8 s of START's second half no image comes."""
  events = read(
    clip.images[:105] + clip.images[125:],
    clip.times_s[:105] + clip.times_s[125:],
  )
  assert names(events[:1]) == 'NULL'
  assert 'START' not in names(events)


def test_images_that_are_missing_delay_a_null(clip: object, read: Read) -> None:
  still = [clip.images[0]] * 150
  times_s = [
    0.04 * index + (1.0 if index >= 50 else 0.0) for index in range(150)
  ]
  (event,) = read(still, times_s)
  assert event.symbol is Symbol.NULL
  assert event.time_s == pytest.approx(50 * 0.04 + 1.0 + 3.0, abs=0.09)


def test_a_frozen_picture_is_a_single_null(clip: object, read: Read) -> None:
  times_s = [0.04 * index for index in range(2000)]
  assert names(read([clip.images[0]] * 2000, times_s)) == 'NULL'


@pytest.mark.slow
def test_noise_of_a_camera_does_not_spoil_reading(
  clip: object, read: Read
) -> None:
  rng = np.random.RandomState(0)
  noise = rng.normal(0.0, 1.0, (4, *BLACK.shape))
  noisy = [
    np.clip(np.rint(image + noise[index % 4]), 0, 255).astype(np.uint8)
    for index, image in enumerate(clip.images)
  ]
  assert names(read(noisy, clip.times_s)) == 'NULL START NULL 0 NULL'


@pytest.mark.parametrize(
  ('name', 'hint'), [('ktl', 'Did you mean klt'), ('neural', 'klt')]
)
def test_an_unknown_receiver_is_refused_with_the_names_there_are(
  name: str, hint: str
) -> None:
  with pytest.raises(errors.WaggleError, match=hint) as caught:
    receivers.make(name)
  assert str(caught.value).startswith('`receiver` must be one of [')
  assert repr(name) in str(caught.value)
