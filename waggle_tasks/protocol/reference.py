"""What an observer asks its controller for: the action of the tasks."""

import dataclasses

import numpy as np

SIZE = 13


@dataclasses.dataclass(frozen=True, eq=False)
class Reference:
  """A moment of a smooth motion and the goal that it leads to.

  Attributes:
    position_m: (3,) world metres.
    velocity_mps: (3,) world m/s.
    acceleration_mps2: (3,) world m/s^2.
    turn_rad: Heading of the nose, counterclockwise from where it pointed at
      the beginning of the episode.
    goal_m: (3,) where the motion comes to rest; the position itself when
      hovering. The safety checks judge the way to it.
  """

  position_m: np.ndarray
  velocity_mps: np.ndarray
  acceleration_mps2: np.ndarray
  turn_rad: float
  goal_m: np.ndarray

  @classmethod
  def hover(cls, position_m: np.ndarray) -> 'Reference':
    """Rest at a place, (3,) world metres, heading as at the beginning."""
    rest = np.zeros(3)
    return cls(position_m, rest, rest, 0.0, position_m)

  @classmethod
  def from_array(cls, array: np.ndarray) -> 'Reference':
    """Reads the (13,) array that `to_array` writes."""
    return cls(array[:3], array[3:6], array[6:9], array[9], array[10:])

  def to_array(self) -> np.ndarray:
    """(13,) position, velocity, acceleration, turn, goal: an action."""
    return np.concatenate(
      [
        self.position_m,
        self.velocity_mps,
        self.acceleration_mps2,
        [self.turn_rad],
        self.goal_m,
      ]
    )
