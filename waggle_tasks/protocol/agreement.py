"""What both sides of the link know before a message, as one value."""

import dataclasses

from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import clock as clock_lib
from waggle_tasks.protocol import gestures, payload, timing


@dataclasses.dataclass(frozen=True)
class Agreement:
  """The language, its clock, what bits mean, and the observers' camera.

  Attributes:
    codebook: The gestures.
    pauses: The rests between them.
    tolerance: How far from its time a motion may be seen.
    units: The payload's fields, and what a count of each means.
    camera: What observers see with.
  """

  codebook: gestures.Codebook = gestures.v_codebook()
  pauses: timing.Timing = timing.Timing()
  tolerance: clock_lib.Tolerance = clock_lib.Tolerance()
  units: payload.Units = payload.Units()
  camera: camera_lib.Camera = camera_lib.Camera()

  @property
  def clock(self) -> clock_lib.Clock:
    """When the motions of a message come."""
    return clock_lib.Clock(self.codebook, self.pauses, self.tolerance)
