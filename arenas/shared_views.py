"""The cameras that everyone shares, set so that they show every vehicle."""

from collections.abc import Sequence
import functools
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.protocol import camera

SIZE_PX = camera.Camera().size  # Of a picture, like an observer's.
_ASPECT = SIZE_PX[0] / SIZE_PX[1]
_MARGIN_M = 0.35  # Around vehicles.
_DANCE_M = 0.7  # Highest point of a dance, above the hover: START's.

_TOP_HEIGHT_M = 6.5
# From the right of the observers, looking down on the dance.
_OVERVIEW_DIRECTION = np.array((0.62, -0.76, 0.30))
_OVERVIEW_FOVY_DEG = 32.0
# Over the shoulder of the performer, which faces the observers, from its hover.
_SHOULDER_M = np.array((0.0, 0.75, 0.28))
_AUDIENCE_M = np.array((0.0, -1.3, -0.08))
_PERFORMER_FOVY_DEG = (45.0, 90.0)  # Narrowest and widest.


class SharedViews:
  """Three cameras that stand in the room.

  `top` looks straight down and has no perspective. `overview` looks at all
  vehicles from the side. `performer_view` looks at the observers over the
  performer's shoulder, as far to the sides as 50 degrees.
  """

  def __init__(self, room: mjcf.RootElement, height_m: float) -> None:
    """Adds the cameras to an empty room.

    Args:
      room: The room's model.
      height_m: Where vehicles hover.
    """
    self._height_m = height_m
    add = functools.partial(room.worldbody.add, resolution=SIZE_PX)
    self._top = add(
      'camera',
      name='top',
      projection='orthographic',
      xyaxes=(1, 0, 0, 0, 1, 0),
    )
    self._overview = add('camera', name='overview', fovy=_OVERVIEW_FOVY_DEG)
    self._performer = add('camera', name='performer_view')
    hover_m = np.array((0.0, 0.0, height_m))
    _aim(self._performer, hover_m + _SHOULDER_M, hover_m + _AUDIENCE_M)
    self.show([(0.0, 0.0, 0.0)])

  def show(self, positions_m: Sequence[tuple[float, float, float]]) -> None:
    """Sets the cameras so that they show vehicles at, or above, positions.

    Args:
      positions_m: World x, y and z of each vehicle; at least one.
    """
    spots_m = np.array(positions_m)[:, :2]  # (N, 2)
    top_m = self._height_m + _DANCE_M
    low_m = np.append(spots_m.min(axis=0) - _MARGIN_M, 0.0)
    high_m = np.append(spots_m.max(axis=0) + _MARGIN_M, top_m)
    middle_m, size_m = (low_m + high_m) / 2, high_m - low_m
    self._top.pos = (*middle_m[:2], _TOP_HEIGHT_M)
    # An orthographic camera's `fovy` is the height of its picture in metres.
    self._top.fovy = max(size_m[1], size_m[0] / _ASPECT)
    _aim(self._overview, middle_m + _standoff(size_m), middle_m)
    x_m, y_m = spots_m.T
    ahead_m = np.maximum(_SHOULDER_M[1] - y_m, _MARGIN_M)
    tangent = np.max((np.abs(x_m) + _MARGIN_M) / ahead_m) / _ASPECT
    fovy_deg = math.degrees(2 * math.atan(tangent))
    self._performer.fovy = np.clip(fovy_deg, *_PERFORMER_FOVY_DEG)


def _axes(back: np.ndarray) -> np.ndarray:  # (3, 3)
  """A level camera's x, y and z axes, as rows; it looks along -z."""
  right = np.cross((0.0, 0.0, 1.0), back)
  axes = np.stack([right, np.cross(back, right), back])
  return axes / np.linalg.norm(axes, axis=1, keepdims=True)


def _aim(
  camera: mjcf.Element, position_m: np.ndarray, target_m: np.ndarray
) -> None:
  camera.pos = position_m
  camera.xyaxes = _axes(position_m - target_m)[:2].ravel()


def _standoff(size_m: np.ndarray) -> np.ndarray:  # (3,)
  """Where the overview stands, from the middle of a box that it shows whole."""
  axes = _axes(_OVERVIEW_DIRECTION)
  signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T
  x, y, z = axes @ (signs * size_m / 2).T  # (8,) each: the box's corners.
  tangent = math.tan(math.radians(_OVERVIEW_FOVY_DEG) / 2)
  reach_m = np.maximum(np.abs(y), np.abs(x) / _ASPECT) / tangent
  return np.max(z + reach_m) * axes[2]
