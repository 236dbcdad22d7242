"""The flight room: floor, wall, light and the cameras that everyone shares."""

from collections.abc import Sequence
import math

from dm_control import composer, mjcf
import numpy as np

from waggle_tasks import appearance, msh, runtime
from waggle_tasks.arenas import (
  bounds,
  clutter,
  furniture,
  layouts,
  scenery,
  shared_views,
)
from waggle_tasks.arenas import sun as sun_lib
from waggle_tasks.protocol import agreement as agreement_lib

runtime.require_versions()

# Of the wall that is seen, where it meets the floor and in its corners.
_CURVE_M, _CORNER_M = 2.2, 2.6

# Tiles are two units of displacement apart (paper, equation 2): a message of
# 0.4 m along y carries an observer from one tile to the next.
TILE_M = 0.4
PAD_RADIUS_M = 0.13

# An image is drawn so many times as large along each axis, and then made small.
_SAMPLES = 2

_SLATE = (0.35, 0.43, 0.51, 1.0)
_TILE = (0.50, 0.57, 0.64, 1.0)
_AMBER = (0.95, 0.62, 0.10, 1.0)
_CHALK = (0.95, 0.96, 0.97, 1.0)

_AMBIENT, _HEADLIGHT = 0.68, 0.12
# Beside a sun everything else is this much darker.
_BESIDE_SUN = 0.5
# What leaves a texture's colours as they are.
_WHITE = (1.0, 1.0, 1.0, 1.0)
# Direction and brightness; the last stands in for light off the floor.
_LIGHTS = {
  'key': ((0.20, 0.10, -1.0), 0.38),
  'fill': ((-1.0, 0.10, -0.25), 0.16),
  'bounce': ((0.0, 0.10, 1.0), 0.12),
}


