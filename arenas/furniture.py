"""Rooms with things in them: what stands and hangs along the walls, by seeds.

Nothing of it moves, so that it is drawn once. It stands further from the middle
than vehicles of the usual layouts come, and can be bumped into. Sizes are those
of common furniture; nothing else here has a source.
"""

from collections.abc import Iterator
import dataclasses
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.arenas import bounds, clutter

_COUNT = 14  # Things around the room.
# Half axes of the ellipse on which they stand: outside of all usual flights.
_RING_M = (6.2, 5.0)
_WALL_M = 0.12  # From the wall to what hangs on it.
_SLOTS = ((-2.6, 0.0, 2.6), (-1.6, 1.6))  # Along the long and the short walls.
_PICTURE_PX, _PICTURE_THINGS = 128, 60
_PANE, _FRAME = (0.86, 0.93, 1.0, 1.0), (0.92, 0.91, 0.88, 1.0)
_DAYLIGHT = np.array([0.20, 0.22, 0.25])
_DOWN = -0.6  # How steeply daylight comes in.

Corner = tuple[float, float, float]


@dataclasses.dataclass(frozen=True)
class Box:
  """A box in the frame of a thing that stands at the origin, facing -y.

  Attributes:
    middle_m: Its middle.
    half_m: Half its sizes.
    rgba: Its colour.
  """

  middle_m: Corner
  half_m: Corner
  rgba: tuple[float, float, float, float]


def add(room: mjcf.RootElement, seed: int, gain: float) -> None:
  """Adds everything to a room's model.

  Args:
    room: The model.
    seed: Each makes another room.
    gain: Scales the light of the windows.
  """
  rng = np.random.RandomState(seed)
  for number in range(_COUNT):
    around_rad = 2 * math.pi * (number + rng.uniform(-0.3, 0.3)) / _COUNT
    place_m = np.multiply(_RING_M, (math.cos(around_rad), math.sin(around_rad)))
    body = room.worldbody.add(
      'body',
      name=f'thing_{number}',
      pos=(*place_m, 0.0),
      euler=(0.0, 0.0, around_rad - math.pi / 2 + rng.uniform(-0.2, 0.2)),
    )
    make = _MAKERS[rng.randint(len(_MAKERS))]
    for part, box in enumerate(make(rng)):
      body.add(
        'geom',
        name=f'thing_{number}_{part}',
        type='box',
        pos=box.middle_m,
        size=box.half_m,
        rgba=box.rgba,
      )
  _hang(room, rng, gain)


def _wood(rng: np.random.RandomState) -> tuple[float, float, float, float]:
  """A colour of furniture: from white over wood to black."""
  level = rng.uniform(0.15, 0.9)
  red, green, blue = np.clip(level * rng.uniform(0.75, 1.1, 3), 0, 1)
  return float(red), float(green), float(blue), 1.0


def _table(rng: np.random.RandomState) -> Iterator[Box]:
  width, depth, height = rng.uniform((0.5, 0.3, 0.70), (0.9, 0.45, 0.76))
  colour = _wood(rng)
  yield Box((0.0, 0.0, height), (width, depth, 0.02), colour)
  for right in (-1, 1):
    for back in (-1, 1):
      foot = right * (width - 0.05), back * (depth - 0.05), height / 2
      yield Box(foot, (0.025, 0.025, height / 2), colour)
  for _ in range(rng.randint(1, 4)):  # What lies on it.
    half = rng.uniform(0.05, 0.2, 3)
    x_m, y_m = rng.uniform(-0.6, 0.6, 2) * (width, depth)
    yield Box(
      (x_m, y_m, height + 0.02 + half[2]), tuple(half.tolist()), _wood(rng)
    )


def _shelf(rng: np.random.RandomState) -> Iterator[Box]:
  width, height = rng.uniform((0.4, 1.5), (0.7, 2.2))
  colour, depth = _wood(rng), 0.17
  yield Box((0.0, depth, height / 2), (width, 0.01, height / 2), colour)
  for right in (-1, 1):
    side = right * width, 0.0, height / 2
    yield Box(side, (0.015, depth, height / 2), colour)
  for board_m in np.linspace(0.05, height - 0.02, 5):
    yield Box((0.0, 0.0, board_m), (width, depth, 0.012), colour)
    if board_m > height - 0.1:
      continue
    x_m = -width + 0.05
    while (half_m := rng.uniform(0.03, 0.12)) < (width - 0.05 - x_m) / 2:
      tall_m = rng.uniform(0.08, 0.16)
      middle = x_m + half_m, -0.02, board_m + 0.012 + tall_m
      yield Box(middle, (half_m, 0.12, tall_m), _wood(rng))
      x_m += 2 * half_m + 0.01


