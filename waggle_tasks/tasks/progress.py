"""What an observer has achieved so far, judged by true positions."""

import dataclasses

import numpy as np

from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import flight
from waggle_tasks.tasks import objectives

# An episode goes on a little longer than the 2 s of holding, so that they are
# found however arrival is measured.
_HOLD_S = flight.HOLD_S + 0.2
# An observer that leaves its place by more than this has moved.
MOTION_M = 0.01


@dataclasses.dataclass
class Progress:
  """One observer's way through an episode.

  Attributes:
    home_m: (3,) where it began.
    target_m: (3,) where the message says, or None when none is sent.
    agreement: What both sides know: the rate.
    trespassed: Whether it moved before a message was complete.
    arrived: Whether it stood at the target long enough.
    held_frames: Frames since it arrived, while it stayed there.
  """

  home_m: np.ndarray
  target_m: np.ndarray | None
  agreement: agreement_lib.Agreement = agreement_lib.Agreement()
  trespassed: bool = False
  arrived: bool = False
  held_frames: int = 0
  _dwell_frames: int = 0

  def update(
    self, position_m: np.ndarray, velocity_mps: np.ndarray, authorised: bool
  ) -> objectives.Moment:
    """Takes one frame's truth.

    Args:
      position_m: (3,) true position, less the drift that it was given.
      velocity_mps: (3,) true velocity, the same.
      authorised: Whether a whole message has been flown.

    Returns:
      What has become of it.
    """
    if not authorised or self.target_m is None:
      moved = np.linalg.norm(position_m - self.home_m) > MOTION_M
      if moved and not self.trespassed:
        self.trespassed = True
        return objectives.Moment(trespassed=True)
      return objectives.Moment()
    there = flight.is_arrived(
      float(np.linalg.norm(position_m - self.target_m)),
      float(np.linalg.norm(velocity_mps)),
    )
    self._dwell_frames = self._dwell_frames + 1 if there else 0
    if self.arrived:
      self.held_frames = self.held_frames + 1 if there else 0
    elif not self.trespassed and self._dwell_frames > self.agreement.frames(
      flight.ARRIVAL_DWELL_S
    ):
      self.arrived = True
      return objectives.Moment(arrived=True)
    return objectives.Moment()

  @property
  def done(self) -> bool:
    """Whether it has arrived and held its place for the 2 s asked for.

    A message that leads nowhere is never done: staying at home does not show
    that it was read.
    """
    if self.target_m is None or not self.arrived:
      return False
    leads_m = np.linalg.norm(self.target_m - self.home_m)
    hold = self.agreement.frames(_HOLD_S)
    return bool(leads_m > MOTION_M) and self.held_frames >= hold
