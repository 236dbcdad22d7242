"""The agreed way to fly a message: straight, minimum jerk, then hold.

Observers fly it and the shared safety checks predict it, so it belongs to the
language that both sides speak.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import minimum_jerk

# With 3 s for the paper's 0.4 m, 'near and slow enough' begins after 2.742 s,
# and 0.4 s later is the paper's arrival, 3.144 s after the final null
# (98.784 s and 95.64 s, section 'Local faults and independent release').
DURATION_S = 3.0
# Arrival and hold (paper, sections 'Per-observer navigation' and 'Metrics and
# provenance checks').
ARRIVAL_ERROR_M = 0.015
ARRIVAL_SPEED_MPS = 0.025
ARRIVAL_DWELL_S = 0.4
HOLD_S = 2.0
# From where places are counted: the performer's hover, in front of which, on
# the -y side, everybody reads.
ORIGIN_M = np.zeros(3)


def goal_m(
  begin_m: np.ndarray,
  displacement_m: np.ndarray,
  agreement: agreement_lib.Agreement,
) -> np.ndarray:
  """Where a message leads its reader, at the agreed height.

  By equation 2, or to the reader's slot about the place that all are told. Its
  slot follows from its own place and the agreement alone: as many degrees as it
  stands aside of the front, seen from the agreed origin, its slot is twice
  aside of the nearest one, so that all who can read share the whole ring.

  Args:
    begin_m: (3,) where its reader hovers, at whatever height.
    displacement_m: (3,) what its payload says.
    agreement: What both sides know.

  Returns:
    (3,) world metres.
  """
  goal_m = begin_m + displacement_m
  if agreement.units.meaning == 'place':
    angle = 2 * math.atan2(begin_m[0], -begin_m[1])
    slot = np.array([math.sin(angle), -math.cos(angle), 0.0])
    goal_m = ORIGIN_M + displacement_m + agreement.units.slot_m * slot
  goal_m[2] = agreement.hover_height_m
  return goal_m


@dataclasses.dataclass(frozen=True, eq=False)
class Flight:
  """A straight flight between two points at rest.

  Attributes:
    begin_m: (3,) where it begins, in world metres.
    goal_m: (3,) where it ends.
    begin_s: When it begins, in seconds of simulation time.
  """

  begin_m: np.ndarray
  goal_m: np.ndarray
  begin_s: float

  def motion(self, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Position in m, velocity in m/s, acceleration in m/s^2, each (3,)."""
    return minimum_jerk.between(
      self.begin_m, self.goal_m, time_s - self.begin_s, DURATION_S
    )


def is_arrived(error_m: float, speed_mps: float) -> bool:
  """Whether one moment counts towards arrival."""
  return error_m < ARRIVAL_ERROR_M and speed_mps < ARRIVAL_SPEED_MPS
