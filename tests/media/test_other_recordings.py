"""Times of pictures, events, a camera, and films without a rest."""

from collections.abc import Callable, Iterator
import dataclasses
import pathlib
import subprocess
import sys

import cv2
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.record import fitting
from waggle_tasks.experiments.video import (
  decoding,
  event_film,
  live_camera,
  recordings,
)
from waggle_tasks.protocol import camera

kit = pytest.importorskip('recordings_kit', exc_type=ImportError)

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Part = recordings.RecordingPart
SMALL = (320, 240)
SEEN = camera.Camera(*SMALL, camera.Camera.focal_px / 2)


@dataclasses.dataclass(frozen=True, eq=False)
class Film:
  """A dance in swift, in small pictures.

  Attributes:
    images: (240, 320, 3) uint8 each.
    times_s: Their times.
    scene: What was flown.
  """

  images: list[np.ndarray]
  times_s: list[float]
  scene: scenario.Scenario

  def __iter__(self) -> Iterator[tuple[np.ndarray, float]]:
    return zip(self.images, self.times_s, strict=True)


@pytest.fixture(scope='module')
def film(tmp_path_factory: pytest.TempPathFactory) -> Film:
  scene = scenario.Scenario(observers=1, language='swift', payload='101101')
  dance = kit.fly(tmp_path_factory.mktemp('film') / 'x.capture', scene)
  pairs = [
    (cv2.resize(image, SMALL, None, 0, 0, cv2.INTER_AREA), time_s)
    for image, time_s in dance.images()
  ]
  return Film(*map(list, zip(*pairs, strict=True)), scene)


@pytest.fixture(scope='module')
def folder(
  film: Film, tmp_path_factory: pytest.TempPathFactory
) -> pathlib.Path:
  """Its pictures, with their times."""
  folder = tmp_path_factory.mktemp('pictures')
  lines = ['picture,time_s']
  for number, (image, time_s) in enumerate(film):
    name = f'at-{1000 - number:04}.png'  # In the wrong order by its number.
    cv2.imwrite(str(folder / name), image[..., ::-1])
    lines.append(f'{name},{100 + time_s:.3f}')
  (folder / 'times.csv').write_text('\n'.join(lines))
  return folder


def shown(
  source: object, film: Film, part: Part = Part(), name: str = 'joint'
) -> decoding.Decoded:
  """What is read of an open source."""
  with recordings.Recording(pathlib.Path('x'), None, source) as recording:
    return decoding.pictures(
      recording, part, [name], film.scene.agreement, SEEN
    )


def test_pictures_are_read_by_the_times_in_their_file(
  waggle: Waggle, folder: pathlib.Path
) -> None:
  child = waggle('decode', str(folder), '--agreement=swift')
  assert child.returncode == 0, child.stderr
  assert 'joint: message 101101' in child.stdout
  with pytest.raises(recordings.RecordingError, match='`fps` must not be'):
    recordings.Recording(folder, 25.0)


@pytest.mark.parametrize(
  ('line', 'match'),
  [
    ('a.png,1\nb.png,2', 'b.png has not a picture'),
    ('', 'a.png has not a time'),
    ('a.png', 'line 2: there must be the name'),
    ('a.png,soon', 'line 2: there must be the name'),
    ('a.png,1\na.png,2', 'line 3: a.png has a time already'),
    ('a.png,1\nc.png,1', 'times of their own: got a.png and c.png at 1 s'),
  ],
)
def test_times_that_are_none_are_refused(
  line: str, match: str, tmp_path: pathlib.Path
) -> None:
  names = ['a.png', 'c.png'] if 'c.png' in line else ['a.png']
  for name in names:
    cv2.imwrite(str(tmp_path / name), np.zeros((64, 64, 3), np.uint8))
  (tmp_path / 'times.csv').write_text(f'picture,time_s\n{line}\n')
  with pytest.raises(recordings.RecordingError, match=match):
    recordings.Recording(tmp_path)


