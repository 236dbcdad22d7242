"""What each camera that has a name sees of one moment of a dance."""

import contextlib

import cv2
import numpy as np

from waggle_tasks import eyes, registry, scenario
from waggle_tasks.experiments.episodes import true_places
from waggle_tasks.experiments.results import palette
from waggle_tasks.experiments.video import layout, page, pen
from waggle_tasks.protocol import reference

_TIME_S = 3.6  # In a stroke of the first symbol.
_WIDTH, _HEIGHT, _TITLE, _GAP = 400, 300, 30, 8
_COLUMNS = 3
_NEAR = 8  # The target is shown so many times narrower than a picture.


def take() -> np.ndarray:
  """All of them on one page, (H, W, 3) uint8 RGB.

  Raises:
    EyeError: if one of them cannot be had here.
  """
  rows = -(-len(eyes.NAMES) // _COLUMNS)
  step_x, step_y = _WIDTH + _GAP, _HEIGHT + _TITLE + _GAP
  canvas = np.zeros(
    (rows * step_y + _GAP, _COLUMNS * step_x + _GAP, 3), np.uint8
  )
  pen.fill(canvas, layout.Rect(0, 0, *canvas.shape[1::-1]), page.GROUND)
  for number, name in enumerate(eyes.NAMES):
    left = _GAP + number % _COLUMNS * step_x
    top = _GAP + number // _COLUMNS * step_y
    tile = _tile(*seen(name))
    pen.chip(canvas, name, left, top + _TITLE // 2, 16, palette.YELLOW)
    place = layout.Rect(left, top + _TITLE, tile.shape[1], tile.shape[0])
    canvas[place.slices] = tile
  return canvas


def seen(name: str) -> tuple[np.ndarray, np.ndarray]:
  """What the camera of a name sees, (H, W, 3) uint8 RGB, and where, (2,)."""
  scene = scenario.Scenario(
    eye=name,  # type: ignore[arg-type]
    language='swift',
    observers=1,
  )
  with contextlib.closing(registry.environment(scene)) as environment:
    timestep = environment.reset()
    place_m = timestep.observation[0]['position_m']
    rest = [reference.Reference.hover(place_m).to_array()]
    for _ in range(scene.agreement.frames(_TIME_S)):
      timestep = environment.step(rest)
    task, physics = environment.task, environment.physics
    places = true_places.TruePlaces(physics, task.observers)
    places.note(physics, task.positions_m(physics)['performer'])
    (place_px,) = places.places_px().values()
    return np.array(timestep.observation[0]['camera']), place_px[0]


def _tile(picture: np.ndarray, place_px: np.ndarray) -> np.ndarray:
  """A picture that fits, and in its corner what is about a place, as it is."""
  height, width = picture.shape[:2]
  scale = min(_WIDTH / width, _HEIGHT / height)
  size = round(scale * width), round(scale * height)
  out = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
  side = width // _NEAR
  left, top = np.rint(place_px - side / 2).astype(int)
  middle = picture[top : top + side, left : left + side]
  near = _WIDTH // 3
  out[:near, :near] = cv2.resize(
    middle, (near, near), interpolation=cv2.INTER_NEAREST
  )
  return out
