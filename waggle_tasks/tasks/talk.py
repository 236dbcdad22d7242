"""A conversation: every vehicle sees, and its action is its reference.

Who dances, who answers and who flies is a matter of the agents alone; the
broadcast is the special case in which one dances and all others read.
"""

from collections.abc import Mapping

from dm_control import mjcf
import numpy as np

from waggle_tasks.protocol import reference
from waggle_tasks.tasks import episode_clock, safety, seeing

# How far a reference may be from the place that is held, aside, and beyond the
# highest and lowest level.
_ASIDE_M, _BEYOND_M = 0.005, 0.02


class Talk(seeing.Seeing):
  """Vehicles of which each sees, dances and flies as its agent says.

  Observations are a list of dicts, one for each member: `camera` (H, W, 3)
  uint8 of the agreed camera, `time_s` () float64 and `position_m` (3,) float64.
  Actions are a list of (13,) float64 arrays, see `reference.Reference`.

  A reference that stays above the place that is held, within the levels of the
  language, is a dance. One that has a goal elsewhere is a flight: one is
  begun in an episode, and only if it passes nobody too closely. Anything else
  is not followed.

  What a conversation is worth, its members' agents tell: made of a
  `Conversation`, its rewards are -1 on contact and 0 otherwise
  (`objectives.KeepClear`). An episode ends on contact and at the end of its
  time.
  """

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """See `Seeing`; every member hovers at its place."""
    super().initialize_episode(physics, random_state)
    self._gates = {
      name: safety.Gate(name, reference.Reference.hover(place_m))
      for name, place_m in self._fleet.positions_m(physics).items()
    }

  def _replay(self, physics: mjcf.Physics) -> None:
    """See `Seeing`."""
    raise episode_clock.StepError(
      '`time` must not be set in a conversation, as members go on by their own'
      ' clocks: `reset` and play the actions again'
    )

  def _follow(
    self, physics: mjcf.Physics, wanted: Mapping[str, reference.Reference]
  ) -> dict[str, reference.Reference]:
    """See `Seeing`."""
    followed = {}
    for name, each in wanted.items():
      gate = self._gates[name]
      self._judge(physics, gate, each)
      followed[name] = gate.follow(each, self._clock.time_s)
      if gate.plan is None and self._dances(gate.hold_m, each.position_m):
        followed[name] = each
    return followed

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
