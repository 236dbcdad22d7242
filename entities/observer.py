"""An observer: a Crazyflie with an eye, which is all that it has."""

from collections.abc import Callable

from dm_control import composer, mjcf
from dm_control.composer.observation import observable
import numpy as np

from waggle_tasks.entities import crazyflie, eye

CAMERAS = ('incremental', 'full')


class Observer(crazyflie.Crazyflie):
  """A Crazyflie whose camera looks where its nose points.

  `corruptor` is the seam for spoiling its images: a function without
  arguments that makes a new `eye.Corruptor` for each episode, or None.
  """

  def _build(
    self,
    name: str = 'observer',
    camera: str = 'incremental',
    eye_offset_m: float = eye.OFFSET_M,
  ) -> None:
    """Builds the model.

    Args:
      name: Model name, the prefix of everything inside it.
      camera: One of `CAMERAS`: how its images are rendered.
      eye_offset_m: How far the eye is ahead of the centre of mass.
    """
    super()._build(name, crazyflie.AZURE)
    self._incremental = camera == 'incremental'
    self._eye = self.airframe.add(
      'camera', name='eye', pos=(eye_offset_m, 0, 0),
      xyaxes=(0, -1, 0, 0, 0, 1), fovy=eye.FOVY_DEG,
    )  # fmt: skip
    self.corruptor: Callable[[], eye.Corruptor] | None = None

  def _build_observables(self) -> 'ObserverObservables':
    return ObserverObservables(self)

  @property
  def eye(self) -> mjcf.Element:
    """The camera."""
    return self._eye

  @property
  def incremental(self) -> bool:
    """Whether its images are redrawn only where something changed."""
    return self._incremental

  def initialize_episode(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Gives the camera this episode's corruptor."""
    del physics, random_state
    make = self.corruptor
    self.observables.camera.corruptor = make() if make else None


class ObserverObservables(crazyflie.CrazyflieObservables):
  """What an observer's agent may see, beside the vehicle's true state."""

  @composer.observable
  def camera(self) -> eye.EyeCamera:
    """Image of the eye: (480, 640, 3) uint8 RGB."""
    return eye.EyeCamera(self._entity.eye, self._entity.incremental)

  @composer.observable
  def time_s(self) -> observable.Generic:
    """Simulation time of the image: () float64, seconds."""
    # Rounded, as summing physics steps leaves errors far under 1 us.
    return observable.Generic(lambda physics: np.round(physics.time(), 6))
