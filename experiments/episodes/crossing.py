"""Crossings: vehicles at random places that all go to random others at once.

They are flown in MuJoCo by the ideal controller, and nothing is drawn.
"""

from collections.abc import Mapping
import dataclasses
import itertools
import math

from dm_control import mjcf
import mujoco
import numpy as np

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import controller, crazyflie
from waggle_tasks.protocol import agreement, reference
from waggle_tasks.tasks import avoidance, contacts, convoy, safety

LIMIT_S = 60.0  # Who has not arrived by then is taken to be caught.
_APART_M = 0.3, 0.4  # Places at which they begin, and to which they go.
_FRAME_S = agreement.Agreement().frame_s
_STEPS = round(agreement.STEPS_HZ * _FRAME_S)
_HEIGHT_M = agreement.Agreement.hover_height_m


@dataclasses.dataclass(frozen=True)
class Crossing:
  """What came of one.

  Attributes:
    vehicles: How many there were.
    arrived: How many of them arrived.
    contacts: How many pairs touched.
    least_m: The least distance of two.
    slower: Their mean time to arrive, beside that of each flying alone.
    last_s: When the last one arrived; NaN if one did not.
  """

  vehicles: int
  arrived: int
  contacts: int
  least_m: float
  slower: float
  last_s: float


def half_side_m(vehicles: int) -> float:
  """Half of the side of the square in which so many cross."""
  return 0.2 + 0.35 * math.sqrt(vehicles)


class Airspace:
  """A room with a number of vehicles, for any number of crossings."""

  def __init__(self, vehicles: int) -> None:
    """Builds and compiles the room."""
    room = flight_room.FlightRoom()
    self._names = [f'vehicle_{k}' for k in range(1, vehicles + 1)]
    self._vehicles = [crazyflie.Crazyflie(name) for name in self._names]
    self._controllers = []
    for number, each in enumerate(self._vehicles):
      # Apart, as a model is compiled with all of them.
      room.add_vehicle(each, layouts.Pose((0.3 * number, 0, _HEIGHT_M), 0.0))
      self._controllers.append(
        controller.Controller(room.mjcf_model, each, 0.0)
      )
    self._physics = mjcf.Physics.from_mjcf_model(room.mjcf_model)
    self._physics.model.opt.timestep = 1 / agreement.STEPS_HZ
    for one in self._controllers:
      one.after_compile(self._physics)
    bodies = self._physics.bind([v.airframe for v in self._vehicles])
    roots = self._physics.model.body_rootid[bodies.element_id]
    joints = self._physics.model.body_jntadr[roots]
    self._places = self._physics.model.jnt_qposadr[joints][:, None] + range(3)
    self._rates = self._physics.model.jnt_dofadr[joints][:, None] + range(3)

  def fly(self, seed: int) -> Crossing:
    """Flies the crossing of a seed."""
    rng = np.random.RandomState(seed)
    count, half_m = len(self._names), half_side_m(len(self._names))
    begins_m, goals_m = (_draw(count, half_m, m, rng) for m in _APART_M)
    self._physics.reset()
    level = np.array([1.0, 0.0, 0.0, 0.0])
    for vehicle, place_m in zip(self._vehicles, begins_m, strict=True):
      vehicle.set_pose(self._physics, place_m, level)
    self._physics.forward()
    group = self._group(begins_m, goals_m)
    arrivals_s: dict[str, float] = {}
    wanted = self._wanted(goals_m)
    touched, least_m = set[tuple[str, str]](), math.inf
    for frame in range(round(LIMIT_S / _FRAME_S)):
      followed = group.fly(wanted, self._sights())
      self._command(followed)
      for _ in range(_STEPS):
        mujoco.mj_step(self._physics.model.ptr, self._physics.data.ptr)
        if self._physics.data.ncon:
          touched |= contacts.find(self._physics)
      least_m = min(least_m, _least_m(self._physics.data.qpos[self._places]))
      for name in self._names:
        if group.arrived(name):
          arrivals_s.setdefault(name, (frame + 1) * _FRAME_S)
      if len(arrivals_s) == count:
        break
    alone_s = self._alone_s(begins_m, goals_m)
    slower = [arrivals_s[n] / alone_s[n] for n in arrivals_s]
    last_s = max(arrivals_s.values()) if len(arrivals_s) == count else math.nan
    return Crossing(
      count, len(arrivals_s), len(touched), least_m,
      float(np.mean(slower or [math.nan])), last_s,
    )  # fmt: skip

  def _group(self, begins_m: np.ndarray, goals_m: np.ndarray) -> convoy.Convoy:
    group = convoy.Convoy(avoidance.Law(safety.kept_m(0.0)), _FRAME_S)
    for name, *ends_m in zip(self._names, begins_m, goals_m, strict=True):
      group.begin(name, *ends_m)
    return group

  def _wanted(self, goals_m: np.ndarray) -> dict[str, reference.Reference]:
    """What each asks for: to be at its goal."""
    hovers = map(reference.Reference.hover, goals_m)
    return dict(zip(self._names, hovers, strict=True))

  def _sights(self) -> dict[str, convoy.Sight]:
    places = self._physics.data.qpos[self._places].copy()
    rates = self._physics.data.qvel[self._rates].copy()
    out = {}
    for row, name in enumerate(self._names):
      others = [k for k in range(len(self._names)) if k != row]
      out[name] = convoy.Sight(
        places[row],
        {self._names[k]: places[k] for k in others},
        {self._names[k]: rates[k] for k in others},
      )
    return out

  def _command(self, followed: Mapping[str, reference.Reference]) -> None:
    for each, name in zip(self._controllers, self._names, strict=True):
      moment = followed[name]
      each.command(
        self._physics, moment.position_m, moment.velocity_mps,
        moment.acceleration_mps2,
      )  # fmt: skip

  def _alone_s(
    self, begins_m: np.ndarray, goals_m: np.ndarray
  ) -> dict[str, float]:
    """How long each takes where there is nobody else."""
    group, out = self._group(begins_m, goals_m), dict[str, float]()
    wanted = self._wanted(goals_m)
    alone = {
      n: convoy.Sight(b, {}, {})
      for n, b in zip(self._names, begins_m, strict=True)
    }
    for frame in range(round(LIMIT_S / _FRAME_S)):
      if len(out) == len(self._names):
        break
      followed = group.fly(wanted, alone)
      alone = {n: convoy.Sight(group.place_m(n), {}, {}) for n in followed}
      for name in self._names:
        if group.arrived(name):
          out.setdefault(name, (frame + 1) * _FRAME_S)
    return out


def _draw(
  count: int, half_m: float, apart_m: float, rng: np.random.RandomState
) -> np.ndarray:  # (N, 3)
  """Places in a square, none too near to another."""
  places = list[np.ndarray]()
  while len(places) < count:
    place_m = np.append(rng.uniform(-half_m, half_m, 2), _HEIGHT_M)
    if all(np.linalg.norm(place_m - each) >= apart_m for each in places):
      places.append(place_m)
  return np.array(places)


def _least_m(places_m: np.ndarray) -> float:
  pairs = itertools.combinations(range(len(places_m)), 2)
  one, other = np.array([*pairs]).T
  return float(np.linalg.norm(places_m[one] - places_m[other], axis=1).min())


def several(vehicles: int, seeds: range) -> list[Crossing]:
  """Flies some crossings, for a process of its own."""
  airspace = Airspace(vehicles)
  return [airspace.fly(seed) for seed in seeds]
