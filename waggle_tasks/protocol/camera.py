"""The camera that both sides know of: what a picture of a place looks like."""

import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import checks

MIN_SIDE_PX = 16
MAX_SIDE_PX = 8192


class CameraError(errors.WaggleError):
  """A camera that makes no pictures."""


@dataclasses.dataclass(frozen=True)
class Camera:
  """A pinhole camera.

  By default that of the paper: 640 x 480 pixels and a vertical field of view
  of 60 degrees (section 'Scene, sensors, and information boundaries').

  Attributes:
    columns: Width of its picture in pixels.
    rows: Height of it.
    focal_px: Focal length in pixels.
  """

  columns: int = 640
  rows: int = 480
  focal_px: float = 240 / math.tan(math.radians(30))

  def __post_init__(self) -> None:
    sides = (MIN_SIDE_PX, MAX_SIDE_PX)
    bounds = {'columns': sides, 'rows': sides, 'focal_px': (1.0, 1e5)}
    checks.settle_numbers(self, bounds, CameraError)

  @property
  def zoom(self) -> float:
    """Its focal length over that of the paper's camera."""
    return self.focal_px / Camera.focal_px
