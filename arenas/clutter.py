"""A surface full of corners and edges, as a texture in plain numpy.

Boards, boxes and round things of many sizes and colours, one over another,
with grain between them: what feature trackers like best. It is the same in
every run and wraps around, so that it can be repeated without a seam.
"""

import struct
import zlib

from dm_control import mjcf
import numpy as np

_SEED = 7  # Any will do; a texture is a fixed thing.
_THINGS = 700
_GRAIN = 10  # Grey levels.
# Pixels of the texture, and how much of a floor it covers before it repeats.
# From anywhere in the room one of a wall is about as large as an image's.
_SIZE_PX = {'2d': 512, 'cube': 1024}
_TILE_M = 4.0


def add_material(room: mjcf.RootElement, kind: str) -> mjcf.Element:
  """Adds the surface to a room's model.

  Args:
    room: The model.
    kind: '2d' to lie flat on a plane, 'cube' to go all around.

  Returns:
    The material.
  """
  name, flat = f'clutter_{kind}', kind == '2d'
  contents = encoded(texture(_SIZE_PX[kind]))
  image = room.asset.add(
    'texture', name=name, type=kind, file=mjcf.Asset(contents, '.png')
  )
  return room.asset.add(
    'material',
    name=name,
    texture=image,
    texrepeat=(1 / _TILE_M if flat else 1.0,) * 2,
    texuniform=flat,
    specular=0.0,
  )


def texture(
  size_px: int = 512, seed: int = _SEED, things: int = _THINGS
) -> np.ndarray:
  """Draws the texture.

  Args:
    size_px: Its width and height.
    seed: Each draws another one.
    things: How many are on it.

  Returns:
    (size_px, size_px, 3) uint8 RGB.
  """
  rng = np.random.RandomState(seed)
  pixels = np.full((size_px, size_px, 3), (104.0, 118.0, 130.0))
  for _ in range(things):
    # Half sizes from a hundredth to a twelfth of the whole, small ones first.
    half_px = np.ceil(size_px * 0.01 * 8.0 ** rng.uniform(0, 1, 2)).astype(int)
    middle = rng.randint(0, size_px, 2)
    y, x = (np.arange(-half, half + 1) for half in half_px)
    place = np.ix_((middle[0] + y) % size_px, (middle[1] + x) % size_px)
    colour = rng.uniform(25, 235) + rng.uniform(-30, 30, 3)
    inside = np.ones((len(y), len(x)), bool)
    if rng.rand() < 0.25:  # A round one.
      inside = np.hypot(y[:, None] / half_px[0], x / half_px[1]) <= 1
    pixels[place] = np.where(inside[..., None], colour, pixels[place])
  pixels += rng.uniform(-_GRAIN, _GRAIN, pixels.shape)
  return np.clip(pixels, 0, 255).astype(np.uint8)


def encoded(pixels: np.ndarray) -> bytes:
  """A texture, (H, W, 3) uint8, as a PNG file."""
  height, width, _ = pixels.shape
  rows = np.insert(pixels.reshape(height, -1), 0, 0, axis=1)  # No filter.
  header = struct.pack('>2I5B', width, height, 8, 2, 0, 0, 0)  # 8-bit RGB.
  chunks = (
    (b'IHDR', header),
    (b'IDAT', zlib.compress(rows.tobytes())),
    (b'IEND', b''),
  )
  out = [b'\x89PNG\r\n\x1a\n']
  for kind, body in chunks:
    check = zlib.crc32(kind + body)
    out += [struct.pack('>I', len(body)), kind, body, struct.pack('>I', check)]
  return b''.join(out)