class FlightRoom(composer.Arena):
  """A studio with a slate floor and the performance area at its middle.

  Vehicles come in through `add_vehicle`, each above a pad that is painted on
  the floor: with shadows off, pads show where a vehicle is and, once it has
  moved, where it came from.

  `shared_views.SharedViews` tells of its cameras.
  """

  def _build(
    self,
    look: appearance.Appearance | None = None,
    name: str = 'flight_room',
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    drawn_px: tuple[int, int] | None = None,
  ) -> None:
    """Builds the empty room.

    Args:
      look: What it looks like; the default appearance if None.
      name: Model name.
      agreement: What both sides know: the camera, the rate and the height.
      drawn_px: Width and height of the largest picture that is drawn for
        observers; None for those of the agreed camera.
    """
    super()._build(name=name)
    self._drawn_px = drawn_px or agreement.camera.size
    self._look = look or appearance.Appearance()
    self._agreement = agreement
    self._positions_m: list[tuple[float, float, float]] = []
    self._set_options()
    self._add_room()
    self._add_lights()
    if self._look.furniture:
      furniture.add(
        self._mjcf_root, self._look.furniture, self._look.brightness
      )
    self._views = shared_views.SharedViews(
      self._mjcf_root, agreement.hover_height_m
    )

  @property
  def look(self) -> appearance.Appearance:
    """What the room looks like."""
    return self._look

  def add_vehicle(
    self, vehicle: composer.Entity, pose: layouts.Pose
  ) -> mjcf.Element:
    """Attaches a vehicle that flies freely from a pose, and paints its pad.

    Args:
      vehicle: An entity with its centre of mass at its origin; its model's
        name is kept, so it must be new to the room.
      pose: Where it starts.

    Returns:
      The frame that carries the vehicle; its `freejoint` moves it.

    Raises:
      layouts.LayoutError: if the room holds a vehicle of that name, or if the
        pose lies outside.
    """
    name = vehicle.mjcf_model.model
    taken = [other.mjcf_model.model for other in self._attached]
    if name in taken:
      raise layouts.LayoutError(
        f'`name` of a vehicle must be new to the room, which holds {taken}:'
        f' got {name!r}'
      )
    bounds.check_inside(name, pose)
    x_m, y_m, _ = pose.position_m
    frame = self.add_free_entity(vehicle)
    frame.pos = pose.position_m
    half_rad = pose.yaw_rad / 2.0
    frame.quat = (math.cos(half_rad), 0.0, 0.0, math.sin(half_rad))
    self._add_drawn(f'pad_{name}', 'pad', _CHALK, (x_m, y_m, 0.003))
    self._positions_m.append(pose.position_m)
    self._views.show(self._positions_m)
    if self._sun:
      self._sun.add_shadow(name, frame.freejoint)
    return frame

  def add_guided(self, entity: composer.Entity) -> mjcf.Element:
    """Attaches what is moved by its own hooks, and not by forces.

    Args:
      entity: What sets `mocap_pos` and `mocap_quat` of its attachment frame.

    Returns:
      The frame.
    """
    frame = self.attach(entity)
    frame.mocap = True
    return frame

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Begins the sun's way."""
    if self._sun:
      self._sun.rise(physics, random_state)

  def before_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Moves the sun and its shadows to the end of the control step."""
    del random_state
    if self._sun:
      frame_s = self._agreement.frame_s
      self._sun.shine(physics, physics.time() + frame_s, frame_s)

  def _set_options(self) -> None:
    root = self._mjcf_root
    # Composer's lower bound would add 10 mg to every attachment frame.
    root.compiler.boundmass = 0.0
    root.compiler.boundinertia = 0.0
    width_px, height_px = (
      _SAMPLES * max(sides)
      for sides in zip(shared_views.SIZE_PX, self._drawn_px, strict=True)
    )
    getattr(root.visual, 'global').set_attributes(
      offwidth=width_px, offheight=height_px
    )
    root.visual.quality.set_attributes(
      offsamples=0, numslices=12, numstacks=6, numquads=1
    )
    # Near and far are in units of the extent: 0.05 m and 30 m.
    root.statistic.set_attributes(
      extent=1.0, center=(0.0, 0.0, self._agreement.hover_height_m)
    )
    root.visual.map.set_attributes(znear=0.05, zfar=30.0)

  def _add_room(self) -> None:
    floor = self._mjcf_root.worldbody.add(
      'geom',
      name='floor',
      type='plane',
      size=(30.0, 30.0, 30.0),  # Seen past the wall from outside the room.
      rgba=_SLATE,
    )
    if self._look.floor == 'clutter':
      material = clutter.add_material(self._mjcf_root, '2d')
      floor.set_attributes(material=material, rgba=_WHITE)
    self._add_walls()
    wall = scenery.studio_wall(
      bounds.HALF_WIDTH_M,
      bounds.HALF_DEPTH_M,
      bounds.HEIGHT_M,
      _CURVE_M,
      _CORNER_M,
    )
    self._add_mesh('wall', wall)
    self._add_mesh(
      'ceiling', scenery.ceiling(bounds.HALF_WIDTH_M, bounds.HALF_DEPTH_M)
    )
    high = (0.0, 0.0, bounds.HEIGHT_M)
    seen = [
      self._add_drawn('wall', 'wall', _SLATE),
      self._add_drawn('ceiling', 'ceiling', _SLATE, high),
    ]
    if self._look.walls == 'clutter':
      material = clutter.add_material(self._mjcf_root, 'cube')
      for geom in seen:
        geom.set_attributes(material=material, rgba=_WHITE)
    if self._look.floor == 'honeycomb':
      self._add_mesh('tiles', scenery.honeycomb(TILE_M, 0.016, 5))
      self._add_drawn('tiles', 'tiles', _TILE, (0.0, 0.0, 0.001))
      # Around the tile below the performer.
      self._add_mesh('middle', scenery.ring(0.205, TILE_M / math.sqrt(3.0), 6))
      self._add_drawn('middle', 'middle', _AMBER, (0.0, 0.0, 0.002))
    self._add_mesh('pad', scenery.ring(PAD_RADIUS_M - 0.012, PAD_RADIUS_M, 32))

  def _add_walls(self) -> None:
    """Adds what vehicles bump into; what is seen curves inside of it."""
    for name, axis, distance_m in (
      ('east', (-1, 0, 0), bounds.HALF_WIDTH_M),
      ('west', (1, 0, 0), bounds.HALF_WIDTH_M),
      ('north', (0, -1, 0), bounds.HALF_DEPTH_M),
      ('south', (0, 1, 0), bounds.HALF_DEPTH_M),
      ('up', (0, 0, -1), bounds.HEIGHT_M),
    ):
      self._mjcf_root.worldbody.add(
        'geom',
        name=f'wall_{name}',
        type='plane',
        size=(1.0, 1.0, 1.0),  # Of its picture; it has no edge.
        pos=-distance_m * np.array(axis, dtype=float),
        zaxis=axis,
        group=3,
      )

  def _add_mesh(self, name: str, mesh: scenery.Mesh) -> None:
    self._mjcf_root.asset.add(
      'mesh',
      name=name,
      file=mjcf.Asset(
        msh.pack(mesh.vertices_m, mesh.faces, mesh.normals), '.msh'
      ),
      inertia='shell',
    )

  def _add_drawn(
    self,
    name: str,
    mesh: str,
    rgba: Sequence[float],
    position_m: Sequence[float] = (0.0, 0.0, 0.0),
  ) -> mjcf.Element:
    """Adds a mesh that is seen and not felt."""
    return self._mjcf_root.worldbody.add(
      'geom',
      name=name,
      type='mesh',
      mesh=mesh,
      rgba=rgba,
      pos=position_m,
      contype=0,
      conaffinity=0,
    )

  def _add_lights(self) -> None:
    root = self._mjcf_root
    gain, self._sun = self._look.brightness, None
    if self._look.sun != 'none':
      self._sun = sun_lib.Sun(root, self._look.sun == 'moving', gain)
      gain *= _BESIDE_SUN
    root.visual.headlight.set_attributes(
      ambient=(gain * _AMBIENT,) * 3,
      diffuse=(gain * _HEADLIGHT,) * 3,
      specular=(0.0, 0.0, 0.0),
    )
    for name, (direction, brightness) in _LIGHTS.items():
      root.worldbody.add(
        'light',
        name=name,
        type='directional',
        pos=(0.0, 0.0, 4.0),
        dir=direction,
        diffuse=(gain * brightness,) * 3,
        specular=(0.0, 0.0, 0.0),
        castshadow=self._look.shadows and name == 'key',
      )
