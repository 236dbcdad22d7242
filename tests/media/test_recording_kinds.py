"""Every kind of recording of one dance gives its message."""

from collections.abc import Collection, Iterable
import dataclasses
import pathlib

import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.record import reader
from waggle_tasks.experiments.video import recordings
from waggle_tasks.protocol import camera

kit = pytest.importorskip('recordings_kit', exc_type=ImportError)

# Kinds that differ most from the simulator's pictures, in a fast language;
# all of them in the paper's are many minutes. Fast gestures are too fast for
# optical flow where pictures are rare.
TELLING = {
  'h264-crf23.mp4': ('klt',),
  'gif-10hz.gif': ('view_bank',),
}


@pytest.fixture(scope='module')
def fast(
  short: dict[str, object], tmp_path_factory: pytest.TempPathFactory
) -> kit.Dance:
  """A whole broadcast in the fast language."""
  path = tmp_path_factory.mktemp('fast') / 'x.capture'
  return kit.fly(path, scenario.Scenario(observers=1, **short))


@pytest.fixture(scope='module')
def swift(tmp_path_factory: pytest.TempPathFactory) -> kit.Dance:
  """A message in levels, a few seconds long."""
  path = tmp_path_factory.mktemp('swift') / 'x.capture'
  scene = scenario.Scenario(observers=1, language='swift', payload='101101')
  return kit.fly(path, scene)


@pytest.fixture(scope='module')
def papers(tmp_path_factory: pytest.TempPathFactory) -> kit.Dance:
  """The paper's broadcast."""
  path = tmp_path_factory.mktemp('papers') / 'x.capture'
  return kit.fly(path, scenario.Scenario(observers=1))


def unread(
  kind: kit.Kind, dance: kit.Dance, folder: pathlib.Path, names: Iterable[str]
) -> dict[str, str | None]:
  """What receivers read in a recording, of those that do not read it."""
  path = kind.write(dance, folder)
  with recordings.Recording(path) as recording:
    seen = camera.Camera(recording.width, recording.height, kind.focal_px)
    agreed = dataclasses.replace(dance.agreement, camera=seen)
    readers = [reader.Reader(name, agreed) for name in names]
    for image, time_s in recording.frames(recordings.RecordingPart()):
      for each in readers:
        each.take(image, time_s)
  path.unlink()
  return {r.name: r.message for r in readers if r.message != dance.payload}


def kinds(names: Collection[str] = ()) -> object:
  chosen = [k for k in kit.KINDS if not names or k.name in names]
  return pytest.mark.parametrize('kind', chosen, ids=lambda kind: kind.name)


@pytest.mark.slow
@kinds(TELLING)
def test_a_telling_kind_of_recording_gives_the_message(
  kind: kit.Kind, fast: kit.Dance, tmp_path: pathlib.Path
) -> None:
  assert unread(kind, fast, tmp_path, TELLING[kind.name]) == {}


@pytest.mark.slow
@kinds(
  (
    'gif-10hz.gif', 'h264-crf28.mp4', 'h264-12p5hz.mp4', 'h264-50hz.mp4',
    'h264-news-only.mkv',
  )
)  # fmt: skip
def test_a_recording_of_levels_gives_the_message(
  kind: kit.Kind, swift: kit.Dance, tmp_path: pathlib.Path
) -> None:
  assert unread(kind, swift, tmp_path, ['joint']) == {}


@pytest.mark.long
@kinds()
def test_every_kind_of_recording_gives_the_message(
  kind: kit.Kind, papers: kit.Dance, tmp_path: pathlib.Path
) -> None:
  names = ['view_bank'] if kind.klt else ['view_bank', 'klt']
  assert unread(kind, papers, tmp_path, names) == {}
