"""An observer: a Crazyflie with an eye, which is all that it has."""

from dm_control import composer, mjcf
from dm_control.composer.observation import observable
import numpy as np

from waggle_tasks import sensor as sensor_lib
from waggle_tasks.entities import crazyflie, eye, feed

CAMERAS = ('incremental', 'full')


class Observer(crazyflie.Crazyflie):
  """A Crazyflie whose camera looks where its nose points.

  Attributes:
    sensor: What spoils its images, from the next episode on.
  """

  def _build(
    self,
    name: str = 'observer',
    camera: str = 'incremental',
    eye_offset_m: float = eye.OFFSET_M,
    sensor: sensor_lib.Sensor = sensor_lib.Sensor(),
  ) -> None:
    """Builds the model.

    Args:
      name: Model name, the prefix of everything inside it.
      camera: One of `CAMERAS`: how its images are rendered.
      eye_offset_m: How far the eye is ahead of the centre of mass.
      sensor: What spoils its images.
    """
    super()._build(name, crazyflie.AZURE)
    self._incremental = camera == 'incremental'
    self._eye = self.airframe.add(
      'camera', name='eye', pos=(eye_offset_m, 0, 0),
      xyaxes=(0, -1, 0, 0, 0, 1), fovy=eye.FOVY_DEG,
    )  # fmt: skip
    self.sensor = sensor
    self._feed: feed.Feed | None = None

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
    """Begins this episode's feed, if anything is to be spoilt."""
    camera, time_s = self.observables.camera, self.observables.time_s
    self._feed = camera.corruptor = time_s.corruptor = None
    if not self.sensor.is_clean:
      self._feed = feed.Feed(self.sensor, random_state)
      camera.corruptor, time_s.corruptor = self._feed.image, self._feed.time_s
      self._feed.advance(_time_s(physics))

  def after_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Brings the feed to the frame that is observed next."""
    del random_state
    if self._feed is not None:
      self._feed.advance(_time_s(physics))


def _time_s(physics: mjcf.Physics) -> np.ndarray:
  # Rounded, as summing physics steps leaves errors far under 1 us.
  return np.round(physics.time(), 6)


class ObserverObservables(crazyflie.CrazyflieObservables):
  """What an observer's agent may see, beside the vehicle's true state."""

  @composer.observable
  def camera(self) -> eye.EyeCamera:
    """Image of the eye: (480, 640, 3) uint8 RGB."""
    return eye.EyeCamera(self._entity.eye, self._entity.incremental)

  @composer.observable
  def time_s(self) -> observable.Generic:
    """Simulation time of the image: () float64, seconds."""
    return observable.Generic(_time_s)
