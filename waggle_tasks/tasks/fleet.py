"""The vehicles of a task: where they are, and where they are told to be."""

from collections.abc import Sequence
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.arenas import layouts
from waggle_tasks.entities import autopilot, controller
from waggle_tasks.tasks import convoy, estimators, weather
from waggle_tasks.tasks import parts as parts_lib

Offsets = dict[str, tuple[np.ndarray, np.ndarray]]


class Fleet:
  """Vehicles with their controllers, each of which drifts by itself.

  Attributes:
    homes: Where each hovers in this episode.
    told_m: Where each was last told to be, (3,), before its drift.
  """

  def __init__(self, parts: parts_lib.Parts) -> None:
    """Puts the vehicles into their room.

    Args:
      parts: What the task is made of.
    """
    room, vehicles, poses = parts.room, parts.vehicles, parts.poses
    self._vehicles, self._poses = vehicles, poses
    attached = [room.add_vehicle(v, poses[n]) for n, v in vehicles.items()]
    self._joints = [each.freejoint for each in attached]
    yaws_rad = {name: poses[name].yaw_rad for name in vehicles}
    self._autopilot: autopilot.Autopilot | None = None
    self._controllers: dict[str, controller.Controller | autopilot.Seat] = {}
    if parts.dynamics == 'rotors':
      self._autopilot = autopilot.Autopilot(
        room.mjcf_model,
        vehicles,
        [*yaws_rad.values()],
        parts.agreement.frame_s,
      )
      self._controllers |= self._autopilot.seats
    else:
      for name, vehicle in vehicles.items():
        self._controllers[name] = controller.Controller(
          room.mjcf_model, vehicle, yaws_rad[name]
        )
    self.homes: dict[str, layouts.Pose] = {}
    self.told_m: dict[str, np.ndarray] = {}

  def after_compile(self, physics: mjcf.Physics) -> None:
    """Finds joints and actuators in the compiled model."""
    joints, axes = physics.bind(self._joints).element_id, np.arange(3)
    self._places = physics.model.jnt_qposadr[joints][:, None] + axes  # (N, 3)
    self._rates = physics.model.jnt_dofadr[joints][:, None] + axes  # (N, 3)
    if self._autopilot:
      self._autopilot.after_compile(physics)
    for each in self._controllers.values():
      if isinstance(each, controller.Controller):
        each.after_compile(physics)

  def begin(
    self,
    physics: mjcf.Physics,
    parts: parts_lib.Parts,
    random_state: np.random.RandomState,
  ) -> None:
    """Begins an episode, with every vehicle at its place.

    Args:
      physics: The compiled model.
      parts: What the task is made of.
      random_state: Of the episode: places, drifts, air and errors are drawn.
    """
    self._place(physics, parts.jitter_m, random_state)
    self._sways = {}
    for name, home in self.homes.items():
      dances = name in parts.performances
      draw = parts.drift.performer if dances else parts.drift.observer
      self._sways[name] = draw(
        random_state, home.yaw_rad, parts.agreement.rate_hz
      )
    self._drifts: tuple[float, Offsets] = math.nan, {}
    seconds, height_m = parts.duration_s, parts.agreement.hover_height_m
    air = weather.draw(parts.air, height_m, seconds, random_state)
    self._belief = estimators.draw(
      parts.estimator, len(self._vehicles), seconds, random_state
    )
    if self._autopilot:
      self._autopilot.begin(physics, air, self._belief)

  def _place(
    self,
    physics: mjcf.Physics,
    jitter_m: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Puts every vehicle where an episode begins."""
    poses = layouts.jittered(
      [self._poses[name] for name in self._vehicles], jitter_m, random_state
    )
    self.homes = dict(zip(self._vehicles, poses, strict=True))
    self.told_m = {n: np.array(p.position_m) for n, p in self.homes.items()}
    for name, pose in self.homes.items():
      half_rad = pose.yaw_rad / 2
      self._vehicles[name].set_pose(
        physics,
        np.array(pose.position_m),
        np.array([math.cos(half_rad), 0.0, 0.0, math.sin(half_rad)]),
      )

  def before_substep(self, physics: mjcf.Physics) -> None:
    """Flies what has to be flown from one physics step to the next."""
    if self._autopilot:
      self._autopilot.before_substep(physics)

  def command(
    self,
    physics: mjcf.Physics,
    name: str,
    middle_s: float,
    motion: Sequence[np.ndarray],  # Position, velocity, acceleration, (3,) each
    turn_rad: float = 0.0,
  ) -> None:
    """Commands a vehicle to where it drifts from where it should be.

    Args:
      physics: The compiled model.
      name: The vehicle.
      middle_s: The middle of the coming control step.
      motion: Where it should be.
      turn_rad: Its heading, counted from where it began.
    """
    self.told_m[name] = motion[0]
    sway = self._sways[name]
    drift = sway.at(middle_s)
    place_m, velocity_mps, acceleration_mps2 = (
      each + off[:3] for each, off in zip(motion, drift, strict=True)
    )
    self._controllers[name].command(
      physics,
      place_m,
      velocity_mps,
      acceleration_mps2,
      turn_rad + drift[0][3],
      sway.attitude(middle_s),
    )

  def positions_m(self, physics: mjcf.Physics) -> dict[str, np.ndarray]:
    """True position of every vehicle, (3,) world metres, by its name."""
    positions = physics.data.qpos[self._places]
    return dict(zip(self._vehicles, positions, strict=True))

  def velocities_mps(self, physics: mjcf.Physics) -> dict[str, np.ndarray]:
    """True velocity of every vehicle, (3,) world m/s, by its name."""
    velocities = physics.data.qvel[self._rates]
    return dict(zip(self._vehicles, velocities, strict=True))

  def flown(self) -> dict[str, tuple[float, np.ndarray, np.ndarray]]:
    """By name, tilt in rad, thrusts (4,) in N and air (3,) in m/s.

    Only of vehicles with rotors.
    """
    pilot = self._autopilot
    if pilot is None:
      return {}
    found = zip(pilot.tilts_rad, pilot.thrusts_n, pilot.air_mps, strict=True)
    return dict(zip(self._vehicles, found, strict=True))

  def errors_m(self, time_s: float) -> dict[str, np.ndarray]:
    """How far from itself each vehicle takes itself to be, (3,), by name."""
    errors = self._belief.errors(time_s)
    nothing = np.zeros((len(self._vehicles), 3))
    places_m = nothing if errors is None else errors[0]
    return dict(zip(self._vehicles, places_m, strict=True))

  def sights(
    self, physics: mjcf.Physics, time_s: float
  ) -> dict[str, convoy.Sight]:
    """What each vehicle is told of all, by its name.

    It sees where others are beside it, so that its own errors are in all of it.
    """
    errors = self._belief.errors(time_s)
    places_m, rates_mps = (
      physics.data.qpos[self._places],
      physics.data.qvel[self._rates],
    )
    out, names = {}, [*self._vehicles]
    for row, name in enumerate(names):
      off_m, off_mps = (0.0, 0.0) if errors is None else (
        errors[0][row], errors[1][row]
      )  # fmt: skip
      others_m = dict(zip(names, places_m + off_m, strict=True))
      others_mps = dict(zip(names, rates_mps + off_mps, strict=True))
      own_m = others_m.pop(name)
      del others_mps[name]
      out[name] = convoy.Sight(own_m, others_m, others_mps)
    return out

  def offsets_m(self, time_s: float) -> dict[str, np.ndarray]:
    """How far from its reference each vehicle is, (3,), by its name.

    By its drift, and by what it does not know.
    """
    errors_m = self.errors_m(time_s)
    drifts = self.drifts(time_s)
    return {name: off[0] - errors_m[name] for name, off in drifts.items()}

  def steady(
    self, physics: mjcf.Physics, time_s: float, told: bool
  ) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Places and velocities less the drift, (3,) each, by vehicle.

    Args:
      physics: The compiled model.
      time_s: The time.
      told: Whether places are those that vehicles were told, where they have
        rotors: what air and errors do to them is nobody's command.
    """
    places_m, velocities_mps = (
      self.positions_m(physics),
      self.velocities_mps(physics),
    )
    for name, (place_m, rate_mps) in self.drifts(time_s).items():
      places_m[name] = places_m[name] - place_m
      velocities_mps[name] = velocities_mps[name] - rate_mps
    if told and self._autopilot:
      places_m = dict(self.told_m)
    return places_m, velocities_mps

  def drifts(self, time_s: float) -> Offsets:
    """Drift and its velocity at a time, (3,) each, by vehicle."""
    if self._drifts[0] != time_s:  # Several ask in one frame.
      sways = {name: sway.at(time_s) for name, sway in self._sways.items()}
      offsets = {
        name: (place[:3], rate[:3]) for name, (place, rate, _) in sways.items()
      }
      self._drifts = time_s, offsets
    return self._drifts[1]

  def attitudes_rad(self, time_s: float) -> dict[str, np.ndarray]:
    """Roll, pitch and yaw of the hover at a time, (3,), by vehicle."""
    out = {}
    for name, sway in self._sways.items():
      attitude = sway.attitude(time_s)
      out[name] = np.zeros(3) if attitude is None else attitude[0]
    return out
