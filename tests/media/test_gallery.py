"""The pictures of the documentation, and the small files they are kept in."""

from collections.abc import Callable
import pathlib
import subprocess

import cv2
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.record import story, traces
from waggle_tasks.experiments.results import palette, png
from waggle_tasks.experiments.video import shots

Waggle = Callable[..., subprocess.CompletedProcess[str]]


def read(path: pathlib.Path) -> np.ndarray:
  return cv2.imread(str(path), cv2.IMREAD_COLOR)[..., ::-1]


def test_a_picture_of_few_colours_comes_back_exactly(
  tmp_path: pathlib.Path,
) -> None:
  random = np.random.RandomState(0)
  colours = random.randint(0, 256, (200, 3)).astype(np.uint8)
  picture = colours[random.randint(0, 200, (40, 60))]
  path = png.write(tmp_path / 'new' / 'x.png', picture)
  np.testing.assert_array_equal(read(path), picture)


def test_a_picture_of_many_colours_stays_close_and_small(
  tmp_path: pathlib.Path,
) -> None:
  rows, columns = np.mgrid[:256, :256].astype(np.uint8)
  picture = np.stack([rows, columns, (rows // 2 + columns // 2)], axis=2)
  path = png.write(tmp_path / 'x.png', picture)
  again = read(path)
  assert len(np.unique(again.reshape(-1, 3), axis=0)) == 256
  assert np.abs(again.astype(int) - picture).mean() < 8
  assert path.stat().st_size < picture.nbytes / 3


def test_a_picture_that_cannot_be_written_is_an_error(
  tmp_path: pathlib.Path,
) -> None:
  (tmp_path / 'file').touch()
  with pytest.raises(png.PngError, match='cannot be written'):
    png.write(tmp_path / 'file' / 'x.png', np.zeros((2, 2, 3), np.uint8))


def test_each_gesture_shows_the_performer_all_along_its_track() -> None:
  scene = scenario.Scenario()
  sent = shots.firsts(story.sent(scene.performance, scene.episode_s))
  assert [str(each.symbol) for each in sent] == ['START', '0', '1', 'END']
  images, times_s, centres_px = {}, [], []
  for gesture in sent:
    for number, frame in enumerate(shots.exposures(gesture, scene.agreement)):
      image = np.full((480, 640, 3), 100, np.uint8)
      place = 200 + 12 * number, 200
      cv2.circle(image, place, 3, (255, 0, 0), -1)
      images[frame] = image
      times_s.append(frame * 0.04)
      centres_px.append(place)
  rest = np.zeros(len(times_s))
  trace = traces.Trace(
    np.array(times_s), np.array(centres_px, float), rest, rest, rest, rest > -1
  )
  picture = shots.gestures(sent, images, trace, scene.agreement)
  red = (picture == (255, 0, 0)).all(axis=2).astype(np.uint8)
  count, _ = cv2.connectedComponents(red)
  assert count - 1 == len(images)
  yellow = np.abs(picture - np.array(palette.rgb(palette.YELLOW))).max(axis=2)
  assert (yellow < 40).sum() > 4 * 50


@pytest.mark.slow
def test_the_command_makes_pictures_small_enough_to_commit(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle('gallery', f'--output={tmp_path}')
  assert done.returncode == 0, done.stderr
  sizes = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
  assert sizes.keys() == {'composite.png', 'gestures.png'}
  assert max(sizes.values()) < 300_000


def test_the_envelope_of_a_sweep_is_drawn_without_gl(
  waggle: Waggle, tmp_path: pathlib.Path, no_gl: dict[str, str]
) -> None:
  pytest.importorskip('matplotlib')
  grids = '--grid=distance_m=1.0,1.3', '--grid=bearing_deg=0,20'
  short = '--control=no_send', '--duration_s=0.08', '--observers=1'
  for command, changes in (
    (['sweep', *grids, *short, '--workers=1', '--output=flown'], {}),
    (['gallery', '--sweep=flown', '--output=pictures'], no_gl),
  ):
    done = waggle(*command, cwd=tmp_path, **changes)
    assert done.returncode == 0, done.stderr
  picture = read(tmp_path / 'pictures' / 'envelope.png')
  assert min(picture.shape[:2]) > 200
  assert np.ptp(picture) > 200
  assert (tmp_path / 'pictures' / 'envelope.svg').exists()
