"""The camera that both sides know of: what a picture of a place looks like."""

import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import checks

MIN_SIDE_PX = 16
MAX_SIDE_PX = 8192
# Vertical field of view (paper, section 'Scene, sensors, and information
# boundaries').
FOVY_DEG = 60.0


def focal_length_px(rows: int, fovy_deg: float) -> float:
  """The focal length of a picture, by its vertical field of view."""
  return rows / 2 / math.tan(math.radians(fovy_deg) / 2)


class CameraError(errors.WaggleError):
  """A camera that makes no pictures."""


@dataclasses.dataclass(frozen=True)
class Camera:
  """A pinhole camera.

  By default that of the paper: 640 x 480 pixels and `FOVY_DEG`.

  Attributes:
    columns: Width of its picture in pixels.
    rows: Height of it.
    focal_px: Focal length in pixels.
  """

  columns: int = 640
  rows: int = 480
  focal_px: float = focal_length_px(480, FOVY_DEG)

  def __post_init__(self) -> None:
    sides = (MIN_SIDE_PX, MAX_SIDE_PX)
    bounds = {'columns': sides, 'rows': sides, 'focal_px': (1.0, 1e5)}
    checks.settle_numbers(self, bounds, CameraError)

  @classmethod
  def of(cls, columns: int, rows: int, fovy_deg: float) -> 'Camera':
    """The camera of a vertical field of view."""
    return cls(columns, rows, focal_length_px(rows, fovy_deg))

  @property
  def fovy_deg(self) -> float:
    """Its vertical field of view."""
    half_rad = math.atan(self.rows / 2 / self.focal_px)
    return round(math.degrees(2 * half_rad), 9)

  @property
  def size(self) -> tuple[int, int]:
    """Width and height of its picture."""
    return self.columns, self.rows

  @property
  def shape(self) -> tuple[int, int, int]:
    """Of its pictures as arrays: rows, columns and colours."""
    return self.rows, self.columns, 3

  @property
  def zoom(self) -> float:
    """Its focal length over that of the paper's camera."""
    return self.focal_px / Camera.focal_px
