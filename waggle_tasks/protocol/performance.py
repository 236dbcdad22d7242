"""What a vehicle performs: a schedule, how much of it, and what it says."""

import dataclasses
import math

from waggle_tasks.protocol import payload
from waggle_tasks.protocol import schedule as schedule_lib


@dataclasses.dataclass(frozen=True)
class Performance:
  """A message, half of one, something else, or nothing at all.

  Attributes:
    schedule: All that there is to fly; nothing for a vehicle that hovers.
    stop_s: When it is cut short, in seconds of simulation time; infinite when
      nothing cuts it short.
    says: The message that all of it says; None when it says nothing.
    once_s: When it has said so for the first time; None for its end.
  """

  schedule: schedule_lib.Schedule = schedule_lib.Schedule(())
  stop_s: float = math.inf
  says: payload.Payload | payload.Data | None = None
  once_s: float | None = None

  @property
  def end_s(self) -> float:
    """When it ends, by itself or cut short; zero when nothing is flown."""
    return min(self.schedule.end_s, self.stop_s)

  @property
  def said_s(self) -> float:
    """When a reader may have understood it, if it was not cut short before."""
    return self.end_s if self.once_s is None else min(self.once_s, self.end_s)

  @property
  def message(self) -> payload.Payload | payload.Data | None:
    """What was said when it was flown whole, or None."""
    whole = 0 < self.schedule.end_s <= self.stop_s
    return self.says if whole else None
