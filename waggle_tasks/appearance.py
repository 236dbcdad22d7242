"""How the room looks: the choices that change every pixel."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks

FLOORS = ('honeycomb', 'plain', 'clutter')
WALLS = ('plain', 'clutter')
SUNS = ('none', 'fixed', 'moving')


class AppearanceError(errors.WaggleError):
  """A choice of appearance that does not exist."""


@dataclasses.dataclass(frozen=True)
class Appearance:
  """What is around the vehicles.

  Attributes:
    floor: The floor of the room, one of `FLOORS`; 'clutter' is full of corners
      and edges.
    walls: The walls and the ceiling of the room, one of `WALLS`.
    sun: A low sun, one of `SUNS`; vehicles have shadows on the floor then,
      which observers see too. A moving one takes a minute for its swing.
    furniture: Seed of what stands and hangs along the walls: tables, shelves,
      boxes, pictures, and windows with their light; 0 for nothing.
    brightness: Scales every light, 0.1 to 2; 1 is the room as designed.
    shadows: Whether the main light casts shadows in the shared views; the
      observers' own images never show those.
  """

  floor: str = 'honeycomb'
  walls: str = 'plain'
  sun: str = 'none'
  furniture: int = 0
  brightness: float = 1.0
  shadows: bool = False

  def __post_init__(self) -> None:
    checks.choice('floor', self.floor, FLOORS, AppearanceError)
    checks.choice('walls', self.walls, WALLS, AppearanceError)
    checks.choice('sun', self.sun, SUNS, AppearanceError)
    limits = {'brightness': (0.1, 2), 'furniture': (0, 2**32 - 1)}
    checks.settle_numbers(self, limits, AppearanceError)
    shadows = checks.switch('shadows', self.shadows, AppearanceError)
    checks.settle(self, 'shadows', shadows)