def _boxes(rng: np.random.RandomState) -> Iterator[Box]:
  top_m, half = 0.0, rng.uniform((0.3, 0.25, 0.2), (0.6, 0.4, 0.5))
  for _ in range(rng.randint(1, 4)):
    middle = *rng.uniform(-0.05, 0.05, 2), top_m + half[2]
    yield Box(middle, tuple(half.tolist()), _wood(rng))
    top_m += 2 * half[2]
    half = half * rng.uniform(0.6, 0.95, 3)


_MAKERS = _table, _shelf, _boxes


def _hang(
  room: mjcf.RootElement, rng: np.random.RandomState, gain: float
) -> None:
  """Hangs pictures, and opens windows in one of the long walls."""
  sunny = (-1, 1)[rng.randint(2)]
  walls = [(0, sign) for sign in (-1, 1)] + [(1, sign) for sign in (-1, 1)]
  for axis, sign in walls:
    for number, along_m in enumerate(_SLOTS[axis]):
      name = f'{"long" if axis == 0 else "short"}_{sign}_{number}'.replace(
        '-1', 'minus'
      )
      along_m += rng.uniform(-0.4, 0.4)
      far_m = (bounds.HALF_DEPTH_M, bounds.HALF_WIDTH_M)[axis] - _WALL_M
      place = [along_m, sign * far_m, rng.uniform(2.8, 3.6)]
      across = [1.0, 0.0, 0.0]
      if axis:
        place[:2], across = place[1::-1], [0.0, 1.0, 0.0]
      if axis == 0 and sign == sunny:
        _window(room, name, place, across)
      else:
        _picture(room, name, place, across, rng)
  room.worldbody.add(
    'light',
    name='windows',
    type='directional',
    pos=(0.0, 0.0, 4.0),
    dir=(0.3, -sunny, _DOWN),
    diffuse=gain * _DAYLIGHT,
    specular=(0.0, 0.0, 0.0),
    castshadow=False,
  )


def _window(
  room: mjcf.RootElement, name: str, place_m: list[float], across: list[float]
) -> None:
  """A pane that is as bright as white can be, in a frame with a cross."""
  axes = [*across, 0.0, 0.0, 1.0]
  if room.find('material', 'pane') is None:
    room.asset.add('material', name='pane', rgba=_PANE, emission=1.0)
  body = room.worldbody.add(
    'body', name=f'window_{name}', pos=place_m, xyaxes=axes
  )
  body.add('geom', name=name, type='box', size=(0.7, 0.9, 0.02),
           material='pane')  # fmt: skip
  for part, (middle, half) in enumerate(
    (
      ((0.0, 0.0), (0.03, 0.9)), ((0.0, 0.1), (0.7, 0.03)),
      ((-0.72, 0.0), (0.05, 0.95)), ((0.72, 0.0), (0.05, 0.95)),
      ((0.0, -0.92), (0.77, 0.05)), ((0.0, 0.92), (0.77, 0.05)),
    )
  ):  # fmt: skip
    body.add(
      'geom', name=f'{name}_{part}', type='box', pos=(*middle, 0.0),
      size=(*half, 0.05), rgba=_FRAME,
    )  # fmt: skip


def _picture(
  room: mjcf.RootElement,
  name: str,
  place_m: list[float],
  across: list[float],
  rng: np.random.RandomState,
) -> None:
  """A picture full of corners."""
  half = rng.uniform(0.4, 0.9, 2)
  pixels = clutter.texture(
    _PICTURE_PX, int(rng.randint(2**31)), _PICTURE_THINGS
  )
  contents = mjcf.Asset(clutter.encoded(pixels), '.png')
  image = room.asset.add(
    'texture', name=f'picture_{name}', type='2d', file=contents
  )
  material = room.asset.add(
    'material', name=f'picture_{name}', texture=image, specular=0.0
  )
  room.worldbody.add(
    'geom',
    name=f'picture_{name}',
    type='box',
    pos=place_m,
    xyaxes=[*across, 0.0, 0.0, 1.0],
    size=(*half, 0.02),
    material=material,
  )
