"""One camera's picture as far as it is drawn, and what it shows."""

import dataclasses
from typing import Any

import mujoco
import numpy as np

from waggle_tasks.entities import windows
from waggle_tasks.protocol import camera as camera_lib


def _unseen() -> Any:  # noqa: ANN401
  """What a canvas holds before it shows anything."""
  return dataclasses.field(default_factory=lambda: np.empty(0))


@dataclasses.dataclass(eq=False)
class Canvas:
  """A picture and what it shows.

  Attributes:
    pixels: (H, W, 3) uint8, the picture.
    room: (H, W, 3) uint8, the picture without what can move.
    poses: (M, 12) position and rotation of each part, as shown.
    places: (G, 3) and (G, 9) those of the geoms that can move.
    eye: (12,) that of the camera.
    boxes: (M, 4) windows that hold the parts.
    shown: The windows of the picture, each with the parts that it holds.
    looks: Version of the model's looks in it; 0 when nothing was drawn.
    rooms: How often the room was drawn.
    lens: See `lens`.
  """

  pixels: np.ndarray
  room: np.ndarray
  poses: np.ndarray = _unseen()
  places: tuple[np.ndarray, np.ndarray] = (np.empty(0), np.empty(0))
  eye: np.ndarray = _unseen()
  boxes: np.ndarray = _unseen()
  shown: dict[windows.Window, frozenset[int]] = dataclasses.field(
    default_factory=dict
  )
  looks: int = 0
  rooms: int = 0
  lens: tuple[float, float, bool] = (0.0, 0.0, False)

  @property
  def size(self) -> tuple[int, int]:
    """Width and height of the picture."""
    height, width = self.pixels.shape[:2]
    return width, height


def lens(model: Any, camera_id: int) -> tuple[float, float, bool]:  # noqa: ANN401
  """Distance of the near plane, focal length in px, whether orthographic.

  Args:
    model: The compiled model.
    camera_id: One of its cameras.
  """
  near_m = float(model.vis.map.znear * model.stat.extent)
  fovy = float(model.cam_fovy[camera_id])
  height = int(model.cam_resolution[camera_id][1])
  orthographic = mujoco.mjtProjection.mjPROJ_ORTHOGRAPHIC
  if model.cam_projection[camera_id] == orthographic:
    return near_m, height / fovy, True  # `fovy` is the picture's height in m.
  return near_m, camera_lib.focal_length_px(height, fovy), False
