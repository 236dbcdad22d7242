"""What spoils an observer's images does what it says, and nothing else."""

from collections.abc import Callable
import dataclasses
import math

from dm_control import composer
import numpy as np
import pytest

from waggle_tasks import scenario, sensor, suites
from waggle_tasks.entities import feed
from waggle_tasks.experiments.episodes import rollout

Fixture = Callable[..., object]
Load = Callable[..., composer.Environment]
Film = Callable[[composer.Environment], np.ndarray]
Sensor = sensor.Sensor
SHAPE = (480, 640, 3)
EVERYTHING = Sensor(
  step_gain=0.9,
  step_s=0.2,
  flicker_share=0.05,
  flicker_hz=3.0,
  exposure_s=0.02,
  noise_sigma=3.0,
  photons=2000.0,
  blackout_s=0.3,
  blackout_length_s=0.1,
  blackout_every_s=0.7,
  blackout_share=0.3,
  repeated_share=0.1,
  freeze_s=0.6,
  freeze_length_s=0.2,
  late_frames=2,
  dropped_share=0.1,
)


def deliver(
  chosen: Sensor, frames: int = 250, seed: int = 0, level: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
  """What comes of pictures that show the number of their frame, or a level.

  Returns:
    (frames, 2, 4, 3) the images and (frames,) the frames of their times.
  """
  random_state = np.random.RandomState(seed)
  each = feed.Feed(chosen, random_state)
  images, times_s = [], []
  for frame in range(frames):
    each.advance(round(frame * 0.04, 6))
    picture = np.full((2, 4, 3), frame if level is None else level, np.uint8)
    images.append(each.image(picture).copy())
    times_s.append(each.time_s)
  return np.array(images), np.rint(np.array(times_s) / 0.04).astype(int)


def shown(chosen: Sensor, frames: int = 250) -> tuple[np.ndarray, np.ndarray]:
  """The frame that each image shows and the frame that its time names."""
  images, told = deliver(chosen, frames)
  return images[:, 0, 0, 0].astype(int), told


@pytest.mark.slow
@pytest.mark.parametrize(
  'chosen',
  [
    Sensor(),
    Sensor(step_s=1.0, flicker_hz=7.0, blackout_s=0.1, freeze_s=0.1),
    Sensor(blackout_length_s=9.0, blackout_share=0.0),
  ],
)
def test_with_all_off_nothing_stands_between(
  chosen: Sensor, dancing: Load, film: Film
) -> None:
  environment = dancing(sensor=chosen)
  np.testing.assert_array_equal(film(environment), film(dancing()))
  seen = environment.task.observers[0].observables
  assert seen.camera.corruptor is None
  assert seen.time_s.corruptor is None


@pytest.mark.slow
def test_noise_on_rendered_images_is_each_observers_own(
  dancing: Load, film: Film
) -> None:
  noisy = film(dancing(sensor=Sensor(noise_sigma=5.0), duration_s=0.08))
  clean = film(dancing(duration_s=0.08))
  added = noisy.astype(float) - clean
  grey = (clean > 30) & (clean < 225)  # Far from clipping.
  assert added[grey].std() == pytest.approx(5.0, rel=0.02)
  first, second = added.reshape(2, -1)
  assert abs(np.corrcoef(first, second)[0, 1]) < 0.005


def test_a_step_changes_brightness_from_its_time_on() -> None:
  images, _ = deliver(Sensor(step_gain=1.5, step_s=2.0), 100, level=100)
  assert (images[:50] == 100).all()
  assert (images[50:] == 150).all()


def test_flicker_is_a_sine_of_its_frequency() -> None:
  chosen = Sensor(flicker_share=0.2, flicker_hz=3.0)
  images, _ = deliver(chosen, 250, level=100)
  levels = images[:, 0, 0, 0].astype(float)
  assert (levels.min(), levels.max()) == pytest.approx((80, 120), abs=1)
  spectrum = np.abs(np.fft.rfft(levels - levels.mean()))
  assert spectrum.argmax() == 30  # 3 Hz in 10 s.


@pytest.mark.parametrize(('exposure_s', 'share'), [(0.04, 0.5), (0.02, 0.25)])
def test_exposure_blends_in_the_image_before(
  exposure_s: float, share: float
) -> None:
  each = feed.Feed(Sensor(exposure_s=exposure_s), np.random.RandomState(0))
  levels = []
  for frame, level in enumerate([0, 200, 0, 0]):
    each.advance(frame * 0.04)
    picture = np.full((2, 4, 3), level, np.uint8)
    levels.append(int(each.image(picture).max()))
  assert levels == [0, 200 * (1 - share), 200 * share, 0]


@pytest.mark.parametrize(('share', 'columns'), [(1.0, 4), (0.5, 2)])
def test_a_blackout_blackens_its_share_for_its_length(
  share: float, columns: int
) -> None:
  chosen = Sensor(blackout_s=1.0, blackout_length_s=2.0, blackout_share=share)
  images, told = deliver(chosen, 100, level=90)
  expected = np.full_like(images, 90)
  expected[25:75, :, :columns] = 0
  np.testing.assert_array_equal(images, expected)
  assert [*told] == [*range(100)]  # It goes on being told the time.


def test_a_blackout_comes_again_as_often_as_it_is_asked_to() -> None:
  chosen = Sensor(blackout_s=1.0, blackout_length_s=0.4, blackout_every_s=1.5)
  images, _ = deliver(chosen, 120, level=90)
  black = np.flatnonzero(~images.any(axis=(1, 2, 3)))
  # From 1.0, 2.5 and 4.0 s on; 2.5 s lies between two frames.
  assert [*black] == [*range(25, 35), *range(62, 72), *range(100, 110)]


def test_a_blackout_that_comes_again_begins_as_one_that_does_not() -> None:
  for begin_s in (0.0, 0.31, 0.33, 1.02):
    once = Sensor(blackout_s=begin_s, blackout_length_s=0.5)
    often = dataclasses.replace(once, blackout_every_s=10.0)
    np.testing.assert_array_equal(
      deliver(often, 100, level=90)[0], deliver(once, 100, level=90)[0]
    )


def test_a_frozen_picture_has_new_times() -> None:
  frames, told = shown(Sensor(freeze_s=1.0, freeze_length_s=2.0), 100)
  assert [*frames] == [*range(25), *[25] * 50, *range(75, 100)]
  assert [*told] == [*range(100)]


@pytest.mark.slow
def test_a_picture_can_freeze_for_good(dancing: Load, film: Film) -> None:
  frozen = film(dancing(sensor=Sensor(freeze_length_s=sensor.ALWAYS_S)))
  clean = film(dancing())
  np.testing.assert_array_equal(frozen, clean[:, :1].repeat(11, axis=1))


def test_repeated_pictures_have_new_times() -> None:
  frames, told = shown(Sensor(repeated_share=0.3))
  assert [*told] == [*range(250)]
  again = np.diff(frames) == 0
  assert again.mean() == pytest.approx(0.3, abs=0.07)
  assert (frames[1:][~again] == told[1:][~again]).all()


@pytest.mark.parametrize(
  'chosen',
  [
    Sensor(dropped_share=0.3),
    Sensor(late_frames=3),
    Sensor(late_frames=2, dropped_share=0.5),
  ],
)
def test_dropped_and_late_images_keep_their_own_times(chosen: Sensor) -> None:
  frames, told = shown(chosen)
  np.testing.assert_array_equal(frames, told)
  assert (np.diff(told) >= 0).all()


def test_drops_are_as_many_as_asked_for() -> None:
  frames, _ = shown(Sensor(dropped_share=0.3))
  assert (np.diff(frames) == 0).mean() == pytest.approx(0.3, abs=0.07)
  frames, _ = shown(Sensor(dropped_share=1.0))
  assert not frames.any()


def test_late_images_are_late_by_as_much_as_asked_for() -> None:
  frames, _ = shown(Sensor(late_frames=3), 50)
  assert [*frames] == [0, 0, 0, *range(47)]


def test_the_noise_of_a_dropped_image_does_not_change() -> None:
  each = feed.Feed(
    Sensor(noise_sigma=9.0, dropped_share=1.0), np.random.RandomState(0)
  )
  seen = []
  for frame in range(3):
    each.advance(frame * 0.04)
    seen.append(each.image(np.full(SHAPE, 90, np.uint8)).copy())
  np.testing.assert_array_equal(seen, [seen[0]] * 3)


@pytest.mark.slow
@pytest.mark.parametrize('other', [{'noise_sigma': 5.0}, {'photons': 100.0}])
def test_one_disturbance_does_not_change_what_another_draws(
  other: dict[str, float], dancing: Load, episode: Fixture, hover: Fixture
) -> None:
  told = [
    [step.observation[0]['time_s'] for step in episode(environment, hover)]
    for environment in (
      dancing(sensor=Sensor(dropped_share=0.5)),
      dancing(sensor=Sensor(dropped_share=0.5, **other)),
    )
  ]
  assert told[0] == told[1]
  assert len({*map(float, told[0])}) < 11


@pytest.mark.slow
def test_images_and_times_follow_from_the_seed(
  dancing: Load, film: Film
) -> None:
  first, again, other = (
    dancing(sensor=EVERYTHING, seed=seed) for seed in (0, 0, 1)
  )
  expected = film(first)
  np.testing.assert_array_equal(film(again), expected)
  assert (film(other) != expected).any()
  assert (film(first) != expected).any()  # Another episode, another draw.


def test_a_spoilt_episode_leaves_the_next_one_clean(
  dancing: Load, film: Film
) -> None:
  environment = dancing()
  expected = film(environment)
  environment.task.observers[0].sensor = EVERYTHING
  spoilt = film(environment)
  environment.task.observers[0].sensor = Sensor()
  clean = film(environment)
  assert (spoilt[0] != expected[0]).any()
  np.testing.assert_array_equal(spoilt[1], expected[1])  # The other's eye.
  np.testing.assert_array_equal(clean, expected)


def test_an_observer_always_knows_where_it_is(
  load: Load, episode: Fixture, flyer: Fixture
) -> None:
  spoils = Sensor(late_frames=3, repeated_share=0.2, freeze_length_s=600.0)
  environment = load(cameras=False, observers=1, duration_s=2.0, sensor=spoils)
  travelled_m = []
  for step in episode(environment, flyer((0.0, 0.3, 0.0), 0.0)):
    (seen,) = step.observation
    true_m = environment.task.positions_m(environment.physics)['observer_1']
    np.testing.assert_allclose(seen['position_m'], true_m, atol=1e-9)
    travelled_m.append(true_m[1])
  assert travelled_m[-1] - travelled_m[0] > 0.1


def test_black_input_is_black_whatever_else_is_spoilt(
  load: Load, episode: Fixture, hover: Fixture
) -> None:
  environment = load('black_input', duration_s=0.2, sensor=EVERYTHING)
  for step in episode(environment, hover):
    first, black, _ = (each['camera'].max() for each in step.observation)
    assert black == 0
    assert first > 100


@pytest.mark.slow
@pytest.mark.parametrize('receiver', ['klt', 'view_bank'])
def test_an_episode_with_everything_spoilt_is_flown(receiver: str) -> None:
  scene = scenario.Scenario(observers=2, duration_s=1.2, sensor=EVERYTHING)
  played = rollout.run(scene, receiver)
  assert len(played.times_s) == 31
  for trace in played.traces.values():
    assert (np.diff(trace.times_s) > 0).all()  # None was read twice.
    assert len(trace.times_s) < 31


@pytest.mark.parametrize(
  ('changes', 'error'),
  [
    ({'noise_sigma': -1.0}, '`noise_sigma` must be between 0 and 128: got -1'),
    ({'noise_sigma': 129.0}, '`noise_sigma` must be between 0 and 128'),
    ({'noise_sigma': math.nan}, '`noise_sigma` must be a finite number'),
    ({'photons': 2.0}, '`photons` must be 0 or at least 10: got 2.0'),
    ({'photons': 1e7}, '`photons` must be between 0 and 1e'),
    ({'exposure_s': 0.2}, '`exposure_s` must be between 0 and 0.1: got 0.2'),
    ({'step_gain': 0.0}, '`step_gain` must be between 0.1 and 10: got 0.0'),
    ({'step_s': -1.0}, '`step_s` must be between 0 and 600: got -1.0'),
    ({'flicker_share': 1.1}, '`flicker_share` must be between 0 and 1'),
    ({'flicker_hz': -3.0}, '`flicker_hz` must be between 0 and 1000'),
    ({'dropped_share': 2.0}, '`dropped_share` must be between 0 and 1: got 2'),
    ({'repeated_share': '1'}, "`repeated_share` must be .* number: got '1'"),
    ({'late_frames': 1.0}, '`late_frames` must be an integer: got 1.0'),
    ({'late_frames': 26}, '`late_frames` must be between 0 and 25: got 26'),
    ({'freeze_s': math.inf}, '`freeze_s` must be a finite number: got inf'),
    ({'freeze_length_s': 601}, '`freeze_length_s` must be between 0 and 600'),
    ({'blackout_s': -0.1}, '`blackout_s` must be between 0 and 600: got -0.1'),
    ({'blackout_length_s': -1}, '`blackout_length_s` must be between 0 and'),
    ({'blackout_share': 1.5}, '`blackout_share` must be between 0 and 1'),
    (
      {'blackout_every_s': 2, 'blackout_length_s': 2},
      '`blackout_every_s` must be 0, or more than .* 2: got 2',
    ),
  ],
)
def test_a_disturbance_of_no_sensible_size_is_refused(
  changes: dict[str, object], error: str
) -> None:
  with pytest.raises(sensor.SensorError, match=error):
    Sensor(**changes)


def test_a_suite_can_name_any_disturbance() -> None:
  row = {'name': 'bad', 'sensor': {'noise_sigma': 5, 'late_frames': 2}}
  (case,) = suites.from_rows([row])
  assert case.scene.sensor == Sensor(noise_sigma=5, late_frames=2)
  with pytest.raises(suites.SuiteError, match='Did you mean noise_sigma'):
    suites.from_rows([{'name': 'bad', 'sensor': {'noise_sigmas': 5}}])


def test_a_late_image_that_nobody_asked_for_is_the_present_one() -> None:
  each = feed.Feed(Sensor(late_frames=1), np.random.RandomState(0))
  came = []
  for frame in range(6):
    each.advance(frame * 0.04)
    if frame % 2 == 0:  # As with an update interval of two frames.
      picture = np.full((2, 4, 3), frame, np.uint8)
      came.append(each.image(picture)[0, 0, 0])
  assert came == [0, 2, 4]
