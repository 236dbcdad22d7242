"""How a Crazyflie 2 looks and what it bumps into.

Everything here is massless: the vehicle's inertia is stated, not drawn. Sizes
follow the manufacturer's data sheet (92 mm between opposite motors, 29 mm
high) and its 45 mm propellers; the rest is drawn by eye. A rotor is the rim of
the disc that it sweeps, with its two blades at rest: see-through, so that the
board shows from every side.
"""

from collections.abc import Iterator, Sequence
import dataclasses
import functools
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks import msh, runtime
from waggle_tasks.entities import shapes

runtime.require_versions()

ARM_M = 0.046  # MuJoCo Menagerie, bitcraze_crazyflie_2: centre to motor axis.
ROTOR_RADIUS_M = 0.0225
BOTTOM_M, TOP_M = -0.0145, 0.0145  # Feet and propeller hubs.

Rgba = Sequence[float]

_BLACK = (0.06, 0.06, 0.07, 1.0)
_BOARD = (0.11, 0.13, 0.14, 1.0)
_BLUE = (0.15, 0.45, 1.00, 1.0)
_GOLD = (0.86, 0.70, 0.36, 1.0)
_SILVER = (0.78, 0.80, 0.82, 1.0)
_SMOKE = (0.84, 0.87, 0.90, 1.0)
_STEEL = (0.70, 0.72, 0.75, 1.0)
_WHITE = (0.96, 0.96, 0.95, 1.0)
# Blades that turn two hundred times a second, as long as a picture is exposed.
_BLUR = (0.10, 0.10, 0.11, 0.22)

# Front left, rear left, rear right, front right.
MOTORS_RAD = tuple(math.pi / 4.0 + i * math.pi / 2.0 for i in range(4))
# Where each propeller came to rest, so that no two views look alike.
_BLADES_RAD = (0.5, 0.9, 1.3, 1.7)

_BOARD_Z_M = (-0.0054, -0.0038)
_HEADER_Y_M = 0.0102
_RIM_Z_M = (0.0098, 0.0112)
_BLADE_Z_M = 0.0126


@dataclasses.dataclass(frozen=True)
class Part:
  """All that is drawn in one colour."""

  name: str
  rgba: Rgba
  solids: tuple[shapes.Solid, ...]


def draw(body: mjcf.Element, accent_rgba: Rgba, spinning: bool = False) -> None:
  """Adds the visible shapes to `body`, one mesh a colour.

  Args:
    body: The rigid body, x forward and z up, origin at the centre of mass.
    accent_rgba: Colour of the front rotors, the battery's label and the mark
      on the deck.
    spinning: Whether the propellers turn: their blades are a blur then, which
      is the same in every picture.
  """
  for name, rgba, file in _drawn(tuple(accent_rgba), spinning):
    mesh = body.root.asset.add('mesh', name=name, file=file)
    body.add(
      'geom',
      name=name,
      type='mesh',
      mesh=mesh,
      rgba=rgba,
      mass=0.0,
      contype=0,
      conaffinity=0,
      group=0,
    )


@functools.cache  # Every vehicle of every environment looks so.
def _drawn(
  accent_rgba: Rgba, spinning: bool
) -> tuple[tuple[str, Rgba, mjcf.Asset], ...]:
  out = []
  for part in parts(accent_rgba, spinning):
    solid = shapes.joined(part.solids)
    file = mjcf.Asset(msh.pack(solid.vertices_m, solid.faces), '.msh')
    out.append((part.name, part.rgba, file))
  return tuple(out)


def enclose(body: mjcf.Element) -> None:
  """Adds the collision hull: one flat cylinder around rotors and feet."""
  body.add(
    'geom',
    name='hull',
    type='cylinder',
    pos=(0.0, 0.0, (BOTTOM_M + TOP_M) / 2.0),
    size=(ARM_M + ROTOR_RADIUS_M, (TOP_M - BOTTOM_M) / 2.0),
    mass=0.0,
    contype=1,
    conaffinity=1,
    group=3,  # Not drawn by default (MuJoCo, mjvOption.geomgroup).
  )


def parts(accent_rgba: Rgba, spinning: bool = False) -> Iterator[Part]:
  """Everything that is drawn, colour by colour; see `draw`."""
  yield Part('board', _BOARD, (_plate(), *_headers(), *_four(_arm())))
  yield Part('battery', _SILVER, (_battery(),))
  yield Part('label', accent_rgba, (_label(), _mark()))
  yield Part('deck', _BLACK, (_deck(),))
  yield Part('pins', _GOLD, tuple(_pins()))
  yield Part('mounts', _WHITE, (*_four(_collar()), *_four(_leg())))
  yield Part('motors', _STEEL, (*_four(_motor()), _usb_socket()))
  yield Part('lights', _BLUE, _four(_light())[1:3])
  rims = _four(_rim())
  yield Part('front_rotors', accent_rgba, (rims[0], rims[3]))
  yield Part('rear_rotors', _SMOKE, (rims[1], rims[2]))
  if spinning:
    yield Part('propellers', _BLACK, _four(_hub()))
    yield Part('blurs', _BLUR, _four(_blur()))
  else:
    yield Part('propellers', _BLACK, tuple(_propellers()))


def _on_motor(solid: shapes.Solid, angle_rad: float) -> shapes.Solid:
  """Moves a solid to a motor, its x axis along the arm and outwards."""
  x_m, y_m = ARM_M * math.cos(angle_rad), ARM_M * math.sin(angle_rad)
  return solid.at(x_m, y_m, angle_rad)


