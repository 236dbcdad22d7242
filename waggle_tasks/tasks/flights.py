"""The observers' commands: who asked, who may fly, and what became of it."""

from collections.abc import Mapping

from dm_control import mjcf
import numpy as np

from waggle_tasks.arenas import layouts
from waggle_tasks.protocol import flight, payload, reference
from waggle_tasks.tasks import escort as escort_lib
from waggle_tasks.tasks import fleet as fleet_lib
from waggle_tasks.tasks import objectives, progress, safety
from waggle_tasks.tasks import parts as parts_lib

_LEVEL = np.array([1.0, 1.0, 0.0])


class Flights:
  """All observers' flights in one episode."""

  def __init__(
    self, parts: parts_lib.Parts, homes: Mapping[str, layouts.Pose]
  ) -> None:
    """Lets every observer wait at its place.

    Args:
      parts: What the task is made of.
      homes: Where each vehicle begins, by its name.
    """
    self._agreement = parts.agreement
    self._minimum_spacing_m = parts.minimum_spacing_m
    homes_m = {name: np.array(pose.position_m) for name, pose in homes.items()}
    self._dancers = {n: parts.vehicles[n] for n in parts.performances}
    self._homes = homes
    dancers_m = [homes_m.pop(name) for name in self._dancers]
    self._escort: escort_lib.Escort | None = None
    if parts.safety == 'avoid':
      self._escort = escort_lib.Escort(parts, dancers_m)
    message = parts.performances[parts.performer].message
    self._displacement_m: np.ndarray | None = None
    if isinstance(message, payload.Payload):  # Data command nothing.
      self._displacement_m = message.displacement_m(self._agreement.units)
    self._gates: list[safety.Gate] = []
    self._progress: list[progress.Progress] = []
    self._requests: dict[str, flight.Flight] = {}
    for name, home_m in homes_m.items():
      hold = reference.Reference.hover(home_m)
      self._gates.append(safety.Gate(name, hold))
      target_m = None
      if self._displacement_m is not None:
        target_m = flight.goal_m(home_m, self._displacement_m, self._agreement)
      way = progress.Progress(home_m, target_m, self._agreement)
      self._progress.append(way)

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
  def achieved(self) -> tuple[progress.Progress, ...]:
    """What each observer has achieved, in their order."""
    return tuple(self._progress)

  @property
  def refusals(self) -> tuple[safety.Refusal, ...]:
    """The commands that the safety checks refused."""
    return tuple(gate.refusal for gate in self._gates if gate.refusal)

  def follow(
    self,
    wanted: Mapping[str, reference.Reference],
    fleet: fleet_lib.Fleet,
    physics: mjcf.Physics,
    time_s: float,
  ) -> dict[str, reference.Reference]:
    """The references that controllers get for those that observers ask for.

    Args:
      wanted: Each observer's reference, by its name.
      fleet: The vehicles.
      physics: Where they are.
      time_s: Simulation time.
    """
    positions_m = fleet.positions_m(physics)
    for gate, way in zip(self._gates, self._progress, strict=True):
      plan = gate.request(wanted[gate.name], positions_m[gate.name], time_s)
      if plan is not None and gate.name not in self._requests:
        self._requests[gate.name] = plan
        self._aim(gate, way, fleet, positions_m[gate.name], time_s)
    self._judge(positions_m, time_s)
    followed = {
      gate.name: gate.follow(wanted[gate.name], time_s) for gate in self._gates
    }
    if self._escort:
      refused = [gate.name for gate in self._gates if gate.refusal]
      followed |= self._escort.fly(
        followed, refused, lambda: fleet.sights(physics, time_s)
      )
    return followed

  def _judge(
    self, positions_m: Mapping[str, np.ndarray], time_s: float
  ) -> None:
    """Accepts or refuses the commands that have waited for others."""
    if not self._requests or (self._escort and not self._escort.free(time_s)):
      return
    due = {
      name: plan
      for name, plan in self._requests.items()
      if safety.is_due(plan, time_s)
    }
    plans = {gate.name: gate.plan for gate in self._gates if gate.plan}
    others: dict[str, safety.Other] = {
      **positions_m,
      **self._dances(positions_m, time_s),
      **plans,
      **self._requests,
    }
    reasons = {}
    if self._escort is None:
      reasons = safety.refuse(due, others, positions_m, self._minimum_spacing_m)
    for gate in self._gates:
      if gate.name in due:
        plan = self._requests.pop(gate.name)
        gate.judge(plan, reasons.get(gate.name))
        if self._escort:
          self._escort.begin(gate.name, gate.hold_m, plan.goal_m)

  def _dances(
    self, positions_m: Mapping[str, np.ndarray], time_s: float
  ) -> dict[str, safety.Other]:
    """Where dancers are going to be: they may say their message again."""

    def way(name: str) -> safety.Other:
      home, dancer = self._homes[name], self._dancers[name]

      def told_m(at_s: float) -> np.ndarray:
        home_m = np.array(home.position_m)
        return dancer.motion(home_m, home.yaw_rad, at_s)[0]

      now_m = told_m(time_s)
      return lambda at_s: positions_m[name] + (told_m(at_s) - now_m)

    return {name: way(name) for name in self._dancers}

  def _aim(
    self,
    gate: safety.Gate,
    way: progress.Progress,
    fleet: fleet_lib.Fleet,
    position_m: np.ndarray,
    time_s: float,
  ) -> None:
    """Counts a target from where a message was read, drift and all.

    What it means is a matter of where its reader took itself to be, and is
    judged by where that truly is. A place is the same for all, whoever errs.
    """
    if way.target_m is None or self._displacement_m is None:
      return
    error_m = fleet.errors_m(time_s)[gate.name] * _LEVEL
    is_place = self._agreement.units.meaning == 'place'
    if is_place:
      goal_m = flight.goal_m(
        position_m + error_m, self._displacement_m, self._agreement
      )
    else:
      offset_m = fleet.offsets_m(time_s)[gate.name] * _LEVEL
      goal_m = way.target_m + (offset_m + error_m)
    if self._escort:
      goal_m = self._escort.settled_m(goal_m, gate.hold_m)
    way.target_m = goal_m if is_place else goal_m - error_m

  def update(
    self,
    positions_m: Mapping[str, np.ndarray],
    velocities_mps: Mapping[str, np.ndarray],
    authorised: bool,
  ) -> dict[str, objectives.Moment]:
    """Takes one frame's truth, less the drift; tells what has become of all.

    Args:
      positions_m: By name, (3,) true positions.
      velocities_mps: By name, (3,) true velocities.
      authorised: Whether a whole message has been flown.
    """
    return {
      gate.name: each.update(
        positions_m[gate.name], velocities_mps[gate.name], authorised
      )
      for gate, each in zip(self._gates, self._progress, strict=True)
    }
