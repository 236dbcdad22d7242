"""Another Crazyflie in the air, which has nothing to do with the dance.

It is guided, not flown: a mocap body has no joints, no actuators and no
dynamics, so that a bystander costs the simulation nothing. It looks like the
performer and, like it, moves and rests in turns.
"""

import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import crazyflie
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import minimum_jerk

# Moves take about as long as gestures, rests as their pauses, and a move of
# three quarters of a turn keeps it under 0.7 m/s.
_MOVE_S, _REST_S = (4.0, 8.0), (2.0, 5.0)
_TURN_RAD = (0.5 * math.pi, 1.5 * math.pi)


class Bystander(crazyflie.Crazyflie):
  """Moves along a circle, rests, and moves on; drawn anew in each episode."""

  def _build(  # type: ignore[override]
    self,
    name: str,
    middle_m: np.ndarray,
    radius_m: float,
    spread_m: float,
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    spinning: bool = False,
  ) -> None:
    """Builds the model.

    Args:
      name: Model name.
      middle_m: (3,) where the middle of its circle is, about.
      radius_m: Of that circle.
      spread_m: How far from its middle's place, along each axis, it may be.
      agreement: What both sides know: the rate.
      spinning: Whether it is drawn with propellers that turn.
    """
    super()._build(name, spinning=spinning)
    self._about_m, self._spread_m = middle_m, spread_m
    self._radius_m, self._frame_s = radius_m, agreement.frame_s

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Draws the circle, its moves and rests, and begins."""
    draw = random_state.uniform
    self._middle_m = self._about_m + draw(-self._spread_m, self._spread_m, 3)
    heading_rad, tilt_rad = draw(0, 2 * math.pi), draw(0, math.pi / 2)
    along = np.array([math.cos(heading_rad), math.sin(heading_rad), 0.0])
    aside = np.array([-along[1], along[0], 0.0]) * math.cos(tilt_rad)
    aside[2] = math.sin(tilt_rad)
    self._axes_m = self._radius_m * np.stack([along, aside])  # (2, 3)
    self._move_s, self._rest_s = draw(*_MOVE_S), draw(*_REST_S)
    self._turn_rad = draw(*_TURN_RAD) * random_state.choice([-1, 1])
    self._ahead_s = draw(0, self._move_s + self._rest_s)
    half_rad = draw(0, math.pi)
    guide = physics.bind(mjcf.get_attachment_frame(self.mjcf_model))
    guide.mocap_quat = [math.cos(half_rad), 0, 0, math.sin(half_rad)]
    guide.mocap_pos = self.place_m(0.0)

  def before_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Goes where it is at the end of the coming control step."""
    del random_state
    guide = physics.bind(mjcf.get_attachment_frame(self.mjcf_model))
    guide.mocap_pos = self.place_m(physics.time() + self._frame_s)

  def place_m(self, time_s: float) -> np.ndarray:
    """(3,) where it is in this episode at a time."""
    moves, since_s = divmod(time_s + self._ahead_s, self._move_s + self._rest_s)
    share, _, _ = minimum_jerk.progress(since_s, self._move_s)
    angle = self._turn_rad * (moves + share)
    return self._middle_m + [math.cos(angle), math.sin(angle)] @ self._axes_m
