"""The observers' commands: who asked, who may fly, and what became of it."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import flight, reference
from waggle_tasks.tasks import convoy as convoy_lib
from waggle_tasks.tasks import progress, safety


class Flights:
  """All observers' flights in one episode."""

  def __init__(
    self,
    homes_m: Mapping[str, np.ndarray],
    displacement_m: np.ndarray | None,
    minimum_spacing_m: float,
    agreement: agreement_lib.Agreement,
    avoids: convoy_lib.Convoy | None = None,
    settle: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
  ) -> None:
    """Lets every observer wait at its place.

    Args:
      homes_m: By observer name, (3,) where it begins.
      displacement_m: (3,) what is commanded to all, or None for nothing.
      minimum_spacing_m: Smallest distance allowed between two vehicles.
      agreement: What both sides know: the rate and the height.
      avoids: Those under way where vehicles avoid each other; None where
        flights that are not safe are refused.
      settle: With that, what makes of a goal and a begin, (3,) each, the place
        that is flown to.
    """
    self._minimum_spacing_m = minimum_spacing_m
    self._convoy, self._settle = avoids, settle
    self._agreement, self._displacement_m = agreement, displacement_m
    self._gates: list[safety.Gate] = []
    self._progress: list[progress.Progress] = []
    self._requests: dict[str, flight.Flight] = {}
    for name, home_m in homes_m.items():
      hold = reference.Reference.hover(home_m)
      self._gates.append(safety.Gate(name, hold))
      target_m = None
      if displacement_m is not None:
        target_m = flight.goal_m(home_m, displacement_m, agreement)
      self._progress.append(progress.Progress(home_m, target_m, agreement))

  @property
  def begun(self) -> bool:
    """Whether anybody was given a command."""
    judged = any(gate.plan or gate.refusal for gate in self._gates)
    return judged or bool(self._requests)

  @property
  def done(self) -> bool:
    """Whether everybody has arrived and held its place."""
    return all(each.done for each in self._progress)

  @property
  def refusals(self) -> tuple[safety.Refusal, ...]:
    """The commands that the safety checks refused."""
    return tuple(gate.refusal for gate in self._gates if gate.refusal)

  def follow(
    self,
    wanted: Sequence[reference.Reference],
    positions_m: Mapping[str, np.ndarray],
    offsets_m: Mapping[str, np.ndarray],
    time_s: float,
    sights: Callable[[], Mapping[str, convoy_lib.Sight]] | None = None,
  ) -> dict[str, reference.Reference]:
    """The references that controllers get for those that observers ask for.

    Args:
      wanted: Each observer's reference.
      positions_m: By name, (3,) where every vehicle is.
      offsets_m: By name, (3,) how far each is from its reference by drift, and
        by what it does not know.
      time_s: Simulation time.
      sights: Where vehicles avoid each other, gives what each is told.
    """
    self._judge(wanted, positions_m, offsets_m, time_s)
    followed = {
      gate.name: gate.follow(each, time_s)
      for gate, each in zip(self._gates, wanted, strict=True)
    }
    if self._convoy and sights:
      for gate in self._gates:
        if gate.refusal and gate.name in self._convoy.names:
          self._convoy.halt(gate.name)
      if self._convoy.names:
        followed |= self._convoy.fly(followed, sights())
    return followed

  def _judge(
    self,
    wanted: Sequence[reference.Reference],
    positions_m: Mapping[str, np.ndarray],
    offsets_m: Mapping[str, np.ndarray],
    time_s: float,
  ) -> None:
    """Accepts or refuses the commands that have waited for others."""
    for gate, each in zip(self._gates, wanted, strict=True):
      plan = gate.request(each, positions_m[gate.name], time_s)
      if plan is not None:
        self._requests.setdefault(gate.name, plan)
    if not self._requests:
      return
    due = {
      name: plan
      for name, plan in self._requests.items()
      if safety.is_due(plan, time_s)
    }
    plans = {gate.name: gate.plan for gate in self._gates if gate.plan}
    others: dict[str, flight.Flight | np.ndarray] = {
      **positions_m,
      **plans,
      **self._requests,
    }
    reasons = {}
    if self._convoy is None:
      reasons = safety.refuse(due, others, positions_m, self._minimum_spacing_m)
    for gate, way in zip(self._gates, self._progress, strict=True):
      if gate.name in due:
        plan = self._requests.pop(gate.name)
        gate.judge(plan, reasons.get(gate.name))
        if self._convoy and self._settle:
          self._convoy.begin(
            gate.name, gate.hold_m, self._settle(plan.goal_m, gate.hold_m)
          )
        self._aim(way, positions_m[gate.name], offsets_m[gate.name])

  def _aim(
    self, way: progress.Progress, position_m: np.ndarray, offset_m: np.ndarray
  ) -> None:
    """Counts a target from where a message was truly read, (3,)."""
    if way.target_m is None or self._displacement_m is None:
      return
    if self._agreement.units.meaning == 'place':
      way.target_m = flight.goal_m(
        position_m, self._displacement_m, self._agreement
      )
    else:  # Drift and all; its height is the agreed one.
      way.shift(offset_m * (1.0, 1.0, 0.0))
    if self._settle and self._convoy:
      way.target_m = self._settle(way.target_m, position_m)

  def update(
    self,
    positions_m: Mapping[str, np.ndarray],
    velocities_mps: Mapping[str, np.ndarray],
    authorised: bool,
  ) -> list[float]:
    """Takes one frame's truth, less the drift; returns everybody's reward.

    Args:
      positions_m: By name, (3,) true positions.
      velocities_mps: By name, (3,) true velocities.
      authorised: Whether a whole message has been flown.
    """
    return [
      each.update(positions_m[gate.name], velocities_mps[gate.name], authorised)
      for gate, each in zip(self._gates, self._progress, strict=True)
    ]