@pytest.mark.parametrize(
  ('turn', 'reads'),
  [
    (lambda image: image[:, ::-1], '101101'),  # Up and down is the same.
    (lambda image: image[::-1, ::-1], None),
    (lambda image: image[::-1], None),
  ],
  ids=['mirrored', 'upside down', 'upside down and mirrored'],
)
def test_a_film_that_is_turned_reads_the_same_or_nothing(
  turn: Callable[[np.ndarray], np.ndarray], reads: str | None, film: Film
) -> None:
  turned = [np.ascontiguousarray(turn(image)) for image in film.images]
  found = shown(Source(turned, film.times_s), film)
  assert found.readers[0].message == reads


@dataclasses.dataclass
class Source:
  """Pictures from memory, as a recording has them."""

  images: list[np.ndarray]
  times_s: list[float]
  width: int = SMALL[0]
  height: int = SMALL[1]
  length_s: float = float('nan')

  def pictures(self) -> Iterator[tuple[float, Callable[[], np.ndarray]]]:
    for image, time_s in zip(self.images, self.times_s, strict=True):
      yield time_s, lambda image=image: image

  def check(self) -> None:
    pass

  def missing(self) -> str:
    return ''

  def close(self) -> None:
    pass


@pytest.mark.slow
@pytest.mark.parametrize(
  'name', ['joint', pytest.param('klt', marks=pytest.mark.long)]
)
def test_a_film_that_begins_in_motion_is_said_to(name: str, film: Film) -> None:
  agreed = dataclasses.replace(film.scene.agreement, language=None)
  start_s = film.scene.performance.schedule.slots[0].begin_s + 0.2
  late = [(i, t) for i, t in film if t > start_s]
  source = Source(*map(list, zip(*late, strict=True)))
  with recordings.Recording(pathlib.Path('x'), None, source) as recording:
    found = decoding.pictures(
      recording, Part(), [name],
      film.scene.agreement if name == 'joint' else agreed, SEEN,
    )  # fmt: skip
  (note,) = found.notes
  assert note.startswith('Note: the film begins in motion: no rest to learn')
  assert found.readers[0].message is None


def test_a_film_without_a_rest_is_said_to_have_none(film: Film) -> None:
  slots = film.scene.performance.schedule.slots
  moving = [
    (i, t) for i, t in film if slots[0].begin_s + 0.2 < t < slots[1].end_s
  ]
  moving += [(i, t + moving[-1][1]) for i, t in moving]
  source = Source(*map(list, zip(*moving, strict=True)))
  (note,) = shown(source, film).notes
  assert note.startswith('Note: the film has no rest: of 0.7 s that it takes')


def test_a_film_that_is_read_needs_no_reason(film: Film) -> None:
  found = shown(Source(film.images, film.times_s), film)
  assert found.readers[0].message == '101101'
  assert found.notes == ()


class FakeCapture:
  """A `cv2.VideoCapture` that gives pictures from memory."""

  images: tuple[np.ndarray, ...] = ()
  interrupt_at: int | None = None

  def __init__(self, number: int) -> None:
    self._left = iter(self.images) if number == 3 else None
    self._count = 0

  def isOpened(self) -> bool:  # noqa: N802
    return self._left is not None

  def read(self) -> tuple[bool, np.ndarray | None]:
    self._count += 1
    if self._count == self.interrupt_at:
      raise KeyboardInterrupt
    image = next(self._left, None)
    return image is not None, image

  def release(self) -> None:
    self._left = None


@pytest.fixture
def looks(film: Film, monkeypatch: pytest.MonkeyPatch) -> type[FakeCapture]:
  """A camera 3 that sees the film, by a clock of its own."""
  monkeypatch.setattr(cv2, 'VideoCapture', FakeCapture)
  monkeypatch.setattr(
    FakeCapture, 'images', tuple(i[..., ::-1] for i in film.images)
  )
  # One more is looked at when a camera is opened.
  ticks = iter([*film.times_s, 1e9])
  monkeypatch.setattr(live_camera.time, 'monotonic', lambda: next(ticks))
  return FakeCapture


