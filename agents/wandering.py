"""The numbers of a target that wanders while it hovers, see `wander`."""

import dataclasses

from waggle_tasks.agents import group


@dataclasses.dataclass(frozen=True)
class Wandering(group.Group):
  """What a rest of a target that wanders may be.

  Attributes:
    wander_times: Within how many root mean squares of its wandering it is...
    wander_widths: ...and at least within so many apparent widths...
    most_wander_widths: ...but never farther from its place than this.
    back_widths: How near its place it is back from a motion: meanwhile that may
      have wandered, too.
    wander_speeds: Below how many root mean squares of its speed it is...
    most_wander_widths_s: ...but never faster than so many apparent widths a
      second.
  """

  wander_times: float = 8.0
  wander_widths: float = 0.3
  most_wander_widths: float = 0.5
  back_widths: float = 0.8
  wander_speeds: float = 4.0
  most_wander_widths_s: float = 1.0
