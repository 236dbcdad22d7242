"""The agreement of MoCom, as far as it is published, for its recordings.

MoCom is the work that the paper goes on from: one vehicle, an event camera and
a network that names motions (Zhang, Ho and Zhou, arXiv:2510.14770). From its
abstract are the four motions and what they stand for: START goes up and down,
END to the left and to the right, 1 from the left over the top to the right, 0
from the left over the bottom to the right. From the paper (section 'Motion
alphabet and message framing') is the payload that MoCom brought in: one bit of
direction, three of heading, two of distance. That a gesture lasts 7.1 to 8.4 s
and a gap 1.8 to 3.3 s is told of its timelines; it was taken over and could
not be compared with the text.

Everything else is chosen here: how large motions are, that every one begins and
ends at the hover point, and that up and down, like left and right, is to both
sides of it; minimum jerk between corners; and the camera, which is the paper's.
"""

from collections.abc import Sequence
import dataclasses

import numpy as np

from waggle_tasks.protocol import agreement, clock, frame, gestures, timing
from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.protocol import schedule as schedule_lib
from waggle_tasks.protocol.symbols import Symbol

GESTURE_S, GAP_S = (7.1, 8.4), (1.8, 3.3)
# Fits the picture of the paper's camera from 0.9 m on, the nearest of MoCom's
# distances.
REACH_M = 0.25  # To each side of the hover point.
_HOVER_S = 4.0  # Before START, as in the paper.


def codebook(duration_s: float = sum(GESTURE_S) / 2) -> gestures.Codebook:
  """Its motions.

  Args:
    duration_s: How long each lasts.
  """
  hover, left, right = (0.0, 0.0), (-REACH_M, 0.0), (REACH_M, 0.0)
  up, down = (0.0, REACH_M), (0.0, -REACH_M)
  ways = {
    Symbol.START: (hover, up, down, hover),
    Symbol.ZERO: (hover, left, down, right, hover),
    Symbol.ONE: (hover, left, up, right, hover),
    Symbol.END: (hover, left, right, hover),
  }
  return gestures.Codebook(
    tuple(gestures.Gesture(each, way, duration_s) for each, way in ways.items())
  )


def _mean_gap_s() -> float:
  return sum(GAP_S) / 2


def _tolerance() -> clock.Tolerance:
  """So wide that each of the timelines is in time.

  From the middle of a motion to that of the next, all of them are within a
  share of the mean one, which is what clocks may differ by.
  """
  mean_s = sum(GESTURE_S) / 2 + _mean_gap_s()
  longest_s = GESTURE_S[1] + GAP_S[1]
  return clock.Tolerance(clock_rate=round(longest_s / mean_s - 1, 3))


AGREEMENT = agreement.Agreement(
  codebook(), timing.Timing(_HOVER_S, 0.0, _mean_gap_s(), 0.0), _tolerance()
)


def timeline(
  message: payload_lib.Payload, rng: np.random.RandomState
) -> schedule_lib.Schedule:
  """A message as its timelines are: gestures and gaps of drawn lengths.

  Args:
    message: What is said.
    rng: Draws each length by itself.
  """
  slots: list[schedule_lib.Slot] = []
  begin_s = _HOVER_S
  for symbol in frame.motions(message):
    path = codebook(float(rng.uniform(*GESTURE_S)))[symbol]
    slots.append(schedule_lib.Slot(path, begin_s))
    begin_s = slots[-1].end_s + float(rng.uniform(*GAP_S))
  return schedule_lib.Schedule(tuple(slots))


@dataclasses.dataclass(frozen=True)
class Published:
  """What others tell of how often a motion is named rightly.

  Attributes:
    source: Where it stands.
    eye: What it was seen with.
    shares: The shares of motions that were named rightly, in percent.
    of: What each share is of.
  """

  source: str
  eye: str
  shares: Sequence[float]
  of: Sequence[str]


PUBLISHED = (
  Published(
    'MoCom, arXiv:2510.14770', 'event camera', (96.5, 95.4, 95.0),
    ('0.9 m', '1.2 m', '1.5 m'),
  ),
  Published(
    'MAVR-Net, arXiv:2510.15448', 'RGB, flow and masks', (97.8, 96.5, 92.8),
    ('short', 'medium', 'long'),
  ),
)  # fmt: skip
