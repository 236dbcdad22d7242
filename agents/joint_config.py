"""Every number of the receiver that reads frames as a whole."""

import dataclasses

from waggle_tasks.agents import config, group


@dataclasses.dataclass(frozen=True)
class Reading(group.Group):
  """When what was seen is a frame.

  Attributes:
    max_start: What a START may leave, as a share of its size.
    max_distance_m: How far away a dancer may be, by the size of START.
    start_rest_s: How much of the rest before START belongs to it.
    min_seen: What share of START, and of END with its rest, must be seen.
    min_clear: How much nearer than any other a symbol must be, as a share of
      how far that is from it: less is an erasure.
    max_misfit: How far a symbol may be from what was seen, as a share of the
      squared distance to the next one: 0.25 is half-way.
    max_worst: The same of any one symbol: a word of which one is another level
      is none, even if a code would mend it and a wander would explain it, nor
      one of which a gesture was broken off.
    max_mended: How much nearer than a word of the code any other may be, as a
      share of how far they are apart: 1 where the other was seen as it should
      be. A code fills in what was not seen, and mends what was seen no further.
    max_end: The same of END and the rest after it, beside a rest without END.
    max_rest: How far from the hover point the dancer may rest before START and
      after END, by what was seen of the frame between, as a share of how far
      the nearest level is.
    max_astray: What share of the track may be where no symbol is flown.
    max_angle_deg: Largest viewing angle to either side...
    angles: ...and how many, from one side to the other.
  """

  max_start: float = group.number(0.15, 0, 1)
  max_distance_m: float = group.number(6.0, 0.5, 100)
  start_rest_s: float = group.number(0.3, 0, 10)
  min_seen: float = group.number(0.5, 0.1, 1)
  min_clear: float = group.number(0.4, 0, 1)
  max_misfit: float = group.number(0.2, 0, 1)
  max_worst: float = group.number(0.18, 0, 1)
  max_mended: float = group.number(0.2, 0, 1)
  max_end: float = group.number(0.25, 0, 1)
  max_rest: float = group.number(0.45, 0, 1)
  max_astray: float = group.number(0.2, 0, 1)
  max_angle_deg: float = group.number(85.0, 0, 90)
  angles: int = group.number(35, 1, 181)


@dataclasses.dataclass(frozen=True)
class Config:
  """The receiver's numbers.

  Attributes:
    tracking: How the target is followed.
    reading: When what was seen is a frame.
  """

  tracking: config.Differencing = config.Differencing(
    learn_s=0.7,
    lost_share=0.4,
    most_share=2.5,
    most_wider=1.5,
    most_higher=2.5,
    reach_widths=6.0,
    forget_s=2.5,
    relearn_s=6.0,
  )
  reading: Reading = Reading()

  def __post_init__(self) -> None:
    group.check_kinds(self)
