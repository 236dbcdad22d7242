"""How a Crazyflie 2 looks and what it bumps into.

Everything here is massless: the vehicle's inertia is stated, not drawn. Sizes
follow the manufacturer's data sheet (92 mm between opposite motors, 29 mm
high, 45 mm propellers); what it leaves out is drawn by eye.
"""

from collections.abc import Iterator, Sequence
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import shapes

# MuJoCo Menagerie, bitcraze_crazyflie_2: motor axis to centre of mass.
ARM_M = 0.046
ROTOR_RADIUS_M = 0.0225
# Feet to propeller hubs.
BOTTOM_M, TOP_M = -0.0145, 0.0145

_BLACK = (0.06, 0.06, 0.07, 1.0)
_BOARD = (0.11, 0.13, 0.14, 1.0)
_STEEL = (0.70, 0.72, 0.75, 1.0)
_WHITE = (0.96, 0.96, 0.95, 1.0)
_SMOKE = (0.84, 0.87, 0.90, 1.0)
_GOLD = (0.86, 0.70, 0.36, 1.0)
_SILVER = (0.78, 0.80, 0.82, 1.0)

_BOARD_Z_M = (-0.0054, -0.0038)
_DISC_Z_M = (0.0110, 0.0128)
_ROTOR_SIDES = 24

# Front left, rear left, rear right, front right.
_MOTOR_ANGLES_RAD = tuple(math.pi / 4 + i * math.pi / 2 for i in range(4))


def draw(root: mjcf.RootElement, body: mjcf.Element, accent_rgba: Sequence[float]) -> None:
  """Adds the visible shapes to `body`, one mesh a colour."""
  for name, solids, rgba in _parts(accent_rgba):
    solid = shapes.joined(solids)
    mesh = root.asset.add(
      'mesh',
      name=name,
      vertex=solid.vertices_m.ravel(),
      face=solid.faces.ravel(),
    )
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


def enclose(body: mjcf.Element) -> None:
  """Adds the collision hull: one flat cylinder around rotors and legs."""
  body.add(
    'geom',
    name='hull',
    type='cylinder',
    pos=(0.0, 0.0, (BOTTOM_M + TOP_M) / 2.0),
    size=(ARM_M + ROTOR_RADIUS_M, (TOP_M - BOTTOM_M) / 2.0),
    mass=0.0,
    contype=1,
    conaffinity=1,
    group=3,
  )


def _parts(accent) -> Iterator[tuple[str, list, Sequence[float]]]:
  yield 'board', [_plate(), *_everywhere(_arm()), *_headers()], _BOARD
  yield 'battery', [shapes.box((-0.0145, 0.0145), (-0.0082, 0.0082), (-0.0032, 0.0042))], _SILVER
  yield 'label', [shapes.box((-0.0060, 0.0100), (-0.0085, 0.0085), (-0.0034, 0.0044)), _hexagon()], accent
  yield 'deck', [shapes.box((-0.0120, 0.0120), (-0.0118, 0.0118), (0.0066, 0.0078))], _BLACK
  yield 'pins', list(_pins()), _GOLD
  yield 'mounts', [*_everywhere(_collar()), *_everywhere(_leg())], _WHITE
  yield 'motors', [*_everywhere(_motor())], _STEEL
  yield 'front_discs', [_on_arm(_ring(), i) for i in (0, 3)], accent
  yield 'rear_discs', [_on_arm(_ring(), i) for i in (1, 2)], _SMOKE
  yield 'blades', list(_propellers()), _BLACK


def _on_arm(solid, i):
  a = _MOTOR_ANGLES_RAD[i]
  return solid.at(ARM_M * math.cos(a), ARM_M * math.sin(a), a)


def _everywhere(solid):
  return [_on_arm(solid, i) for i in range(4)]


def _plate():
  s, c = 0.0170, 0.0070
  return shapes.prism([(s, -c), (s, c), (c, s), (-c, s), (-s, c), (-s, -c), (-c, -s), (c, -s)], *_BOARD_Z_M)


def _arm():
  return shapes.prism([(-0.036, -0.0042), (0.0, -0.0030), (0.0, 0.0030), (-0.036, 0.0042)], *_BOARD_Z_M)


def _headers():
  return [shapes.box((-0.0100, 0.0100), (y - 0.0011, y + 0.0011), (-0.0075, 0.0066)) for y in (-0.0102, 0.0102)]


def _pins():
  for y in (-0.0102, 0.0102):
    for i in range(8):
      x = 0.0024 * (i - 3.5)
      yield shapes.box((x - 0.0004, x + 0.0004), (y - 0.0004, y + 0.0004), (0.0078, 0.0122))


def _hexagon():
  return shapes.turned([(0.0075, 0.0078), (0.0075, 0.0083)], 6)


def _collar():
  return shapes.turned([(0.0048, -0.0085), (0.0052, -0.0030)], 12)


def _leg():
  zs, lo, hi = (BOTTOM_M, -0.0075), (-0.0012, 0.0022), (-0.0042, 0.0048)
  t = 0.0016
  ring = lambda z, x: [(x[0], -t, z), (x[1], -t, z), (x[1], t, z), (x[0], t, z)]
  return shapes.loft(np.array([ring(zs[0], lo), ring(zs[1], hi)]))


def _motor():
  return shapes.turned([(0.0034, -0.0095), (0.0036, -0.0090), (0.0036, 0.0085), (0.0030, 0.0092)], 12)


def _disc():
  return shapes.turned([(ROTOR_RADIUS_M, _DISC_Z_M[0]), (ROTOR_RADIUS_M, _DISC_Z_M[1])], _ROTOR_SIDES)


def _ring():
  r0, r1 = ROTOR_RADIUS_M - 0.0028, ROTOR_RADIUS_M
  z0, z1 = _DISC_Z_M
  a = 2 * math.pi * np.arange(_ROTOR_SIDES) / _ROTOR_SIDES
  # torus of rectangular section: faces closed on itself
  v, f = [], []
  for r, z in ((r0, z0), (r1, z0), (r1, z1), (r0, z1)):
    v += [(r * math.cos(t), r * math.sin(t), z) for t in a]
  n = _ROTOR_SIDES
  for k in range(4):
    for i in range(n):
      j = (i + 1) % n
      p, q = k * n, ((k + 1) % 4) * n
      f += [(p + i, p + j, q + j), (p + i, q + j, q + i)]
  return shapes.Solid(np.array(v), np.array(f))


def _blade():
  rings = []
  for r, chord, pitch in ((0.0015, 0.003, 35), (0.007, 0.0056, 26), (0.014, 0.0050, 18), (0.0222, 0.0026, 12)):
    p = math.radians(pitch)
    u = np.array((0, math.cos(p), math.sin(p))) * chord / 2
    w = np.array((0, -math.sin(p), math.cos(p))) * 0.0004
    o = np.array((r, 0, 0.0122))
    rings.append([o - u - w, o + u - w, o + u + w, o - u + w])
  return shapes.loft(np.array(rings))


def _propellers():
  hub = shapes.turned([(0.0010, 0.0085), (0.0010, 0.0108), (0.0026, 0.0108), (0.0020, TOP_M)], 10)
  b = _blade()
  both = shapes.joined([hub, b, b.at(0, 0, math.pi)])
  for i in range(4):
    p = both if i % 2 else both.mirrored()
    yield _on_arm(p.at(0, 0, 0.5 + 0.4 * i), i)
