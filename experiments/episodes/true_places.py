"""Where the performer truly was in each observer's picture."""

from collections.abc import Sequence

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import observer
from waggle_tasks.protocol import camera


class TruePlaces:
  """Notes the performer's place in every picture of an episode."""

  def __init__(
    self, physics: mjcf.Physics, observers: Sequence[observer.Observer]
  ) -> None:
    """Finds the observers' eyes in a compiled model."""
    self._eyes = {
      each.mjcf_model.model: (physics.bind(each.eye).element_id, each.lens)
      for each in observers
    }
    self._places_px: dict[str, list[np.ndarray]] = {x: [] for x in self._eyes}

  def note(self, physics: mjcf.Physics, performer_m: np.ndarray) -> None:
    """Takes a frame, with the performer's true position, (3,)."""
    for name, (eye, lens) in self._eyes.items():
      place_px = _project(physics, eye, lens, performer_m)
      self._places_px[name].append(place_px)

  def places_px(self) -> dict[str, np.ndarray]:
    """By observer name, (T, 2) x right and y down; NaN behind its camera."""
    return {name: np.array(each) for name, each in self._places_px.items()}


def _project(
  physics: mjcf.Physics, eye: int, lens: camera.Camera, place_m: np.ndarray
) -> np.ndarray:  # (2,)
  data = physics.data
  to_eye = data.cam_xmat[eye].reshape(3, 3)
  x_m, y_m, z_m = (place_m - data.cam_xpos[eye]) @ to_eye
  if z_m >= 0:  # A camera looks along its -z axis.
    return np.full(2, np.nan)
  if lens.lens.bends:
    place = lens.lens.shown(np.array([-x_m / z_m, y_m / z_m]))
    return place * lens.focal_px + np.array(lens.size) / 2
  return np.array(
    [
      lens.columns / 2 - lens.focal_px * x_m / z_m,
      lens.rows / 2 + lens.focal_px * y_m / z_m,
    ]
  )
