"""Vehicles that are under way and avoid each other: their references.

A vehicle flies the reference that it asks for as long as that is safe and
nobody is in the way, and from then on its own way to the same goal.
"""

from collections.abc import Mapping
import dataclasses

import numpy as np

from waggle_tasks.protocol import reference
from waggle_tasks.tasks import avoidance

_THERE_M, _RESTS_MPS = 0.001, 0.005
_JUMP_M = 0.03  # Of a reference that begins where a vehicle hovers.


@dataclasses.dataclass(frozen=True, eq=False)
class Sight:
  """What one vehicle is told of the world, all by its own estimate.

  Attributes:
    own_m: (3,) where it takes itself to be.
    others_m: By name, (3,) where it takes all others to be.
    others_mps: By name, (3,) their velocities.
  """

  own_m: np.ndarray
  others_m: Mapping[str, np.ndarray]
  others_mps: Mapping[str, np.ndarray]


@dataclasses.dataclass(eq=False)
class _Way:
  """Where a vehicle under way should be now, and where it goes."""

  place_m: np.ndarray
  goal_m: np.ndarray
  velocity_mps: np.ndarray = dataclasses.field(
    default_factory=lambda: np.zeros(3)
  )
  undisturbed: bool = True
  arrived: bool = False


class Convoy:
  """Everybody who is under way in an episode."""

  def __init__(self, law: avoidance.Law, frame_s: float) -> None:
    """Begins with nobody.

    Args:
      law: What is kept.
      frame_s: How long a control step is.
    """
    self._law, self._frame_s = law, frame_s
    self._ways: dict[str, _Way] = {}

  @property
  def names(self) -> tuple[str, ...]:
    """Who is, or was, under way."""
    return tuple(self._ways)

  def begin(self, name: str, place_m: np.ndarray, goal_m: np.ndarray) -> None:
    """Lets a vehicle go from a hover to its goal, (3,) each."""
    self._ways[name] = _Way(place_m.copy(), goal_m.copy())

  def halt(self, name: str) -> None:
    """Lets a vehicle come to rest where it can."""
    way = self._ways[name]
    if not way.arrived:
      way.undisturbed = False
      way.goal_m = way.place_m.copy()

  def place_m(self, name: str) -> np.ndarray:
    """(3,) where a vehicle should be now."""
    return self._ways[name].place_m

  def arrived(self, name: str) -> bool:
    """Whether a vehicle has come to rest at its goal."""
    return self._ways[name].arrived

  def fly(
    self,
    wanted: Mapping[str, reference.Reference],
    sights: Mapping[str, Sight],
  ) -> dict[str, reference.Reference]:
    """The references of all who are under way, for the coming control step.

    Args:
      wanted: By name, what each asks for, for the middle of the step.
      sights: By name, what each is told.
    """
    flying = [name for name, way in self._ways.items() if not way.arrived]
    followed: dict[str, reference.Reference] = {}
    if flying:
      known, asked_mps = self._known(flying, wanted, sights)
      velocities = avoidance.step(self._law, known, self._frame_s)
      for row, name in enumerate(flying):
        followed[name] = self._advance(
          name, velocities[row], asked_mps[row], wanted[name]
        )
    for name, way in self._ways.items():
      if name not in followed:
        off_m = np.linalg.norm(wanted[name].position_m - way.goal_m)
        hover = reference.Reference.hover(way.goal_m)
        followed[name] = wanted[name] if off_m < _THERE_M else hover
    return followed

  def _known(
    self,
    flying: list[str],
    wanted: Mapping[str, reference.Reference],
    sights: Mapping[str, Sight],
  ) -> tuple[avoidance.Known, np.ndarray]:
    """What all who fly know, each seen from where it should be.

    Returns:
      That, and (N, 3) the velocities that it has them ask for.
    """
    rows, speeds, yields, asked = [], [], [], []
    for name in flying:
      sight, way = sights[name], self._ways[name]
      shift_m = way.place_m - sight.own_m
      rows.append([each + shift_m for each in sight.others_m.values()])
      speeds.append([*sight.others_mps.values()])
      yields.append([other in flying for other in sight.others_m])
      each = wanted[name]
      ahead = each.acceleration_mps2 * self._frame_s / 2
      asked.append(
        each.velocity_mps + ahead if way.undisturbed else np.full(3, np.nan)
      )
    ways = [self._ways[name] for name in flying]
    shape = len(flying), len(yields[0]), 3
    asked_mps = np.stack(asked)
    known = avoidance.Known(
      np.stack([way.place_m for way in ways]),
      np.stack([way.velocity_mps for way in ways]),
      np.stack([way.goal_m for way in ways]),
      np.reshape(rows, shape), np.reshape(speeds, shape),
      np.reshape(np.array(yields, bool), shape[:2]), asked_mps,
    )  # fmt: skip
    return known, asked_mps

  def _advance(
    self,
    name: str,
    velocity_mps: np.ndarray,
    asked_mps: np.ndarray,
    wanted: reference.Reference,
  ) -> reference.Reference:
    """Takes a vehicle to the end of the coming step."""
    way, frame_s = self._ways[name], self._frame_s
    end_m = wanted.position_m + asked_mps * frame_s / 2
    end_m = end_m - wanted.acceleration_mps2 * frame_s**2 / 8
    jump_m = np.linalg.norm(end_m - way.place_m - asked_mps * frame_s)
    if np.array_equal(velocity_mps, asked_mps) and jump_m < _JUMP_M:
      way.place_m, out = end_m, wanted
    else:
      way.undisturbed = False
      acceleration = (velocity_mps - way.velocity_mps) / frame_s
      mean_mps = (velocity_mps + way.velocity_mps) / 2
      middle_m = way.place_m + way.velocity_mps * frame_s / 2
      out = reference.Reference(
        middle_m + acceleration * frame_s**2 / 8, mean_mps, acceleration,
        wanted.turn_rad, way.goal_m,
      )  # fmt: skip
      way.place_m = way.place_m + mean_mps * frame_s
    way.velocity_mps = velocity_mps
    off_m = np.linalg.norm(way.place_m - way.goal_m)
    rests = np.linalg.norm(velocity_mps) < _RESTS_MPS
    way.arrived = bool(off_m < _THERE_M and rests)
    return out