def _four(solid: shapes.Solid) -> tuple[shapes.Solid, ...]:
  return tuple(_on_motor(solid, angle) for angle in MOTORS_RAD)


def _plate() -> shapes.Solid:
  """The middle of the board, an octagon."""
  far, near = 0.0170, 0.0070
  right = [(far, -near), (far, near), (near, far), (-near, far)]
  left = [(-x, -y) for x, y in right]
  return shapes.prism(right + left, *_BOARD_Z_M)


def _arm() -> shapes.Solid:
  root, tip = (-0.036, 0.0042), (0.0, 0.0030)
  outline = [(root[0], -root[1]), (tip[0], -tip[1]), tip, root]
  return shapes.prism(outline, *_BOARD_Z_M)


def _headers() -> Iterator[shapes.Solid]:
  """The two strips that carry the deck and hold the battery between them."""
  for y in (-_HEADER_Y_M, _HEADER_Y_M):
    yield shapes.box(
      (-0.010, 0.010), (y - 0.0011, y + 0.0011), (-0.0075, 0.0066)
    )


def _pins() -> Iterator[shapes.Solid]:
  half = 0.0004
  for y in (-_HEADER_Y_M, _HEADER_Y_M):
    for x in 0.0024 * (np.arange(8) - 3.5):
      yield shapes.box(
        (x - half, x + half), (y - half, y + half), (0.0078, 0.0122)
      )


def _battery() -> shapes.Solid:
  return shapes.box((-0.0145, 0.0145), (-0.0082, 0.0082), (-0.0032, 0.0042))


def _label() -> shapes.Solid:
  """A band around the battery."""
  return shapes.box((-0.0060, 0.0100), (-0.0085, 0.0085), (-0.0034, 0.0044))


def _deck() -> shapes.Solid:
  """The board on top of the battery."""
  return shapes.box((-0.0120, 0.0120), (-0.0118, 0.0118), (0.0066, 0.0078))


def _mark() -> shapes.Solid:
  """A honeycomb's cell on the deck."""
  return shapes.turned([(0.0075, 0.0078), (0.0075, 0.0083)], 6)


def _usb_socket() -> shapes.Solid:
  return shapes.box((0.0150, 0.0195), (-0.0036, 0.0036), (-0.0038, -0.0012))


def _light() -> shapes.Solid:
  return shapes.box((-0.0150, -0.0120), (-0.0015, 0.0015), (-0.0038, -0.0028))


def _collar() -> shapes.Solid:
  """The part of a motor mount that holds the motor."""
  return shapes.turned([(0.0048, -0.0085), (0.0052, -0.0030)], 12)


def _leg() -> shapes.Solid:
  """The part of a motor mount that stands on the floor, narrow at its foot."""
  half = 0.0016

  def ring(inner: float, outer: float, z: float) -> list[tuple]:
    return [
      (inner, -half, z), (outer, -half, z), (outer, half, z), (inner, half, z)
    ]  # fmt: skip

  foot, top = ring(-0.0012, 0.0022, BOTTOM_M), ring(-0.0042, 0.0048, -0.0075)
  return shapes.loft(np.array([foot, top]))


def _motor() -> shapes.Solid:
  profile = [(0.0036, -0.0090), (0.0036, 0.0085), (0.0030, 0.0092)]
  return shapes.turned([(0.0034, -0.0095), *profile], 12)


def _rim() -> shapes.Solid:
  return shapes.hoop(ROTOR_RADIUS_M - 0.0028, ROTOR_RADIUS_M, *_RIM_Z_M, 24)


def _hub() -> shapes.Solid:
  profile = [(0.0010, 0.0108), (0.0026, 0.0108), (0.0020, TOP_M)]
  return shapes.turned([(0.0010, 0.0085), *profile], 10)


def _blur() -> shapes.Solid:
  """What is swept by blades, up to the rim."""
  half, radius = 0.0004, ROTOR_RADIUS_M - 0.0028
  profile = [(radius, _BLADE_Z_M - half), (radius, _BLADE_Z_M + half)]
  return shapes.turned(profile, 24)


def _propellers() -> Iterator[shapes.Solid]:
  """Two blades and a hub for each motor; neighbours turn opposite ways."""
  blade = _blade()
  left = shapes.joined([_hub(), blade, blade.at(0.0, 0.0, math.pi)])
  right = left.mirrored()
  for i, (motor, rest) in enumerate(zip(MOTORS_RAD, _BLADES_RAD, strict=True)):
    yield _on_motor((right, left)[i % 2].at(0.0, 0.0, rest), motor)


def _blade() -> shapes.Solid:
  """A blade along x: broad near the hub, twisted, and narrow at its tip."""
  rings = []
  for radius, chord, pitch_deg in (
    (0.0015, 0.0030, 35.0),
    (0.0070, 0.0056, 26.0),
    (0.0140, 0.0050, 18.0),
    (0.0222, 0.0026, 12.0),
  ):
    c, s = math.cos(math.radians(pitch_deg)), math.sin(math.radians(pitch_deg))
    along = chord / 2.0 * np.array((0.0, c, s))
    across = 0.0004 * np.array((0.0, -s, c))
    middle = np.array((radius, 0.0, _BLADE_Z_M))
    corners = [-along - across, along - across, along + across, across - along]
    rings.append([middle + corner for corner in corners])
  return shapes.loft(np.array(rings))
