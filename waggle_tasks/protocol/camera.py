"""The camera that both sides know of: what a picture of a place looks like."""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks
from waggle_tasks.protocol import lens as lens_lib

MIN_SIDE_PX = 16
MAX_SIDE_PX = 8192
# Vertical field of view (paper, section 'Scene, sensors, and information
# boundaries').
FOVY_DEG = 60.0
# Beyond this a picture of a pinhole, of which lenses' are made, is too large.
WIDEST_DEG = 75.0
PITCH_DEG, ROLL_DEG, READOUT_S = (-45.0, 45.0), (-180.0, 180.0), (0.0, 0.1)


def focal_length_px(rows: int, fovy_deg: float) -> float:
  """The focal length of a picture, by its vertical field of view."""
  return rows / 2 / math.tan(math.radians(fovy_deg) / 2)


class CameraError(errors.WaggleError):
  """A camera that makes no pictures."""


@dataclasses.dataclass(frozen=True)
class Camera:
  """A camera with its calibration.

  By default that of the paper: a level pinhole, 640 x 480 pixels and
  `FOVY_DEG`. The optical axis goes through the middle of the picture.

  Attributes:
    columns: Width of its picture in pixels.
    rows: Height of it.
    focal_px: Focal length in pixels.
    lens: What its lens does.
    pitch_deg: How far it looks up from the level, -45 to 45 degrees.
    roll_deg: How far it is turned clockwise about its axis, as who looks along
      it sees it, -180 to 180 degrees.
    readout_s: How long after the first row the last one is taken, 0 to 0.1 s;
      the time of a picture is that of its last row.
  """

  columns: int = 640
  rows: int = 480
  focal_px: float = focal_length_px(480, FOVY_DEG)
  lens: lens_lib.Lens = lens_lib.Lens()
  pitch_deg: float = 0.0
  roll_deg: float = 0.0
  readout_s: float = 0.0

  def __post_init__(self) -> None:
    sides = (MIN_SIDE_PX, MAX_SIDE_PX)
    bounds = {
      'columns': sides,
      'rows': sides,
      'focal_px': (1.0, 1e5),
      'pitch_deg': PITCH_DEG,
      'roll_deg': ROLL_DEG,
      'readout_s': READOUT_S,
    }
    checks.settle_numbers(self, bounds, CameraError)
    if self.lens.bends:
      self._check_corners()

  def _check_corners(self) -> None:
    """Refuses a lens that folds its picture, or sees too much."""
    far = np.linalg.norm(self.border, axis=1)
    if not (far <= math.tan(math.radians(WIDEST_DEG))).all():
      raise CameraError(
        f'`lens` must see the whole picture once, within {WIDEST_DEG:g} degrees'
        f' of its axis: got {self.lens!r} for {self.columns} x {self.rows}'
        f' pixels and a focal length of {self.focal_px:.1f}; choose a smaller'
        ' field of view'
      )

  @classmethod
  def of(
    cls,
    columns: int,
    rows: int,
    fovy_deg: float,
    lens: lens_lib.Lens = lens_lib.Lens(),
    pitch_deg: float = 0.0,
    roll_deg: float = 0.0,
    readout_s: float = 0.0,
  ) -> 'Camera':
    """The camera of a vertical field of view, through its lens."""
    focal_px = focal_length_px(rows, fovy_deg)
    if lens.bends:
      edge = lens.shown(np.array([0.0, math.tan(math.radians(fovy_deg) / 2)]))
      if not edge[1] > 0:
        raise CameraError(
          f'`lens` must show {fovy_deg / 2:g} degrees off its axis:'
          f' got {lens!r}'
        )
      focal_px = rows / 2 / float(edge[1])
    return cls(columns, rows, focal_px, lens, pitch_deg, roll_deg, readout_s)

  @property
  def fovy_deg(self) -> float:
    """Its vertical field of view."""
    half = self.rows / 2 / self.focal_px
    if self.lens.bends:
      half = float(self.lens.seen(np.array([0.0, half]))[1])
    return round(math.degrees(2 * math.atan(half)), 9)

  @property
  def is_plain(self) -> bool:
    """Whether it is a level pinhole."""
    return not (self.lens.bends or self.pitch_deg or self.roll_deg)

  @property
  def border(self) -> np.ndarray:
    """Where a pinhole shows the picture's border, (K, 2) focal lengths."""
    across = np.linspace(-0.5, 0.5, 33) * self.columns
    down = np.linspace(-0.5, 0.5, 33) * self.rows
    sides = [
      *([x, side * self.rows / 2] for x in across for side in (-1, 1)),
      *([side * self.columns / 2, y] for y in down for side in (-1, 1)),
    ]
    return self.lens.seen(np.array(sides) / self.focal_px)

  @property
  def mount(self) -> np.ndarray:
    """(3, 3) from its own axes to level ones: x right, y down, z ahead."""
    pitch, roll = math.radians(self.pitch_deg), math.radians(self.roll_deg)
    up = np.array([
      [1, 0, 0],
      [0, math.cos(pitch), -math.sin(pitch)],
      [0, math.sin(pitch), math.cos(pitch)],
    ])  # fmt: skip
    about = np.array([
      [math.cos(roll), -math.sin(roll), 0],
      [math.sin(roll), math.cos(roll), 0],
      [0, 0, 1],
    ])  # fmt: skip
    return up @ about

  def levelled(self, places_px: np.ndarray) -> np.ndarray:
    """Where a level pinhole of its focal length shows what it shows, (..., 2).

    Its lens and its mount undone, of places and not of pictures; NaN where it
    shows nothing, or nothing that is ahead.
    """
    middle_px = np.array([self.columns, self.rows]) / 2
    seen = self.lens.seen((places_px - middle_px) / self.focal_px)
    rays = np.concatenate([seen, np.ones_like(seen[..., :1])], axis=-1)
    rays = rays @ self.mount.T
    depth = np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
    return rays[..., :2] / depth * self.focal_px + middle_px

  def shown(self, places_px: np.ndarray) -> np.ndarray:
    """Where it shows what a level pinhole shows; `levelled` undone."""
    middle_px = np.array([self.columns, self.rows]) / 2
    seen = (places_px - middle_px) / self.focal_px
    rays = np.concatenate([seen, np.ones_like(seen[..., :1])], axis=-1)
    rays = rays @ self.mount
    depth = np.where(rays[..., 2:] > 0, rays[..., 2:], np.nan)
    return self.lens.shown(rays[..., :2] / depth) * self.focal_px + middle_px

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
