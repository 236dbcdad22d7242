"""What was seen in one slot of a frame, in as many numbers for each."""

import dataclasses

import numpy as np

from waggle_tasks.agents import lock, slots
from waggle_tasks.protocol import alphabets, levels

POINTS = 24  # Of a window, at equal times.
_STANDS_S = 0.1  # A place is known so long before and after it was seen.


@dataclasses.dataclass(frozen=True, eq=False)
class Window:
  """Where a target was in a slot.

  Attributes:
    places_m: (P, 2) right and down from where the dancer would hover, 0 where
      nothing was seen.
    seen: (P,) 1 where it was seen, and 0.
  """

  places_m: np.ndarray
  seen: np.ndarray

  @property
  def share(self) -> float:
    """What share of it was seen."""
    return float(self.seen.mean())


def slot_s(
  alphabet: levels.Levels | alphabets.Gestures, confirm_s: float
) -> float:
  """How long a window is: a slot, or END with its rest where that is shorter.

  Args:
    alphabet: What is flown.
    confirm_s: The rest after END that belongs to a frame.
  """
  return min(alphabet.slot_s, alphabet.end(0).duration_s + confirm_s)


def times_s(length_s: float) -> np.ndarray:
  """(P,) the times of a window's points, since its begin."""
  return (np.arange(POINTS) + 0.5) * length_s / POINTS


def of(
  samples: lock.Samples, begin_s: float, length_s: float, pose: slots.Pose
) -> Window:
  """The window of a slot.

  Args:
    samples: Where the target was seen.
    begin_s: When the slot begins by the clock of START.
    length_s: How long it is.
    pose: How the frame lies in the picture then.
  """
  at_s = begin_s + pose.late_s + times_s(length_s)
  part = samples.between(at_s[0] - 1.0, at_s[-1] + 1.0)
  if not len(part.times_s):
    return Window(np.zeros((POINTS, 2)), np.zeros(POINTS))
  away_s = np.abs(part.times_s[:, None] - at_s).min(axis=0)
  seen = (away_s <= _STANDS_S).astype(float)
  places_px = np.stack(
    [np.interp(at_s, part.times_s, axis) for axis in part.places_px.T], axis=1
  )
  places_m = (places_px - pose.home_px) / pose.scale_px
  return Window(places_m * seen[:, None], seen)
