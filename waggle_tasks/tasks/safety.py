"""Shared safety: a flight whose spacing would be unsafe is not begun.

The checks see true positions and planned paths; they reject, and neither
avoid nor replan (paper, section 'Per-observer navigation'). That is 'refuse';
with 'avoid' every command is accepted, and vehicles keep away from each other
by themselves, see `convoy`.
"""

from collections.abc import Callable, Mapping, Sequence
import dataclasses

import numpy as np

from waggle_tasks.protocol import flight, reference
from waggle_tasks.tasks import detours

# Between two centres of mass. Vehicles are 0.137 m across their rotors, so
# this leaves 2 cm.
MINIMUM_SPACING_M = 0.16
SAFETIES = ('refuse', 'avoid')
# How much further apart those who avoid are kept: controllers lag a little.
_LAG_M = 0.02
# A place beside one that does not leave is so much further away than that.
_BESIDE_M = 0.02
# How long a plan waits to be judged together with those of neighbours that
# confirm the same message a few frames later. A minimum-jerk flight moves
# less than 2 mm in that time, so the vehicle can hold its place.
_PATIENCE_S = 0.2
# A goal nearer than this to the hold position is no command.
COMMAND_M = 0.01
# How far a reference may be from the way that was judged.
_CORRIDOR_M = 0.05
# Moments at which the spacing of two plans is compared.
_MOMENTS_S = np.linspace(0.0, flight.DURATION_S, 61)
# Where another vehicle is going to be: on its own plan, where it stays, (3,),
# or, of one that dances, at a time, (3,).
Other = flight.Flight | np.ndarray | Callable[[float], np.ndarray]


def kept_m(wander_m: float, minimum_m: float = MINIMUM_SPACING_M) -> float:
  """How far apart those who avoid are kept.

  Args:
    wander_m: How much nearer hover and errors bring two vehicles.
    minimum_m: Smallest distance allowed between two centres of mass.
  """
  return minimum_m + _LAG_M + wander_m


def settled_m(
  goal_m: np.ndarray,
  begin_m: np.ndarray,
  dancers_m: Sequence[np.ndarray],
  kept_m: float,
) -> np.ndarray:
  """Where a message leads to with 'avoid', (3,).

  Dancers do not leave: a place that is theirs stands for the nearest one beside
  them.

  Args:
    goal_m: (3,) the place that the message says.
    begin_m: (3,) where its reader is.
    dancers_m: (3,) where each dancer is.
    kept_m: See the function of this name.
  """
  dancers = np.reshape(dancers_m, (-1, 3))
  near = dancers[np.abs(dancers[:, 2] - goal_m[2]) < kept_m]
  return detours.free_m(goal_m, begin_m, near, kept_m + _BESIDE_M)


@dataclasses.dataclass(frozen=True)
class Refusal:
  """A command that was not followed.

  Attributes:
    time_s: Simulation time.
    vehicle: Whose command it was.
    reason: Why.
  """

  time_s: float
  vehicle: str
  reason: str


def is_due(plan: flight.Flight, time_s: float) -> bool:
  """Whether a plan has waited long enough to be judged."""
  return time_s > plan.begin_s + _PATIENCE_S - 1e-6


def conflict(
  plan: flight.Flight,
  others: Mapping[str, Other],
  minimum_m: float,
) -> str | None:
  """Whether a plan comes too near to another vehicle.

  Args:
    plan: The flight to judge.
    others: By vehicle name, where it is going to be.
    minimum_m: Smallest distance allowed between two centres of mass.

  Returns:
    The reason for refusing it, or None.
  """
  times_s = plan.begin_s + _MOMENTS_S
  own_m = np.stack([plan.motion(t)[0] for t in times_s])  # (T, 3)
  for name, other in others.items():
    if isinstance(other, flight.Flight):
      other = np.stack([other.motion(t)[0] for t in times_s])
    elif callable(other):
      other = np.stack([other(t) for t in times_s])
    nearest_m = np.linalg.norm(own_m - other, axis=1).min()
    if nearest_m < minimum_m:
      return (
        f'the way would pass {name} at {nearest_m:.3f} m, under'
        f' {minimum_m:.3f} m'
      )
  return None


