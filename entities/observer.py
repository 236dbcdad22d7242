"""An observer: a vehicle with an eye; it can dance as all can."""

from collections.abc import Callable, Sequence

from dm_control import composer, mjcf
from dm_control.composer.observation import observable
import numpy as np

from waggle_tasks import eyes
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.entities import (
  crazyflie,
  eye,
  feed,
  lenses,
  optics,
  performer,
  shutter,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib


class Observer(performer.Performer):
  """A vehicle whose camera looks where its nose points.

  Attributes:
    sensor: What spoils its images, from the next episode on.
    error_m: (3,) how far from itself it takes itself to be.
  """

  def _build(  # type: ignore[override]
    self,
    name: str = 'observer',
    camera: str = 'incremental',
    eye_offset_m: float = optics.OFFSET_M,
    sensor: sensor_lib.Sensor = sensor_lib.Sensor(),
    agreement: agreement_lib.Agreement = agreement_lib.Agreement(),
    dynamics: str = 'ideal',
    looks_with: eyes.Eye = eyes.Eye(),
    accent_rgba: Sequence[float] = crazyflie.AZURE,
  ) -> None:
    """Builds the model.

    Args:
      name: Model name, the prefix of everything inside it.
      camera: One of `optics.CAMERAS`: how its images are rendered.
      eye_offset_m: How far the eye is ahead of the centre of mass.
      sensor: What spoils its images.
      agreement: What both sides know: its camera and its rate.
      dynamics: One of `limits.DYNAMICS`.
      looks_with: What its camera is, beyond that of the agreement.
      accent_rgba: See `crazyflie.Crazyflie`.
    """
    super()._build(name, dynamics, accent_rgba)
    self._incremental = camera == 'incremental'
    seen_with = agreement.camera
    drawn = lenses.drawn(seen_with, looks_with)
    self._eye = self.airframe.add(
      'camera', name='eye', pos=(eye_offset_m, 0, 0),
      xyaxes=_axes(seen_with), fovy=drawn.fovy_deg, resolution=drawn.size,
    )  # fmt: skip
    self._agreement, self._looks_with = agreement, looks_with
    self._shutter: shutter.Shutter | None = None
    if looks_with.takes_s:
      rows = lenses.rows_of(seen_with, looks_with)
      self._shutter = shutter.Shutter(looks_with, seen_with, rows)
    self.sensor = sensor
    self._feed: feed.Feed | None = None
    self.error_m = np.zeros(3)

  def _build_observables(self) -> 'ObserverObservables':
    return ObserverObservables(self)

  @property
  def lens(self) -> camera_lib.Camera:
    """What its camera is, in numbers."""
    return self._agreement.camera

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
    """Begins this episode's feed, if anything is to be spoilt.

    Raises:
      EyeError: if its pictures cannot be coded here.
    """
    self._feed = None
    if not (self.sensor.is_clean and self._looks_with.is_ideal):
      self._feed = feed.Feed(
        self.sensor, random_state, self._agreement, self._looks_with
      )
      self._feed.advance(float(_time_s(physics)))
    if self._shutter is not None:
      self._shutter.begin(physics)

  def after_substep(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Notes where everything is, for what is exposed meanwhile."""
    del random_state
    if self._shutter is not None:
      self._shutter.note(physics)

  def after_step(
    self, physics: mjcf.Physics, random_state: np.random.RandomState
  ) -> None:
    """Brings the feed to the frame that is observed next."""
    del random_state
    if self._feed is not None:
      self._feed.advance(float(_time_s(physics)))

  @property
  def is_spoilt(self) -> bool:
    """Whether something spoils its images in this episode."""
    return self._feed is not None

  def spoil(self, picture: np.ndarray) -> np.ndarray:
    """What comes of the eye's picture now, (H, W, 3) uint8 each."""
    return picture if self._feed is None else self._feed.image(picture)

  def expose(self, physics: mjcf.Physics, draw: shutter.Draw) -> np.ndarray:
    """The picture that the eye takes now, (H, W, 3) uint8."""
    if self._shutter is None:
      return draw().picture
    return self._shutter.expose(physics, draw)

  def image_time_s(self, physics: mjcf.Physics) -> np.ndarray:
    """The time, (), that the image that comes now is told to be of."""
    if self._feed is None:
      return _time_s(physics)
    return np.asarray(self._feed.time_s)


def _axes(seen_with: camera_lib.Camera) -> tuple[float, ...]:
  """Right and up of a camera in the axes of its vehicle: ahead, left, up."""
  right, down = seen_with.mount[:, 0], seen_with.mount[:, 1]
  axes = [
    number + 0.0  # No negative zeros.
    for (x, y, z), sign in ((right, 1), (down, -1))
    for number in (sign * z, -sign * x, -sign * y)
  ]
  return tuple(map(float, axes))


def _time_s(physics: mjcf.Physics) -> np.ndarray:
  # Rounded, as summing physics steps leaves errors far under 1 us.
  return np.round(physics.time(), 6)


class _Estimate(observable.MJCFFeature):
  """The place of an observer and its error."""

  def __init__(self, entity: Observer) -> None:
    super().__init__('xpos', entity.centre)
    self._entity = entity

  def _callable(self, physics: mjcf.Physics) -> Callable[[], np.ndarray]:
    take = super()._callable(physics)
    return lambda: take() + self._entity.error_m


class ObserverObservables(crazyflie.CrazyflieObservables):
  """What an observer's agent may see, beside the vehicle's true state."""

  @composer.observable
  def camera(self) -> eye.EyeCamera:
    """Image of the eye: (H, W, 3) uint8 RGB."""
    entity = self._entity
    return eye.EyeCamera(
      entity.eye, entity.incremental, entity.spoil, entity.expose,
      entity.lens.size,
    )  # fmt: skip

  @composer.observable
  def position_m(self) -> observable.MJCFFeature:
    """Where it takes itself to be: (3,) float64, metres."""
    return _Estimate(self._entity)

  @composer.observable
  def time_s(self) -> observable.Generic:
    """Simulation time of the image: () float64, seconds."""
    return observable.Generic(self._entity.image_time_s)
