"""Looks at a running episode and tells what a picture of it shows."""

from collections.abc import Sequence
import math

from dm_control import mjcf
import mujoco
import numpy as np

from waggle_tasks import scenario
from waggle_tasks.entities import renderer
from waggle_tasks.experiments.record import episode, moves
from waggle_tasks.experiments.video import layout, moment


class Lens:
  """Follows an episode frame by frame; moments are taken of the latest one.

  Attributes:
    frame: Number of the latest frame, from 0; -1 before the first.
  """

  def __init__(
    self, scene: scenario.Scenario, shared: Sequence[str] = (*layout.SHARED,)
  ) -> None:
    """Makes a lens for an episode that has not begun.

    Args:
      scene: What will be flown.
      shared: Which of `layout.SHARED` moments have images of.
    """
    self._sent = moves.sent(scene.performance, scene.agreement, scene.episode_s)
    self._agreement = scene.agreement
    self._frame_s = scene.agreement.frame_s
    self._shared = {name: layout.SHARED[name] for name in shared}
    self._shadows = scene.appearance.shadows
    self._watches: dict[str, moment.Watch] = {}
    self.frame = -1

  def note(self, step: episode.Step) -> None:
    """Takes what happened in a frame."""
    task = step.environment.task
    self._environment = step.environment
    self._observations = step.timestep.observation
    if step.timestep.first():
      names = [each.mjcf_model.model for each in task.observers]
      self._watches = {
        name: moment.Watch(name, agent, self._agreement)
        for name, agent in zip(names, step.team.agents, strict=True)
      }
      self._renderer = renderer.Renderer(step.environment.physics)
    for watch in self._watches.values():
      watch.note(task.refusals)
    self.frame += 1

  def shared(self) -> dict[str, np.ndarray]:
    """New images of the shared views by name, (H, W, 3) uint8 RGB each."""
    return {name: self._look(each) for name, each in self._shared.items()}

  def moment(
    self, names: Sequence[str], shared: dict[str, np.ndarray]
  ) -> moment.Instant:
    """The moment of the latest frame.

    Args:
      names: The observers it shows.
      shared: What `shared` returned in this frame.
    """
    time_s = self.frame * self._frame_s
    images = {
      name: observation['camera']
      for name, observation in zip(
        self._watches, self._observations, strict=True
      )
    }
    sights = tuple(self._watches[name].sight(images[name]) for name in names)
    sent = moves.sent_at(self._sent, time_s)
    places = {name: self._places(self._shared[name]) for name in shared}
    return moment.Instant(time_s, sent, sights, shared, places)

  def _places(self, camera: str) -> dict[str, tuple[float, float]]:
    """Columns and rows of the vehicles that stand before a camera."""
    physics, out = self._environment.physics, {}
    width, height = layout.VIEW_PX
    camera_m = physics.named.data.cam_xpos[camera]
    axes = physics.named.data.cam_xmat[camera].reshape(3, 3)
    number = physics.model.name2id(camera, 'camera')
    fovy, flat = physics.model.cam_fovy[number], _is_flat(physics, number)
    for name, place_m in self._environment.task.positions_m(physics).items():
      x, y, z = (place_m - camera_m) @ axes
      if z >= 0.0:
        continue
      # Metres that the picture is high, where the vehicle is.
      high_m = fovy if flat else -2 * z * math.tan(math.radians(fovy) / 2)
      zoom = height / high_m
      out[name] = float(width / 2 + zoom * x), float(height / 2 - zoom * y)
    return out

  def _look(self, camera: str) -> np.ndarray:
    physics = self._environment.physics
    if self._shadows:  # The fast renderer draws none.
      width, height = layout.VIEW_PX
      return physics.render(height, width, camera)
    return self._renderer.image(physics.model.name2id(camera, 'camera')).copy()


def _is_flat(physics: mjcf.Physics, camera: int) -> bool:
  """Whether a camera has no perspective."""
  kind = physics.model.cam_projection[camera]
  return kind == mujoco.mjtProjection.mjPROJ_ORTHOGRAPHIC