def refuse(
  due: Mapping[str, flight.Flight],
  others: Mapping[str, Other],
  positions_m: Mapping[str, np.ndarray],
  minimum_m: float,
) -> dict[str, str]:
  """Which of several plans to refuse, and why.

  Who is refused stays where it is, so whoever counted on its leaving is
  refused too.

  Args:
    due: The plans to judge, by vehicle name.
    others: By name, where every vehicle is going to be.
    positions_m: By name, where every vehicle is, (3,) each.
    minimum_m: Smallest distance allowed between two centres of mass.

  Returns:
    The reasons by name.
  """
  others, reasons = dict(others), dict[str, str]()
  while True:
    found = {}
    for name in due.keys() - reasons.keys():
      rest = {k: v for k, v in others.items() if k != name}
      if reason := conflict(due[name], rest, minimum_m):
        found[name] = reason
    if not found:
      return reasons
    reasons |= found
    others |= {name: positions_m[name] for name in found}


class Gate:
  """Lets one observer's references through once its command is accepted.

  Before a command, and after a refused one, the observer holds its place.
  One command is accepted in an episode.
  """

  def __init__(self, name: str, hold: reference.Reference) -> None:
    """Makes the gate of an observer that holds its place.

    Args:
      name: The observer's name.
      hold: Its hover at the beginning of the episode.
    """
    self.name = name
    self.plan: flight.Flight | None = None
    self.refusal: Refusal | None = None
    self._hold = hold

  @property
  def hold_m(self) -> np.ndarray:
    """(3,) the last place held."""
    return self._hold.position_m

  def request(
    self, wanted: reference.Reference, position_m: np.ndarray, time_s: float
  ) -> flight.Flight | None:
    """The plan that a reference asks for, when it is a first command.

    Args:
      wanted: The observer's reference.
      position_m: (3,) its true position.
      time_s: Simulation time.

    Returns:
      The flight to judge, or None when the observer hovers, or has already
      been judged.
    """
    if self.plan or self.refusal:
      return None
    if np.linalg.norm(wanted.goal_m - self._hold.goal_m) < COMMAND_M:
      return None
    return flight.Flight(position_m, wanted.goal_m, time_s)

  def judge(self, plan: flight.Flight, reason: str | None) -> None:
    """Accepts a plan, or refuses it for a reason."""
    if reason is None:
      self.plan = plan
    else:
      self._refuse(plan.begin_s, reason)

  def follow(
    self, wanted: reference.Reference, time_s: float
  ) -> reference.Reference:
    """The reference that the controller gets.

    Args:
      wanted: The observer's reference.
      time_s: Simulation time.

    Returns:
      `wanted` along an accepted way, otherwise the last place held.
    """
    if self.plan is None or self.refusal:
      return self._hold
    if reason := _astray(self.plan, wanted):
      self._refuse(time_s, reason)
    else:
      self._hold = reference.Reference.hover(wanted.position_m)
      return wanted
    return self._hold

  def _refuse(self, time_s: float, reason: str) -> None:
    self.refusal = Refusal(time_s, self.name, reason)


def _astray(plan: flight.Flight, wanted: reference.Reference) -> str | None:
  """Why a reference does not belong to an accepted plan."""
  if np.linalg.norm(wanted.goal_m - plan.goal_m) > COMMAND_M:
    return 'one command was already accepted in this episode'
  way = plan.goal_m - plan.begin_m
  offset = wanted.position_m - plan.begin_m
  # A way that leads nowhere has no length.
  along = np.clip(offset @ way / max(way @ way, 1e-12), 0.0, 1.0)
  aside_m = np.linalg.norm(offset - along * way)
  if aside_m > _CORRIDOR_M:
    return (
      f'the reference is {aside_m:.3f} m from its way, over {_CORRIDOR_M:.3f} m'
    )
  return None
