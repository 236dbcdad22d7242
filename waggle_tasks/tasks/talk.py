"""A conversation: every vehicle sees, and its action is its reference.

Who dances, who answers and who flies is a matter of the agents alone; the
broadcast is the special case in which one dances and all others read.
"""

from collections.abc import Mapping, Sequence
import dataclasses

from dm_control import mjcf
import numpy as np

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import observer
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import reference
from waggle_tasks.tasks import (
  actions,
  episode_clock,
  fleet,
  safety,
  seeing,
  switches,
)
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import drift as drift_lib

# How far a reference may be from the place that is held, aside, and beyond the
# highest and lowest level.
_ASIDE_M, _BEYOND_M = 0.005, 0.02


@dataclasses.dataclass(frozen=True, eq=False)
class TalkParts:
  """The built parts of a conversation; entities belong to one task only.

  Attributes:
    room: The arena.
    members: The vehicles, by number.
    poses: Where each starts, by the name of its model.
    duration_s: How long an episode lasts at most.
    agreement: What all know.
    dynamics: One of `limits.DYNAMICS`.
    drift: How far vehicles wander; all as observers do.
    air: See `parts.Parts`.
    estimator: See `parts.Parts`.
  """

  room: flight_room.FlightRoom
  members: tuple[observer.Observer, ...]
  poses: Mapping[str, layouts.Pose]
  duration_s: float
  agreement: agreement_lib.Agreement
  dynamics: str = 'ideal'
  drift: drift_lib.Drift = drift_lib.Drift()
  air: air_lib.Air = air_lib.Air()
  estimator: str = 'none'


class Talk(seeing.Seeing):
  """Vehicles of which each sees, dances and flies as its agent says.

  Observations are a list of dicts, one for each member: `camera` (H, W, 3)
  uint8 of the agreed camera, `time_s` () float64 and `position_m` (3,) float64.
  Actions are a list of (13,) float64 arrays, see `reference.Reference`.

  A reference that stays above the place that is held, within the levels of the
  language, is a dance. One that has a goal elsewhere is a flight: one is
  begun in an episode, and only if it passes nobody too closely. Anything else
  is not followed.

  Rewards are a list of floats, -1 on contact and 0 otherwise, and the discount
  is 0 on contact: what a conversation is worth, its members' agents tell. An
  episode ends on contact and at the end of its time.
  """

  def __init__(self, parts: TalkParts) -> None:
    """Puts the vehicles into the room.

    Args:
      parts: What the task is made of.
    """
    self._parts = parts
    members = {m.mjcf_model.model: m for m in parts.members}
    vehicles = fleet.Fleet(
      parts.room, members, parts.poses, parts.dynamics, parts.agreement.frame_s
    )
    super().__init__(parts.room, parts.agreement, members, vehicles)

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Places the vehicles.

    Raises:
      StepError: if the time step is not that which was compiled.
      ObservableError: if something is to be observed that nobody can see.
    """
    switches.check(self, self.observers, physics)
    self._fleet.place(physics, 0.0, random_state)
    draw = self._parts.drift.observer
    self._fleet.let_drift(
      {
        name: draw(random_state, home.yaw_rad, self.agreement.rate_hz)
        for name, home in self._fleet.homes.items()
      }
    )
    self._fleet.begin(physics, self._parts, random_state)
    self._begin(physics)
    self._gates = {
      name: safety.Gate(name, reference.Reference.hover(place_m))
      for name, place_m in self._fleet.positions_m(physics).items()
    }

  def before_step(
    self,
    physics: mjcf.Physics,
    action: Sequence[np.ndarray],
    random_state: np.random.RandomState,
  ) -> None:
    """Commands the vehicles for the coming control step.

    Raises:
      ActionError: if the action is not one finite reference per member.
      StepError: if the physics was set to another time.
    """
    super().before_step(physics, action, random_state)
    if self._clock.was_set(physics):
      raise episode_clock.StepError(
        '`time` must not be set in a conversation, as members go on by their'
        ' own clocks: `reset` and play the actions again'
      )
    wanted = actions.read(action, [*self._seeing])
    for gate, each in zip(self._gates.values(), wanted, strict=True):
      self._judge(physics, gate, each)
      followed = gate.follow(each, self._clock.time_s)
      if gate.plan is None and self._dances(gate.hold_m, each.position_m):
        followed = each
      motion = (
        followed.position_m,
        followed.velocity_mps,
        followed.acceleration_mps2,
      )
      self._fleet.command(
        physics, gate.name, self._clock.middle_s, motion, followed.turn_rad
      )

  def _judge(
    self, physics: mjcf.Physics, gate: safety.Gate, each: reference.Reference
  ) -> None:
    """Begins a flight that a member asks for, or refuses it."""
    positions_m = self._fleet.positions_m(physics)
    time_s = self._clock.time_s
    plan = gate.request(each, positions_m[gate.name], time_s)
    if plan is None:
      return
    others: dict[str, safety.Other] = {
      name: place_m
      for name, place_m in positions_m.items()
      if name != gate.name
    }
    for name, other in self._gates.items():
      if other.plan and name != gate.name:
        others[name] = other.plan
    reason = safety.conflict(plan, others, safety.MINIMUM_SPACING_M)
    gate.judge(plan, reason)

  def _dances(self, held_m: np.ndarray, place_m: np.ndarray) -> bool:
    """Whether a place is above or below the one that is held."""
    off_m = place_m - held_m
    low_m, high_m = self.agreement.lowest_m, self.agreement.highest_m
    aside = bool((np.abs(off_m[:2]) <= _ASIDE_M).all())
    return aside and low_m - _BEYOND_M <= off_m[2] <= high_m + _BEYOND_M

  @property
  def refusals(self) -> tuple[safety.Refusal, ...]:
    """The flights that the safety checks refused in this episode."""
    return tuple(g.refusal for g in self._gates.values() if g.refusal)

  def get_reward(self, physics: mjcf.Physics) -> list[float]:
    """One reward for each member, see the class."""
    del physics
    touched = {name for pair in self._contacts for name in pair}
    return [-1.0 if name in touched else 0.0 for name in self._seeing]

  def should_terminate_episode(self, physics: mjcf.Physics) -> bool:
    """Whether this was the last step, see the class."""
    del physics
    last = self.agreement.frames(self._parts.duration_s)
    return bool(self._contacts) or self._clock.frame >= last
