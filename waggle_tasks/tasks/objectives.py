"""What a vehicle is rewarded for."""

import dataclasses
from typing import Protocol


@dataclasses.dataclass(frozen=True)
class Moment:
  """What became of a vehicle in one control step.

  Attributes:
    arrived: Whether it has now stood long enough where its message says.
    trespassed: Whether it has now moved, for the first time, before a message
      was complete.
    touched: Whether it touched another vehicle or the room.
  """

  arrived: bool = False
  trespassed: bool = False
  touched: bool = False


class Objective(Protocol):
  """Tells what a moment is worth; one of your own needs no base class."""

  def reward(self, moment: Moment) -> float:
    """The reward of a control step."""
    ...


@dataclasses.dataclass(frozen=True)
class Arrive:
  """1 where the message says, and -1 for a motion that no message allows."""

  def reward(self, moment: Moment) -> float:
    """See `Objective`."""
    return float(moment.arrived) - float(moment.trespassed)


@dataclasses.dataclass(frozen=True)
class KeepClear:
  """-1 on contact."""

  def reward(self, moment: Moment) -> float:
    """See `Objective`."""
    return -1.0 if moment.touched else 0.0
