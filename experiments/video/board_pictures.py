"""Pictures of the board's tiers: what the first observer of scenes sees."""

from collections.abc import Sequence
import math
import pathlib

import cv2
import numpy as np

from waggle_tasks import registry, scenario
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.studies import (
  board_cases,
  board_tiers,
  sweep_cases,
)
from waggle_tasks.experiments.video import board_films, pen, recordings
from waggle_tasks.protocol import reference

_TILE_PX = 400, 300
_BAR_PX, _LETTERS_PX = 24, 14
_SHARE = 0.45  # Of the first motion, when a picture is taken.


def draw(
  tiers: Sequence[str], referee: int | None, folder: pathlib.Path,
  films: pathlib.Path,
) -> None:  # fmt: skip
  """Draws the pictures that are not there.

  Args:
    tiers: Names of tiers.
    referee: See `board_cases.Plan`.
    folder: Where they are put, TIER.png.
    films: Where films are.
  """
  for tier in tiers:
    path = folder / f'{tier}.png'
    if not path.exists():
      tiles = [
        _captioned(_seen(sample, films), _name(sample))
        for sample in _shown(tier, referee)
      ]
      blank = np.full_like(tiles[0], 255)
      tiles += [blank] * (len(tiles) % 2)
      rows = [np.hstack(tiles[k : k + 2]) for k in range(0, len(tiles), 2)]
      bgr = cv2.cvtColor(np.vstack(rows), cv2.COLOR_RGB2BGR)
      folder.mkdir(parents=True, exist_ok=True)
      files.replace(path, cv2.imencode('.png', bgr)[1].tobytes())


def _shown(tier: str, referee: int | None) -> list[sweep_cases.Sample]:
  """The first broadcasts of the scenes that are shown, the shortest dances."""
  wanted = board_tiers.TIERS[tier].shown
  first: dict[str, sweep_cases.Sample] = {}
  for _, sample in board_cases.scenes(tier, referee):
    name = sample.cell[board_cases.SCENE]
    known = first.get(name)
    if known is None or sample.scene.episode_s < known.scene.episode_s:
      first[name] = sample
  return [first[name] for name in wanted]


def _name(sample: sweep_cases.Sample) -> str:
  return sample.cell[board_cases.SCENE]


def _seen(sample: sweep_cases.Sample, films: pathlib.Path) -> np.ndarray:
  """(H, W, 3) uint8 what is seen in the midst of the first motion."""
  slots = sample.scene.performance.schedule.slots
  at_s = 2.0
  if slots:
    at_s = slots[0].begin_s + _SHARE * slots[0].gesture.duration_s
  if sample.cell[board_cases.TIER] == board_tiers.RECORDINGS:
    if board_films.missing(sample):
      return np.full((480, 640, 3), 128, np.uint8)
    return _filmed(board_films.Films().made(sample, films), at_s)
  return _flown(sample.scene, at_s)


def _flown(scene: scenario.Scenario, at_s: float) -> np.ndarray:
  environment = registry.environment(scene)
  try:
    timestep = environment.reset()
    homes = [each['position_m'].copy() for each in timestep.observation]
    rest = [reference.Reference.hover(home).to_array() for home in homes]
    for _ in range(math.ceil(at_s * scene.rate_hz)):
      timestep = environment.step(rest)
    return timestep.observation[0]['camera'].copy()
  finally:
    environment.close()


def _filmed(path: pathlib.Path, at_s: float) -> np.ndarray:
  part = recordings.RecordingPart(start_s=at_s)
  with recordings.Recording(path) as recording:
    return next(iter(recording.frames(part)))[0]


def _captioned(image: np.ndarray, words: str) -> np.ndarray:
  """A picture of one size, with words below it."""
  width, height = _TILE_PX
  scale = min(width / image.shape[1], height / image.shape[0])
  inner = cv2.resize(image, None, None, scale, scale, cv2.INTER_AREA)
  out = np.zeros((height + _BAR_PX, width, 3), np.uint8)
  top = (height - inner.shape[0]) // 2
  left = (width - inner.shape[1]) // 2
  out[top : top + inner.shape[0], left : left + inner.shape[1]] = inner
  pen.text(out, words, 8, height + _BAR_PX // 2, _LETTERS_PX)
  return out
