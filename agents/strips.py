"""Several dancers in one picture: a reader for each strip of it.

A reader follows one dancer, which hovers in the middle of what it is shown. It
is shown a strip of the picture about the place where the dancer must be, and
all strips are read at once. Whoever dances itself is deaf meanwhile, and then
begins with new readers.
"""

from collections.abc import Sequence
import dataclasses

import numpy as np

from waggle_tasks.agents import joint_receiver
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import seats

# Faster, in metres at the dancer, is no hover.
_MOVING_MPS = 0.1


@dataclasses.dataclass(frozen=True)
class Heard:
  """A frame that was read, or that began and failed.

  Attributes:
    time_s: Time of the image that tells so.
    member: In whose strip it was.
    bits: What it says; None for one that failed.
    reason: Why it failed.
  """

  time_s: float
  member: int
  bits: str | None
  reason: str = ''


class _Strip:
  """One strip and its reader."""

  def __init__(
    self, agreement: agreement_lib.Agreement, view: seats.View
  ) -> None:
    lens = agreement.camera
    narrow = camera_lib.Camera(2 * view.half_px, lens.rows, lens.focal_px)
    agreed = dataclasses.replace(agreement, camera=narrow)
    self._agreed = agreed
    self._columns = slice(
      view.column_px - view.half_px, view.column_px + view.half_px
    )
    self._reader = joint_receiver.JointReceiver(agreed)
    self._quick_px_s = _MOVING_MPS * lens.focal_px / view.distance_m
    self.member = view.member

  @property
  def rests(self) -> bool:
    """Whether its dancer is seen, and hovers."""
    track = self._reader.track
    if track is None or not track.valid:
      return False
    return track.speed_px_s <= self._quick_px_s

  def step(self, image: np.ndarray, time_s: float) -> list[Heard]:
    part = np.ascontiguousarray(image[:, self._columns])
    heard = []
    for event in self._reader.step(part, time_s):
      bits, reason = None, event.rejection or ''
      if event.word is not None and not reason:
        reason, bits = self._agreed.coding.judge(
          event.word, self._agreed.frame_bits, self._agreed.spoken.alphabet.size
        )
      if bits is not None or reason:
        heard.append(Heard(time_s, self.member, bits, reason))
    return heard


class Strips:
  """All strips of a member's picture.

  Attributes:
    busy: The members that are not seen at rest in the last image.
  """

  def __init__(
    self, agreement: agreement_lib.Agreement, views: Sequence[seats.View]
  ) -> None:
    """Makes new readers.

    Args:
      agreement: What the frames are that are read.
      views: Where the dancers are.
    """
    self._strips = [_Strip(agreement, view) for view in views]
    self.busy = frozenset(strip.member for strip in self._strips)

  def step(self, image: np.ndarray, time_s: float) -> tuple[Heard, ...]:
    """Takes an image, (H, W, 3) uint8 RGB, and its time."""
    heard: list[Heard] = []
    for strip in self._strips:
      heard += strip.step(image, time_s)
    self.busy = frozenset(s.member for s in self._strips if not s.rests)
    return tuple(heard)
