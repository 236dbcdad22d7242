"""The receiver that knows every view: drawn dances, and what is no dance."""

from collections.abc import Callable, Sequence
import functools
import itertools
import math

import cv2
import numpy as np
import pytest

from waggle_tasks import appearance, scenario
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.experiments.episodes import evaluator, rollout
from waggle_tasks.protocol import (
  agreement,
  frame,
  gestures,
  payload,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import drift, surroundings

AGREED = agreement.Agreement()

BOOK = gestures.v_codebook(duration_s=2.0)
PAUSES = timing.Timing(3.2, 0.6, 2.0, 1.2)
AGREED = agreement.Agreement(BOOK, PAUSES)
FOCAL_PX = 240 / math.tan(math.radians(30))
WIDTH_M, HEIGHT_M = 0.137, 0.035
BLACK = np.zeros((480, 640, 3), np.uint8)
Path = Callable[[float], tuple[float, float]]  # Seconds -> x right, z up, m.


@functools.cache
def target() -> np.ndarray:
  """Something with dark and bright parts, and what it hides."""
  rng = np.random.RandomState(3)
  blocks = rng.randint(0, 256, (4, 12, 3)).astype(np.uint8)
  return cv2.resize(blocks, (96, 24), interpolation=cv2.INTER_NEAREST)


@functools.cache
def room(clutter: float = 0.0) -> np.ndarray:
  """A wall that grows lighter upwards, with soft stains."""
  rng = np.random.RandomState(4)
  light = np.linspace(150, 90, 480)[:, None, None]
  stains = cv2.GaussianBlur(rng.normal(0, 1, BLACK.shape), (0, 0), 4)
  wall = light + clutter * stains / stains.std()
  return np.clip(wall, 0, 255).astype(np.uint8)


def draw(
  x_m: float, z_m: float, distance_m: float, angle_deg: float, wall: np.ndarray
) -> np.ndarray:
  """A pinhole camera's picture of the target in the frontal plane."""
  angle = math.radians(angle_deg)
  scale = FOCAL_PX / (distance_m - x_m * math.sin(angle))
  u_px, v_px = 320 + scale * x_m * math.cos(angle), 240 - scale * z_m
  patch, image = target(), wall.copy()
  height, width = patch.shape[:2]
  zoom = scale * WIDTH_M / width, scale * HEIGHT_M / height
  half = math.ceil(scale * WIDTH_M / 2) + 2
  left, top = int(u_px) - half, int(v_px) - half
  matrix = np.array(
    [
      [zoom[0], 0, u_px - left - zoom[0] * (width - 1) / 2],
      [0, zoom[1], v_px - top - zoom[1] * (height - 1) / 2],
    ]
  )
  size = (2 * half, 2 * half)
  seen = cv2.warpAffine(patch, matrix, size, flags=cv2.INTER_AREA)
  ones = np.ones(patch.shape, np.float32)
  share = cv2.warpAffine(ones, matrix, size)
  rows = slice(max(top, 0), max(min(top + 2 * half, 480), 0))
  columns = slice(max(left, 0), max(min(left + 2 * half, 640), 0))
  inner = (
    slice(rows.start - top, rows.stop - top),
    slice(columns.start - left, columns.stop - left),
  )
  behind = image[rows, columns]
  if behind.size:
    mixed = seen[inner] * share[inner] + behind * (1 - share[inner])
    image[rows, columns] = np.rint(mixed)
  return image


def dance(symbols: Sequence[Symbol], book: gestures.Codebook = BOOK) -> Path:
  """The path of motion symbols, with the pauses of a message."""
  plan = schedule.broadcast(tuple(symbols), book, PAUSES)
  return lambda time_s: tuple(plan.motion(time_s)[0])


def message_path(bits: str) -> Path:
  return dance(frame.motions(payload.Payload.from_bits(bits)))


def length_s(motions: int) -> float:
  """Until the last null of so many motions is over."""
  pause_s = PAUSES.pause_s
  return PAUSES.initial_hover_s + motions * 2.0 + motions * pause_s + 0.4


MESSAGE_S = length_s(8)


def watch(
  path: Path,
  duration_s: float,
  distance_m: float = 1.3,
  angle_deg: float = 0.0,
  clutter: float = 0.0,
  sigma: float = 0.0,
  spoil: Callable[[np.ndarray, float], np.ndarray] | None = None,
  name: str = 'view_bank',
) -> list[receiver.Event]:
  """What a receiver of the drawn pictures confirms."""
  reader, events = receivers.make(name, AGREED), []
  rng = np.random.RandomState(0)
  noises = rng.normal(0, sigma, (5, *BLACK.shape)).astype(np.float32)
  last, image = None, BLACK
  for index in range(AGREED.frames(duration_s)):
    time_s = index * AGREED.frame_s
    place = path(time_s)
    if place != last:
      image = draw(*place, distance_m, angle_deg, room(clutter))
      last = place
    seen = image
    if sigma:
      noise = np.roll(noises[rng.randint(5)], rng.randint(10**6))
      seen = np.clip(np.rint(image + noise), 0, 255).astype(np.uint8)
    if spoil is not None:
      seen = spoil(seen, time_s)
    events += reader.step(seen, time_s)
  return events


def names(events: Sequence[receiver.Event]) -> str:
  return ' '.join(event.symbol for event in events)


def messages(events: Sequence[receiver.Event]) -> list[str]:
  return [event.message.bits for event in events if event.message]


def whole(bits: str) -> str:
  return ' '.join(frame.events(payload.Payload.from_bits(bits)))


@pytest.mark.parametrize(
  ('bits', 'view'),
  [
    ('101101', (1.3, 75.0)),
    ('011001', (2.6, -60.0)),
    ('110100', (0.6, 20.0)),
    ('010011', (0.8, -50.0)),
  ],
)
def test_a_message_is_read_from_every_view(
  bits: str, view: tuple[float, float]
) -> None:
  events = watch(message_path(bits), MESSAGE_S, *view)
  assert names(events) == whole(bits)
  assert messages(events) == [bits]
  last = events[-1]
  assert (last.distance_m, last.view_angle_deg) == (
    pytest.approx(view[0], rel=0.1),
    pytest.approx(view[1], abs=10),
  )
  for event in events[:-1]:
    assert event.distance_m is event.view_angle_deg is None
  scores = [event.recognition for event in events if event.recognition]
  assert max(each.rmse for each in scores) < 0.1
  assert min(each.margin for each in scores) > 0.15


@pytest.mark.slow
@pytest.mark.parametrize('view', [(1.3, 30.0), (2.6, 0.0)])
def test_noise_does_not_spoil_reading(view: tuple[float, float]) -> None:
  events = watch(
    dance([Symbol.START, Symbol.ONE]), length_s(2), *view, sigma=10
  )
  assert names(events) == 'NULL START NULL 1 NULL'


def test_clutter_behind_the_dancer_does_not_spoil_reading() -> None:
  path = dance([Symbol.START, Symbol.ZERO])
  events = watch(path, length_s(2), 1.6, -40.0, clutter=25.0)
  assert names(events) == 'NULL START NULL 0 NULL'


def test_rendered_images_are_read(clip: object, short: dict) -> None:
  reader = receivers.make('view_bank', agreement.Agreement(**short))
  events, errors_px = [], []
  for image, time_s, at_px in zip(
    clip.images, clip.times_s, clip.target_px, strict=True
  ):
    events += reader.step(image, time_s)
    if reader.track.valid and time_s > 5:
      errors_px.append(np.abs(reader.track.centre_px - at_px).max())
  assert names(events) == 'NULL START NULL 0 NULL'
  assert max(errors_px) < 4
  assert len(errors_px) > 240


@pytest.mark.slow
@pytest.mark.parametrize(
  'changes',
  [
    {'drift': drift.Drift(0.0, 0.002, 0.1)},
    {'drift': drift.Drift(0.002)},
    {'appearance': appearance.Appearance('clutter', 'clutter')},
    {'surroundings': surroundings.Surroundings(bystanders=4)},
  ],
  ids=['camera sways', 'dancer sways', 'clutter', 'bystanders'],
)
def test_the_first_stroke_is_read_whatever_else_is_seen(
  changes: dict[str, object],
  load: Callable,
  episode: Callable,
  hover: Callable,
  short: dict,
) -> None:
  environment = load(observers=1, seed=2, duration_s=9.4, **changes, **short)
  reader, events = receivers.make('view_bank', agreement.Agreement(**short)), []
  for timestep in episode(environment, hover):
    (own,) = timestep.observation
    events += reader.step(own['camera'], float(own['time_s']))
  assert names(events) == 'NULL START NULL'


@pytest.mark.long
@pytest.mark.parametrize('size', [(0.002, 0.1), (0.005, 0.3)])
@pytest.mark.parametrize('seed', range(2))
def test_swaying_cameras_read_the_message(
  seed: int, size: tuple[float, float]
) -> None:
  scene = scenario.Scenario(seed=seed, drift=drift.Drift(0.0, *size))
  verdict = evaluator.evaluate(scene, rollout.run(scene, 'view_bank'))
  assert [each.decoded for each in verdict.outcomes] == ['000010'] * 3


@pytest.mark.parametrize(
  ('aside_m', 'earlier_s', 'is_read'),
  [
    (0.36, 0.2, True),
    pytest.param(0.5, 0.0, True, marks=pytest.mark.long),
    (-0.5, -0.2, True),
    # Their ways cross.
    (-0.36, 0.2, False),
    (0.36, 1.0, False),
    # Who dances alone beside the middle may be anybody.
    pytest.param(0.36, 4.0, False, marks=pytest.mark.long),
    (-0.5, 4.0, False),
  ],
)
def test_of_two_dancers_the_one_in_the_middle_is_read_or_none(
  aside_m: float, earlier_s: float, is_read: bool
) -> None:
  other = message_path('110100')

  def beside(image: np.ndarray, time_s: float) -> np.ndarray:
    x_m, z_m = other(max(time_s + earlier_s, 0.0))
    return draw(aside_m + x_m, z_m, 2.7, 0.0, image)

  events = watch(message_path('001011'), MESSAGE_S, 2.7, spoil=beside)
  assert {*messages(events)} <= {'001011'}
  assert messages(events) or not is_read


@pytest.mark.long
def test_black_images_are_read_as_nothing() -> None:
  assert watch(message_path('000010'), 9.0, spoil=lambda *_: BLACK) == []


@pytest.mark.slow
def test_an_empty_room_is_read_as_nothing() -> None:
  assert watch(lambda _: (9.0, 0.0), 10.0) == []


def test_somebody_who_only_hovers_is_a_single_null() -> None:
  assert names(watch(lambda _: (0.0, 0.0), 12.0)) == 'NULL'


def test_pictures_that_turn_black_in_a_gesture_are_an_unknown() -> None:
  def spoil(image: np.ndarray, time_s: float) -> np.ndarray:
    return BLACK if time_s > 4.3 else image

  events = watch(message_path('000010'), 10.0, spoil=spoil)
  assert names(events) == 'NULL UNKNOWN'
  reason = events[-1].recognition.reason
  assert reason == 'track lost: not to be seen for 0.52 s'


@pytest.mark.parametrize(
  ('begin_s', 'lasts_s'),
  [(4.3, 0.12), (6.0, 0.8)],
  ids=['in START', 'before the null is due'],
)
def test_the_dancer_is_found_again(begin_s: float, lasts_s: float) -> None:
  def spoil(image: np.ndarray, time_s: float) -> np.ndarray:
    return BLACK if begin_s < time_s <= begin_s + lasts_s else image

  pauses_s = PAUSES.pause_s
  path = dance([Symbol.START, Symbol.ONE])

  def late(time_s: float) -> tuple[float, float]:
    """The same with a longer pause, so that a null can begin again."""
    shift_s = min(max(time_s - 5.5, 0.0), 2.0)
    return path(time_s - shift_s)

  events = watch(late, length_s(2) + pauses_s, spoil=spoil)
  assert names(events) == 'NULL START NULL 1 NULL'


def circle(time_s: float) -> tuple[float, float]:
  """Once around, down and back to rest."""
  turn = 2 * math.pi * min(max((time_s - 3.2) / 2.0, 0.0), 1.0)
  return 0.25 * math.sin(turn), 0.25 * (math.cos(turn) - 1)


def straight(x_m: float, z_m: float) -> Path:
  corners = ((0.0, 0.0), (x_m, z_m), (0.0, 0.0))
  gesture = gestures.Gesture(Symbol.START, corners, 2.0)
  plan = schedule.Schedule((schedule.Slot(gesture, 3.2),))
  return lambda time_s: tuple(plan.motion(time_s)[0])


NO_SYMBOLS = {
  'circle': circle,
  'diagonal up': straight(0.3, 0.3),
  'diagonal down': straight(-0.3, -0.3),
  'one arm of a V': straight(-0.285, 0.285),
  'down and back': straight(0.0, -0.5),
  'to one side and back': straight(0.5, 0.0),
}


@pytest.mark.slow
@pytest.mark.parametrize('path', NO_SYMBOLS.values(), ids=NO_SYMBOLS)
@pytest.mark.parametrize('view', [(1.3, 0.0), (1.0, 50.0)])
def test_other_motions_are_unknown(
  path: Path, view: tuple[float, float]
) -> None:
  events = watch(path, 9.5, *view)
  assert names(events) == 'NULL UNKNOWN NULL'
  assert events[1].rejection.startswith('expected START, got UNKNOWN')


def test_one_motion_that_is_no_symbol_costs_the_message() -> None:
  """The fourth bit is a circle; all the rest is as it should be."""
  path = message_path('101010')
  begin_s = 3.2 + 4 * (2.0 + PAUSES.pause_s)

  def spoiled(time_s: float) -> tuple[float, float]:
    if begin_s <= time_s < begin_s + 2.0:
      return circle(time_s - begin_s + 3.2)
    return path(time_s)

  events = watch(spoiled, MESSAGE_S)
  assert names(events).count('UNKNOWN') == 1
  assert messages(events) == []


@pytest.mark.slow
@pytest.mark.parametrize('seed', range(2))
def test_a_random_walk_is_unknown(seed: int) -> None:
  rng = np.random.RandomState(seed)
  places = np.cumsum(rng.normal(0, 0.1, (20, 2)), axis=0)
  rest = np.zeros((3, 2))
  places = np.concatenate([rest, places, rest, rest])
  moments = np.arange(len(places)) * 1.6

  def walk(time_s: float) -> tuple[float, float]:
    x, z = (np.interp(time_s, moments, each) for each in places.T)
    return float(x), float(z)

  events = watch(walk, moments[-1], 1.6, 20.0)
  assert names(events) == 'NULL UNKNOWN NULL'


@pytest.mark.parametrize(
  'symbols',
  [
    'START 0 1 0 1 0 END',
    'START 0 1 0 1 0 1 1 END',
    'START START 1 0 1 0 END',
    'END 0 1 0 1 0 1 START',
  ],
)
def test_frames_with_wrong_symbols_are_no_message(symbols: str) -> None:
  motions = [Symbol(each) for each in symbols.split()]
  events = watch(dance(motions), length_s(len(motions)))
  seen = [e.symbol for e in events if e.symbol is not Symbol.NULL]
  assert seen == motions
  assert messages(events) == []


def test_a_flight_that_ends_elsewhere_is_unknown() -> None:
  def leave(time_s: float) -> tuple[float, float]:
    share = min(max((time_s - 3.2) / 3.0, 0.0), 1.0)
    return 0.4 * share**2 * (3 - 2 * share), 0.0

  events = watch(leave, 14.0)
  assert names(events) == 'NULL UNKNOWN'


def test_its_numbers_can_be_changed_and_no_others() -> None:
  path = dance([Symbol.START])
  strict = watch(path, 7.0, name='view_bank:max_rmse=0.0001')
  assert names(strict) == 'NULL UNKNOWN'
  assert 'RMSE' in strict[-1].recognition.reason
  coarse = watch(path, 7.0, name='view_bank:min_span_widths=9')
  assert ' px < 9 widths of ' in coarse[-1].recognition.reason
  with pytest.raises(receivers.ReceiverError, match='receiver number'):
    receivers.make('view_bank:corner_quality=0.1')
  with pytest.raises(receivers.ReceiverError, match='receiver number'):
    receivers.make('klt:max_angle_deg=30')


@pytest.mark.long
@pytest.mark.parametrize('sigma', [0.0, 5.0, 10.0])
@pytest.mark.parametrize(
  ('distance_m', 'angle_deg'),
  [*itertools.product((0.6, 1.0, 1.6, 3.0), (0.0, 30.0, 60.0, 75.0))],
)
def test_the_envelope(
  distance_m: float, angle_deg: float, sigma: float
) -> None:
  rng = np.random.RandomState(int(distance_m * 100 + angle_deg + sigma))
  bits = ''.join(rng.choice(['0', '1'], 4)) + '01'
  angle_deg *= rng.choice([-1, 1])
  events = watch(
    message_path(bits), MESSAGE_S, distance_m, angle_deg, sigma=sigma
  )
  assert messages(events) == [bits]


@pytest.mark.long
def test_a_camera_that_freezes_after_the_last_gesture_gives_no_message() -> (
  None
):
  path, end_s = message_path('000010'), MESSAGE_S - PAUSES.pause_s - 0.4
  last = []

  def freeze(image: np.ndarray, time_s: float) -> np.ndarray:
    if time_s < end_s + 1.0:
      last[:] = [image]
    return last[0]

  read = functools.partial(watch, path, MESSAGE_S, sigma=5, spoil=freeze)
  assert messages(read()) == []
  assert messages(read(name='view_bank:max_stale_s=0')) == ['000010']
