"""A board that passes between the observers and the performer.

It is guided along a circle around the performer in front of the observers and
comes and goes along the tangents at its ends, as far as outside of the room.
Nothing can touch it.
"""

import math

from dm_control import composer, mjcf
import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib

_ABOVE_M = 1.2  # The hover point: higher than a dance.
_HALF_DEPTH_M = 0.01
_OUTSIDE_M = 12.0  # Along a tangent: beyond any wall.
_WOOD = (0.58, 0.42, 0.26, 1.0)
_LONGEST_S = 600.0  # An episode.


class Board(composer.Entity):
  """Passes now and then, one way and then the other."""

  def _build(
    self,
    radius_m: float,
    bearing_rad: float,
    reach_rad: float,
    width_m: float,
    speed_mps: float,
    every_s: float,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
  ) -> None:
    """Builds the model.

    Args:
      radius_m: Of the circle.
      bearing_rad: Where its middle is as the performer sees it: straight
        ahead is zero, and +x positive.
      reach_rad: How far on either side it is followed.
      width_m: Width of the board.
      speed_mps: How fast it passes.
      every_s: Mean time from one pass to the next.
      agreement: What both sides know: the rate and the height.
    """
    self._radius_m, self._bearing_rad = radius_m, bearing_rad
    self._reach_rad, self._speed_mps = reach_rad, speed_mps
    self._every_s, self._frame_s = every_s, agreement.frame_s
    self._height_m = agreement.hover_height_m + _ABOVE_M
    self._root = mjcf.RootElement(model='occluder')
    self._root.worldbody.add(
      'geom',
      name='board',
      type='box',
      size=(width_m / 2, _HALF_DEPTH_M, self._height_m / 2),
      rgba=_WOOD,
      contype=0,
      conaffinity=0,
    )

  @property
  def mjcf_model(self) -> mjcf.RootElement:
    """The model."""
    return self._root

  @property
  def passes_s(self) -> np.ndarray:
    """(P,) when it is in the middle, in this episode."""
    return self._passes_s

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Draws when it passes: once in each `every_s`, near the middle of it."""
    count = math.ceil(_LONGEST_S / self._every_s) + 1
    shares = random_state.uniform(0.25, 0.75, count)
    self._passes_s = (np.arange(count) + shares) * self._every_s
    self._go(physics, 0.0)

  def before_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Goes where it is at the end of the coming control step."""
    del random_state
    self._go(physics, physics.time() + self._frame_s)

  def _go(self, physics: mjcf.Physics, time_s: float) -> None:
    guide = physics.bind(mjcf.get_attachment_frame(self._root))
    x_m, y_m, yaw_rad = self.place(time_s)
    guide.mocap_pos = [x_m, y_m, self._height_m / 2]
    guide.mocap_quat = [math.cos(yaw_rad / 2), 0, 0, math.sin(yaw_rad / 2)]

  def place(self, time_s: float) -> tuple[float, float, float]:
    """World x and y in m, and heading in rad, in this episode at a time."""
    number = int(np.abs(self._passes_s - time_s).argmin())
    way = -1 if number % 2 else 1  # It comes back as it went.
    along_m = way * self._speed_mps * (time_s - self._passes_s[number])
    arc_m = self._reach_rad * self._radius_m
    beyond_m = min(max(abs(along_m) - arc_m, 0.0), _OUTSIDE_M)
    turn_rad = max(-arc_m, min(along_m, arc_m)) / self._radius_m
    angle = self._bearing_rad + turn_rad
    c, s = math.cos(angle), math.sin(angle)
    beyond_m = math.copysign(beyond_m, along_m)
    return (
      self._radius_m * s + beyond_m * c,
      -self._radius_m * c + beyond_m * s,
      angle,
    )
