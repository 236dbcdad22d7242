"""When the performer moves and when it rests."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks


class TimingError(errors.WaggleError):
  """A pause that is negative, endless or not a number."""


@dataclasses.dataclass(frozen=True)
class Timing:
  """The pauses of a broadcast.

  The paper fixes the 2 s hover gap (section 'Visual null confirmation') and
  says that settling and the lead-in add to it; with 7.5 s gestures the rest
  follows from its END at 92.64 s: 4 + 8 x 7.5 + 7 x 4 = 92 s, and 0.64 s to
  see that the motion has ended.

  Attributes:
    initial_hover_s: Stillness before START, in s.
    settle_s: Stillness after each gesture, in s.
    gap_s: The explicit hover gap between gestures, in s.
    lead_in_s: Stillness before the next gesture, in s.
  """

  initial_hover_s: float = 4.0
  settle_s: float = 1.0
  gap_s: float = 2.0
  lead_in_s: float = 1.0

  def __post_init__(self) -> None:
    limits = {field.name: (0.0, 60.0) for field in dataclasses.fields(self)}
    checks.settle_numbers(self, limits, TimingError)

  @property
  def pause_s(self) -> float:
    """Stillness between two gestures."""
    return self.settle_s + self.gap_s + self.lead_in_s
