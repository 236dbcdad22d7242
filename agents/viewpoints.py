"""The numbers of where gestures may be seen from, see `views`."""

import dataclasses

from waggle_tasks.agents import group


@dataclasses.dataclass(frozen=True)
class Views(group.Group):
  """Where a codebook may be seen from.

  Attributes:
    max_angle_deg: Largest viewing angle to either side.
    angles: How many, from one side to the other.
    min_distance_m: Nearest view.
    max_distance_m: Farthest view.
    distances: How many, in equal ratios; with one, the nearest.
  """

  max_angle_deg: float = group.number(85.0, 0, 180)
  angles: int = group.number(35, 2, 181)
  min_distance_m: float = group.number(0.5, 0.2, 100)
  max_distance_m: float = group.number(4.0, 0.2, 100)
  distances: int = group.number(13, 1, 50)

  def __post_init__(self) -> None:
    super().__post_init__()
    if self.min_distance_m > self.max_distance_m:
      raise group.ReceiverError(
        '`min_distance_m` must be at most `max_distance_m`,'
        f' {self.max_distance_m:g}: got {self.min_distance_m:g}'
      )
