"""What an agent's action means: small spaces beside the task's own one.

The task takes a reference of 13 numbers in every frame, and one straight flight
in an episode (`protocol.reference`, `protocol.flight`). Who learns what to say
or where to go need not learn to fly: here a pilot flies it as agreed.
"""

from gymnasium import spaces
import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import flight, payload, reference
from waggle_tasks.tasks import actions, safety

MESSAGE, DISPLACEMENT, REFERENCE = 'message', 'displacement', 'reference'
ACTIONS = MESSAGE, DISPLACEMENT, REFERENCE


def space(kind: str, agreement: agreement_lib.Agreement) -> spaces.Space:
  """The actions of one agent.

  Args:
    kind: One of `ACTIONS`. 'message': 0 waits, and k flies the payload whose
      bits are k - 1, once. 'displacement': (3,) float32 from -1 to 1; when the
      first is over 0 it flies, once, as far along world x and y as the others
      say, in the longest displacement of a payload. 'reference': (13,) float64,
      the task's own.
    agreement: What both sides know.
  """
  if kind == MESSAGE:
    return spaces.Discrete(2**agreement.units.num_bits + 1)
  if kind == DISPLACEMENT:
    return spaces.Box(-1.0, 1.0, (3,), np.float32)
  (own,) = actions.specification(['agent'])
  return spaces.Box(own.minimum, own.maximum, own.shape, np.float64)


class Pilot:
  """Turns the actions of one agent into references.

  Attributes:
    begin_m: (3,) where it was when it was given its command; None before one...
    goal_m: ...and (3,) where that leads.
  """

  def __init__(self, kind: str, agreement: agreement_lib.Agreement) -> None:
    """Begins an episode.

    Args:
      kind: One of `ACTIONS`.
      agreement: What both sides know.
    """
    self._kind, self._agreement = kind, agreement
    self._hold_m: np.ndarray | None = None
    self._last: np.ndarray | None = None
    self._flight: flight.Flight | None = None
    self.begin_m: np.ndarray | None = None
    self.goal_m = np.zeros(3)

  def step(
    self, action: object, position_m: np.ndarray, time_s: float
  ) -> np.ndarray:
    """The (13,) reference for an action.

    Args:
      action: Of the space; None of who has left the episode.
      position_m: (3,) where the agent takes itself to be.
      time_s: When.
    """
    if self._hold_m is None:
      self._hold_m = position_m.copy()
    if self._kind == REFERENCE:
      return self._own(action, position_m)
    if action is not None and self._flight is None:
      goal_m = self._goal_m(action, position_m)
      if goal_m is not None:
        self._note(position_m, goal_m)
        self._flight = flight.Flight(position_m.copy(), goal_m, time_s)
    if self._flight is None:
      return reference.Reference.hover(self._hold_m).to_array()
    motion = self._flight.motion(time_s + self._agreement.frame_s / 2)
    goal_m = self._flight.goal_m
    return reference.Reference(*motion, 0.0, goal_m).to_array()

  def _own(self, action: object, position_m: np.ndarray) -> np.ndarray:
    if action is not None:
      self._last = np.asarray(action, float)
      goal_m = reference.Reference.from_array(self._last).goal_m
      away_m = float(np.linalg.norm(goal_m - self._hold_m))
      if self.begin_m is None and away_m >= safety.COMMAND_M:
        self._note(position_m, goal_m)
    if self._last is None:
      return reference.Reference.hover(position_m).to_array()
    return self._last

  def _goal_m(
    self, action: object, position_m: np.ndarray
  ) -> np.ndarray | None:
    """Where an action commands to fly, (3,), if it does."""
    agreement, units = self._agreement, self._agreement.units
    if self._kind == MESSAGE:
      if not action:
        return None
      told = payload.Payload.from_int(int(np.asarray(action)) - 1, units)
      displacement_m = told.displacement_m(units)
    else:
      go, x, y = np.asarray(action, float)
      if go <= 0:
        return None
      displacement_m = units.reach_m * np.array([x, y, 0.0])
    return flight.goal_m(position_m, displacement_m, agreement)

  def _note(self, begin_m: np.ndarray, goal_m: np.ndarray) -> None:
    self.begin_m, self.goal_m = begin_m.copy(), goal_m.copy()
