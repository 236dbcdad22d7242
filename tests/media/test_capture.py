"""Raw captures: exact, small, and never silently wrong."""

from collections.abc import Callable
import pathlib
import types

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

from waggle_tasks import scenario, sensor
from waggle_tasks.agents import navigator, observer_agent
from waggle_tasks.experiments.episodes import rollout
from waggle_tasks.experiments.record import capture, episode

SHAPE = (480, 640, 3)


def write(path: pathlib.Path, images: list[np.ndarray]) -> pathlib.Path:
  with capture.Writer(path) as writer:
    for number, image in enumerate(images):
      writer.write(image, number * 0.04)
  return path


@pytest.fixture(scope='module')
def small(tmp_path_factory: pytest.TempPathFactory) -> bytes:
  """The bytes of a capture of three images."""
  image = np.zeros(SHAPE, np.uint8)
  moved = image.copy()
  moved[100:120, 200:240] = 7
  path = tmp_path_factory.mktemp('capture') / 'x.capture'
  return write(path, [image, moved, moved]).read_bytes()


@pytest.mark.slow
def test_every_image_and_time_comes_back_exactly(
  clip: object, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.capture'
  with capture.Writer(path) as writer:
    for image, time_s in zip(clip.images, clip.times_s, strict=True):
      writer.write(image, time_s)
  count = 0
  for image, time_s in capture.read(path):
    np.testing.assert_array_equal(image, clip.images[count])
    assert time_s == clip.times_s[count]
    count += 1
  assert count == len(clip.images)


@pytest.mark.parametrize('shape', [(240, 320, 3), (441, 333, 3), (16, 17, 3)])
def test_images_of_any_size_come_back_exactly(
  shape: tuple[int, ...], tmp_path: pathlib.Path
) -> None:
  images = [np.full(shape, 50, np.uint8) for _ in range(4)]
  images[1][3, 5] = images[2][-1, -1] = images[3][:, 0] = 7
  path = write(tmp_path / 'x.capture', images)
  seen = [image.copy() for image, _ in capture.read(path)]
  np.testing.assert_array_equal(seen, images)


@pytest.mark.parametrize(
  ('row', 'column', 'channel'),
  [(0, 0, 0), (479, 639, 2), (0, 639, 1), (479, 0, 0), (7, 2, 2), (7, 3, 0)],
)
def test_a_change_of_a_single_value_anywhere_is_kept(
  row: int, column: int, channel: int, tmp_path: pathlib.Path
) -> None:
  before = np.full(SHAPE, 50, np.uint8)
  after = before.copy()
  after[row, column, channel] = 51
  path = write(tmp_path / 'x.capture', [before, after, before])
  images = [image.copy() for image, _ in capture.read(path)]
  np.testing.assert_array_equal(images, [before, after, before])


def test_noise_is_kept_too(tmp_path: pathlib.Path) -> None:
  random = np.random.RandomState(0)
  images = [random.randint(0, 256, SHAPE).astype(np.uint8) for _ in range(3)]
  path = write(tmp_path / 'x.capture', images)
  for (image, _), wanted in zip(capture.read(path), images, strict=True):
    np.testing.assert_array_equal(image, wanted)


def test_a_capture_is_a_hundredth_of_its_images(
  clip: object, tmp_path: pathlib.Path
) -> None:
  path = write(tmp_path / 'x.capture', clip.images)
  assert path.stat().st_size < 0.01 * sum(i.nbytes for i in clip.images)


def test_it_holds_the_images_that_a_receiver_took_and_no_more(
  recorded: object,
) -> None:
  seeing, blind = capture.paths(recorded.folder)
  times_s = [time_s for _, time_s in capture.read(seeing)]
  message_s = recorded.verdict.outcomes[0].final_null_s
  assert times_s == list(recorded.rollout.traces['observer_1'].times_s)
  assert times_s[-1] == message_s
  images = [image.max() for image, _ in capture.read(blind)]
  assert len(images) == len(recorded.rollout.times_s)
  assert max(images) == 0


@pytest.mark.slow
def test_images_that_come_again_are_held_once(tmp_path: pathlib.Path) -> None:
  spoils = sensor.Sensor(dropped_share=0.5, late_frames=2)
  scene = scenario.Scenario(observers=1, duration_s=1.0, sensor=spoils)
  with capture.Recorder(tmp_path) as recorder:
    played = rollout.run(scene, 'klt', [recorder])
  (path,) = capture.paths(tmp_path)
  times_s = [time_s for _, time_s in capture.read(path)]
  assert times_s == list(played.traces['observer_1'].times_s)
  assert 5 < len(times_s) < 20


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_changed_byte_anywhere_is_noticed(
  small: bytes,
  tmp_path_factory: pytest.TempPathFactory,
  data: st.DataObject,
) -> None:
  place = data.draw(st.integers(0, len(small) - 1))
  bit = data.draw(st.integers(0, 7))
  damaged = bytearray(small)
  damaged[place] ^= 1 << bit
  path = tmp_path_factory.mktemp('damaged') / 'x.capture'
  path.write_bytes(bytes(damaged))
  with pytest.raises(capture.CaptureError, match=r'is damaged|cut short|not a'):
    list(capture.read(path))


@pytest.mark.parametrize('share', [0.0, 0.001, 0.1, 0.5, 0.9, 0.999])
def test_a_capture_that_is_cut_short_is_refused(
  small: bytes, share: float, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.capture'
  path.write_bytes(small[: int(share * len(small))])
  with pytest.raises(capture.CaptureError, match=r'cut short|not a capture'):
    list(capture.read(path))


def test_an_unfinished_capture_has_no_end(tmp_path: pathlib.Path) -> None:
  path = tmp_path / 'x.capture'

  def interrupted() -> None:
    with capture.Writer(path) as writer:
      writer.write(np.zeros(SHAPE, np.uint8), 0.0)
      raise KeyboardInterrupt

  with pytest.raises(KeyboardInterrupt):
    interrupted()
  with pytest.raises(capture.CaptureError, match='cut short after 1 images'):
    list(capture.read(path))


@pytest.mark.parametrize(
  ('make', 'match'),
  [
    (lambda path: path.write_bytes(b''), 'is not a capture'),
    (lambda path: path.write_bytes(b'RIFF' * 100), 'is not a capture'),
    (lambda path: path.mkdir(), 'cannot be read: Is a directory'),
    (lambda path: None, 'cannot be read: No such file'),
  ],
)
def test_what_is_no_capture_is_refused(
  make: Callable[[pathlib.Path], None], match: str, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.capture'
  make(path)
  with pytest.raises(capture.CaptureError, match=match):
    list(capture.read(path))


def test_a_run_without_captures_says_how_to_make_them(
  tmp_path: pathlib.Path,
) -> None:
  with pytest.raises(capture.CaptureError, match='`waggle broadcast --raw`'):
    capture.paths(tmp_path)


class Trackless:
  """A receiver that says nothing of where it looks."""

  track = None
  segment = None

  def step(self, image: np.ndarray, time_s: float) -> tuple[()]:
    del image, time_s
    return ()


def test_what_a_receiver_without_a_track_takes_is_captured(
  tmp_path: pathlib.Path,
) -> None:
  agent = observer_agent.ObserverAgent(Trackless(), navigator.Navigator())
  team = types.SimpleNamespace(agents=[agent])
  body = types.SimpleNamespace(mjcf_model=types.SimpleNamespace(model='a_1'))
  room = types.SimpleNamespace(task=types.SimpleNamespace(observers=[body]))
  with capture.Recorder(tmp_path) as recorder:
    for frame in range(3):
      seen = {
        'camera': np.full(SHAPE, frame, np.uint8),
        'time_s': np.array(frame * 0.04),
        'position_m': np.zeros(3),
      }
      agent.step(seen)
      timestep = types.SimpleNamespace(
        first=lambda frame=frame: frame == 0, observation=[seen]
      )
      recorder(episode.Step(room, timestep, team))
  (path,) = capture.paths(tmp_path)
  assert [image[0, 0, 0] for image, _ in capture.read(path)] == [0, 1, 2]


def test_a_capture_of_a_newer_program_says_so(
  small: bytes, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.capture'
  path.write_bytes(small.replace(b'capture 1', b'capture 12', 1))
  error = 'must be 1 for this program: got 12, .* update waggle-tasks'
  with pytest.raises(capture.CaptureError, match=error):
    next(capture.read(path))
