"""The vehicles of a task: where they are, and where they are told to be."""

from collections.abc import Mapping, Sequence
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.arenas import flight_room, layouts
from waggle_tasks.entities import controller, crazyflie
from waggle_tasks.tasks import drift as drift_lib

Offsets = dict[str, tuple[np.ndarray, np.ndarray]]


class Fleet:
  """Vehicles with their controllers, each of which drifts by itself.

  Attributes:
    homes: Where each hovers in this episode.
  """

  def __init__(
    self,
    room: flight_room.FlightRoom,
    vehicles: Mapping[str, crazyflie.Crazyflie],
    poses: Mapping[str, layouts.Pose],
  ) -> None:
    """Puts the vehicles into a room.

    Args:
      room: The room.
      vehicles: The vehicles by name.
      poses: Where each starts.
    """
    self._vehicles, self._poses = dict(vehicles), poses
    self._joints, self._controllers = [], {}
    for name, vehicle in self._vehicles.items():
      pose = poses[name]
      attached = room.add_vehicle(vehicle, pose)
      self._joints.append(attached.freejoint)
      self._controllers[name] = controller.Controller(
        room.mjcf_model, vehicle, pose.yaw_rad
      )
    self.homes: dict[str, layouts.Pose] = {}

  def after_compile(self, physics: mjcf.Physics) -> None:
    """Finds joints and actuators in the compiled model."""
    joints, axes = physics.bind(self._joints).element_id, np.arange(3)
    self._places = physics.model.jnt_qposadr[joints][:, None] + axes  # (N, 3)
    self._rates = physics.model.jnt_dofadr[joints][:, None] + axes  # (N, 3)
    for each in self._controllers.values():
      each.after_compile(physics)

  def place(
    self,
    physics: mjcf.Physics,
    jitter_m: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Puts every vehicle where an episode begins.

    Args:
      physics: The compiled model.
      jitter_m: Bound of each vehicle's x and y offset.
      random_state: Of the episode.
    """
    poses = layouts.jittered(
      [self._poses[name] for name in self._vehicles], jitter_m, random_state
    )
    self.homes = dict(zip(self._vehicles, poses, strict=True))
    for name, pose in self.homes.items():
      half_rad = pose.yaw_rad / 2
      self._vehicles[name].set_pose(
        physics,
        np.array(pose.position_m),
        np.array([math.cos(half_rad), 0.0, 0.0, math.sin(half_rad)]),
      )

  def let_drift(self, sways: Mapping[str, drift_lib.Sway]) -> None:
    """Takes how each vehicle drifts in an episode."""
    self._sways = sways
    self._drifts: tuple[float, Offsets] = math.nan, {}

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
