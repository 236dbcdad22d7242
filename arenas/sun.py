"""A low sun, and the shadows that vehicles cast on the floor.

The light is a directional one. Shadows are drawn as bodies of their own: a
level vehicle's shadow on a level floor is its outline, moved along the light.
So shadows are seen by every camera, cost no shadow map, and lie in windows of
their own when only what moves is drawn.
"""

import math

from dm_control import mjcf
import numpy as np

from waggle_tasks import msh
from waggle_tasks.arenas import scenery

# Of a Crazyflie: see `entities.airframe`.
_ARM_M, _DISC_M = 0.046, 0.0225
# Over tiles and pads.
_HEIGHT_M = 0.005
_DARK = (0.05, 0.06, 0.10, 0.55)
# Behind the left shoulder of the front observer, so that shadows of vehicles
# at the height of the hover fall 2.5 m further back: in view, on flat floor.
_BEARING_RAD, _HEIGHT_RAD = 0.30, math.radians(27)
# A moving sun swings about that place, so fast that an episode sees it.
_SWING_RAD, _SWING_S = (0.45, math.radians(3)), (50.0, 37.0)
_BRIGHTNESS = (0.80, 0.75, 0.62)


class Sun:
  """The light and its shadows in one room."""

  def __init__(self, room: mjcf.RootElement, moves: bool, gain: float) -> None:
    """Adds the light.

    Args:
      room: The room's model.
      moves: Whether it moves.
      gain: Scales its brightness.
    """
    self._room, self._moves = room, moves
    self._phases_rad = np.zeros(2)
    self._shadows: list[tuple[mjcf.Element, mjcf.Element]] = []
    outline = scenery.crossed_discs(_ARM_M, _DISC_M)
    room.asset.add(
      'mesh',
      name='shadow',
      file=mjcf.Asset(
        msh.pack(outline.vertices_m, outline.faces, outline.normals), '.msh'
      ),
      inertia='shell',
    )
    self._light = room.worldbody.add(
      'light',
      name='sun',
      type='directional',
      pos=(0.0, 0.0, 4.0),
      dir=self.direction(0.0),
      diffuse=gain * np.array(_BRIGHTNESS),
      specular=(0.0, 0.0, 0.0),
      castshadow=False,
    )

  def add_shadow(self, name: str, joint: mjcf.Element) -> None:
    """Gives a vehicle a shadow.

    Args:
      name: The vehicle's.
      joint: The free joint that moves it.
    """
    body = self._room.worldbody.add('body', name=f'shadow_{name}', mocap=True)
    body.add(
      'geom',
      name=f'shadow_{name}',
      type='mesh',
      mesh='shadow',
      rgba=_DARK,
      contype=0,
      conaffinity=0,
    )
    self._shadows.append((body, joint))

  def rise(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Begins an episode; a moving sun begins anywhere on its way."""
    if self._moves:
      self._phases_rad = random_state.uniform(0, 2 * math.pi, 2)
    self.shine(physics, 0.0, 0.0)

  def shine(self, physics: mjcf.Physics, time_s: float, ahead_s: float) -> None:
    """Turns the light, and lays shadows where vehicles will be.

    Args:
      physics: The compiled model.
      time_s: When the picture will be taken.
      ahead_s: How far ahead of the state that is.
    """
    direction = self.direction(time_s)
    if self._moves:
      physics.bind(self._light).dir = direction
    for body, joint in self._shadows:
      state = physics.bind(joint)
      x_m, y_m, z_m = state.qpos[:3] + ahead_s * state.qvel[:3]
      slope = direction[:2] / -direction[2]
      place_m = (np.array([x_m, y_m]) + (z_m - _HEIGHT_M) * slope).tolist()
      shadow = physics.bind(body)
      shadow.mocap_pos = [*place_m, _HEIGHT_M]
      w, x, y, z = state.qpos[3:7]
      half_rad = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) / 2
      shadow.mocap_quat = [math.cos(half_rad), 0, 0, math.sin(half_rad)]

  def direction(self, time_s: float) -> np.ndarray:
    """(3,) unit vector along which it shines, in this episode at a time."""
    turn_rad = np.zeros(2)
    if self._moves:
      angle = 2 * math.pi * time_s / np.array(_SWING_S) + self._phases_rad
      turn_rad = np.array(_SWING_RAD) * np.sin(angle)
    bearing, height = np.add(turn_rad, (_BEARING_RAD, _HEIGHT_RAD))
    level = math.cos(height)
    return np.array(
      [level * math.sin(bearing), level * math.cos(bearing), -math.sin(height)]
    )
