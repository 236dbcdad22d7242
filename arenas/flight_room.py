"""The flight room: floor, walls, light and the cameras everyone shares."""

import math

from dm_control import composer
from dm_control import mjcf
import numpy as np

from waggle_tasks import appearance
from waggle_tasks.arenas import scenery
from waggle_tasks.arenas import layouts

HALF_WIDTH_M = 7.0
HALF_DEPTH_M = 4.5
HEIGHT_M = 6.5
IMAGE_SIZE = (640, 480)  # Width and height of an observer's image, pixels.

_FLOOR = (0.46, 0.58, 0.70, 1)
_TILE = (0.42, 0.535, 0.65, 1)
_AMBER = (0.95, 0.62, 0.10, 1.0)
_WHITE = (0.95, 0.96, 0.97, 1)

AMB,HL=0.62,0.24

class FlightRoom(composer.Arena):
  """A room with the performance area above its middle."""

  def _build(
    self,
    look: appearance.Appearance = appearance.Appearance(),
    name: str = 'flight_room',
  ) -> None:
    super()._build(name=name)
    root = self._mjcf_root
    self._poses = []
    # Composer's floor on mass would add 10 mg to every attachment frame.
    root.compiler.boundmass = 0.0
    root.compiler.boundinertia = 0.0
    g = getattr(root.visual, 'global')
    g.offwidth, g.offheight = 2 * IMAGE_SIZE[0], 2 * IMAGE_SIZE[1]
    root.visual.quality.set_attributes(
      offsamples=0, numslices=32, numstacks=2, numquads=1
    )
    root.statistic.set_attributes(extent=1.0, center=(0, 0, 1.3))
    root.visual.map.set_attributes(znear=0.05, zfar=25.0)
    root.visual.headlight.set_attributes(
      ambient=(AMB,)*3, diffuse=(HL,)*3, specular=(0, 0, 0)
    )
    w, d = HALF_WIDTH_M, HALF_DEPTH_M
    root.worldbody.add('geom', name='floor', type='plane', size=(w, d, 1),
                       rgba=_FLOOR)
    def mesh(name, vf, rgba):
      v, f, *n = vf
      more = dict(normal=n[0].ravel()) if n else {}
      m = root.asset.add('mesh', name=name, vertex=v.ravel(),
                          face=f.ravel(), inertia='shell', **more)
      root.worldbody.add('geom', name=name, type='mesh', mesh=m,
                       rgba=rgba, contype=0, conaffinity=0)
    mesh('wall', scenery.studio_wall(w, d, HEIGHT_M, 2.2, 2.4), _FLOOR)
    if look.floor == 'honeycomb':
      v, f = scenery.honeycomb(0.4, 0.016, 5, 0.001)
      mesh('tiles', (v, f), _TILE)
      mesh('middle', scenery.ring(0.205,0.222,6), _AMBER)
    v, f = scenery.ring(0.118, 0.130, 32)
    root.asset.add('mesh', name='pad', vertex=v.ravel(), face=f.ravel(), inertia='shell')
    for name, direction, diffuse in (
      ('key', (0.20, 0.10, -1), 0.36),
      ('fill', (-1.0, 0.10, -0.25), 0.16),
      ('bounce', (0.0, 0.1, 1.0), 0.12),
    ):
      root.worldbody.add('light', name=name, pos=(0, 0, 4), dir=direction,
                         type='directional', castshadow=look.shadows,
                         diffuse=(diffuse,)*3, specular=(0, 0, 0))
    self._top = root.worldbody.add('camera', name='top', pos=(0, 0, 4),
                       xyaxes=(1, 0, 0, 0, 1, 0), projection='orthographic')
    self._overview = root.worldbody.add('camera', name='overview', fovy=32)
    self._back = root.worldbody.add('camera', name='performer_view', fovy=45)
    aim(self._back, (0, 0.75, 1.58), (0, -1.3, 1.22))
    self._frame()

  def _frame(self):
    xy = np.array([p.position_m[:2] for p in self._poses] or [(0., 0)])
    m = 0.6
    low, high = xy.min(0) - m, xy.max(0) + m
    cx, cy = (low + high) / 2
    hx, hy = (high - low) / 2
    self._top.pos = (cx, cy, 4)
    self._top.fovy = 2 * max(hy, hx * 3 / 4)
    r = math.hypot(hx, hy)
    dist = 0.62*r / math.sin(math.radians(32 / 2))
    dirn = np.array((0.60, -0.80, 0.34)); dirn /= np.linalg.norm(dirn)
    tgt = np.array((cx, cy, 1.0))
    aim(self._overview, tgt + dist * dirn, tgt)

  def add_vehicle(
    self, vehicle: composer.Entity, pose: layouts.Pose
  ) -> mjcf.Element:
    """Attaches a free vehicle at a pose and returns its frame."""
    frame = self.add_free_entity(vehicle)
    frame.pos = pose.position_m
    frame.quat = (
      math.cos(pose.yaw_rad / 2), 0.0, 0.0, math.sin(pose.yaw_rad / 2)
    )
    x, y, _ = pose.position_m
    self._mjcf_root.worldbody.add('geom', type='mesh', mesh='pad',
        pos=(x, y, .003), rgba=_WHITE, contype=0, conaffinity=0)
    self._poses.append(pose)
    self._frame()
    return frame

def aim(camera, pos, target):
    pos, target = np.array(pos, float), np.array(target, float)
    back = pos - target
    x = np.cross((0, 0, 1), back); x /= np.linalg.norm(x)
    y = np.cross(back, x)
    camera.pos = pos
    camera.xyaxes = np.r_[x, y / np.linalg.norm(y)]
