"""How the room looks: the choices that change every pixel."""

import dataclasses

from waggle_tasks import errors

FLOORS = ('honeycomb', 'plain')


class AppearanceError(errors.WaggleError):
  """A choice of appearance that does not exist."""


@dataclasses.dataclass(frozen=True)
class Appearance:
  """What observers see around the performer.

  Attributes:
    floor: one of `FLOORS`.
    brightness: scales every light, in (0, 2]; 1 is the room as designed.
    shadows: whether lights cast shadows; off, so that an image can be put
      together from parts.
  """

  floor: str = 'honeycomb'
  brightness: float = 1.0
  shadows: bool = False

  def __post_init__(self) -> None:
    if self.floor not in FLOORS:
      raise AppearanceError(
        f'`floor` must be one of {list(FLOORS)}: got {self.floor!r}.'
      )
    if not 0.0 < self.brightness <= 2.0:
      raise AppearanceError(
        f'`brightness` must be in (0, 2]: got {self.brightness}.'
      )
    if not isinstance(self.shadows, bool):
      raise AppearanceError(
        f'`shadows` must be True or False: got {self.shadows!r}.'
      )