def watched(film: Film, part: Part = Part()) -> decoding.Decoded:
  with decoding.opened(None, 3, None) as recording:
    return decoding.pictures(
      recording, part, ['joint'], film.scene.agreement, SEEN
    )


def test_a_camera_is_read_live(looks: type[FakeCapture], film: Film) -> None:
  found = watched(film)
  assert found.readers[0].message == '101101'
  assert found.heading.startswith('camera 3: 320 x 240')


def test_a_camera_looks_no_longer_than_was_asked(
  looks: type[FakeCapture], film: Film
) -> None:
  found = watched(film, Part(end_s=3.0))
  assert 2.9 < found.readers[0].last_s <= 3.0


def test_an_interrupted_camera_keeps_what_was_read(
  looks: type[FakeCapture], film: Film, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setattr(looks, 'interrupt_at', 250)
  found = watched(film)
  assert found.readers[0].message == '101101'
  assert found.readers[0].chain.images == 248
  assert found.notes[0].startswith('Interrupted')


@pytest.mark.parametrize(
  ('number', 'match'),
  [(0, 'there is no camera 0'), (-1, 'from 0 to 63'), (99, 'from 0 to 63')],
)
def test_a_camera_that_is_not_there_is_refused(
  looks: type[FakeCapture], number: int, match: str
) -> None:
  with pytest.raises(live_camera.CameraError, match=match):
    live_camera.LiveCamera(number)


@pytest.mark.slow
def test_the_command_says_that_there_is_no_camera(waggle: Waggle) -> None:
  child = waggle('decode', '--camera=63')
  assert child.returncode == 2
  assert 'there is no camera 63' in child.stderr


@pytest.fixture(scope='module')
def events(
  film: Film, tmp_path_factory: pytest.TempPathFactory
) -> pathlib.Path:
  pytest.importorskip('dv_processing')
  pytest.importorskip('aedat')
  import event_kit

  return event_kit.write(tmp_path_factory.mktemp('events') / 'x.aedat4', film)


def test_events_are_added_up_and_read(events: pathlib.Path, film: Film) -> None:
  name = fitting.of_events(film.scene.agreement)
  source = event_film.EventFilm(events, None)
  assert (source.width, source.height) == SMALL
  found = shown(source, film, name=name)
  assert found.readers[0].message == '101101'


def test_events_are_added_up_at_the_rate_that_was_asked_for(
  events: pathlib.Path,
) -> None:
  with recordings.Recording(events, 10.0) as recording:
    pairs = [(image.copy(), t) for image, t in recording.frames(Part())]
  np.testing.assert_allclose(np.diff([t for _, t in pairs]), 0.1)
  assert (pairs[0][0] == 128).all()
  away = pairs[20][0].astype(int) - 128
  assert abs(away).max() > 20


def test_a_file_of_events_that_is_damaged_is_refused(
  events: pathlib.Path, tmp_path: pathlib.Path
) -> None:
  path = tmp_path / 'x.aedat4'
  for data in (b'text\n' * 50, events.read_bytes()[:5000]):
    path.write_bytes(data)
    with (
      pytest.raises(recordings.RecordingError, match=r'x\.aedat4'),
      recordings.Recording(path) as recording,
    ):
      for _ in recording.frames(Part()):
        pass


def test_without_the_extra_the_error_names_it(
  tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch
) -> None:
  monkeypatch.setitem(sys.modules, 'aedat', None)
  path = tmp_path / 'x.aedat4'
  path.write_bytes(b'#!AER-DAT4.0\r\n')
  with pytest.raises(recordings.RecordingError, match=r'waggle-tasks\[events'):
    recordings.Recording(path)
