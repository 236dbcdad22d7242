"""One short broadcast with everything kept, and videos of a clip."""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import pathlib
import shutil

import chromium
import cv2
import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.experiments.record import (
  capture,
  provenance,
  verdicts,
  writer,
)
from waggle_tasks.experiments.video import film


@dataclasses.dataclass(frozen=True, eq=False)
class Recorded:
  """A run folder and what it was made from; not to be written to."""

  folder: pathlib.Path
  scene: scenario.Scenario
  rollout: rollout_lib.Rollout
  verdict: verdicts.Verdict


@pytest.fixture(scope='session')
def recorded(
  short: dict[str, object], tmp_path_factory: pytest.TempPathFactory
) -> Recorded:
  """A broadcast with two observers, the second blind, filmed and captured."""
  scene = scenario.Scenario(
    control='black_input', observers=2, half_span_deg=10.0, **short
  )
  folder = tmp_path_factory.mktemp('run')
  with (
    film.Film(folder, scene, fps=2.5, scale=0.5) as camera,
    capture.Recorder(folder) as recorder,
  ):
    rollout = rollout_lib.run(scene, 'klt', [camera, recorder])
  verdict = evaluator.evaluate(scene, rollout)
  origin = provenance.Start.now('waggle x').end(rollout.renderer)
  writer.write_run(folder, scene, 'klt', rollout, verdict, origin)
  run_page.write(folder)
  return Recorded(folder, scene, rollout, verdict)


@pytest.fixture
def copied(recorded: Recorded, tmp_path: pathlib.Path) -> pathlib.Path:
  """A copy of the run folder, to be damaged."""
  folder = tmp_path / 'copy'
  shutil.copytree(recorded.folder, folder)
  return folder


@pytest.fixture(scope='session')
def video(
  tmp_path_factory: pytest.TempPathFactory,
) -> Callable[..., pathlib.Path]:
  """Writes pictures, (H, W, 3) uint8 RGB each, as a video of some kind."""

  def write(
    images: Sequence[np.ndarray],
    name: str = 'x.webm',
    codec: str = 'VP80',
    fps: float = 25.0,
  ) -> pathlib.Path:
    path = tmp_path_factory.mktemp('video') / name
    height, width, _ = images[0].shape
    fourcc = cv2.VideoWriter.fourcc(*codec)
    writer = cv2.VideoWriter(
      str(path), cv2.CAP_FFMPEG, fourcc, fps, (width, height)
    )
    assert writer.isOpened()
    for image in images:
      writer.write(image[..., ::-1])
    writer.release()
    return path

  return write


@pytest.fixture(scope='session')
def tiny(video: Callable[..., pathlib.Path]) -> Callable[..., pathlib.Path]:
  """A video of three seconds of a moving disc, 96 x 64."""

  def write(name: str = 'x.webm', codec: str = 'VP80') -> pathlib.Path:
    images = [np.full((64, 96, 3), 90, np.uint8) for _ in range(75)]
    for number, image in enumerate(images):
      cv2.circle(image, (10 + number, 32), 6, (230, 120, 20), -1)
    return video(images, name, codec)

  return write


@pytest.fixture(scope='session')
def window() -> Iterator[chromium.Browser]:
  """A browser; skips where there is none."""
  if chromium.find() is None:
    pytest.skip(f'needs one of {", ".join(chromium.NAMES)}')
  with chromium.Browser() as window:
    yield window


@pytest.fixture
def browser(window: chromium.Browser) -> chromium.Browser:
  """The same browser as it was at first, for a page to be opened in."""
  window.requests.clear()
  window.media('screen')
  window.resize(1280, 800)
  return window
