"""The pictures of the documentation."""

from collections.abc import Callable
import pathlib
import subprocess

import cv2
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.record import moves, traces
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import shots

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.slow
def test_each_gesture_shows_the_performer_all_along_its_track() -> None:
  scene = scenario.Scenario()
  sent = shots.firsts(
    moves.sent(scene.performance, scene.agreement, scene.episode_s)
  )
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


@pytest.mark.long
def test_the_command_makes_pictures_small_enough_to_commit(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle('gallery', f'--output={tmp_path}')
  assert done.returncode == 0, done.stderr
  sizes = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
  assert sizes.keys() == {'composite.png', 'gestures.png'}
  assert max(sizes.values()) < 300_000


@pytest.mark.slow
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
  picture = cv2.imread(str(tmp_path / 'pictures' / 'envelope.png'))
  assert min(picture.shape[:2]) > 200
  assert np.ptp(picture) > 200
  assert (tmp_path / 'pictures' / 'envelope.svg').exists()
