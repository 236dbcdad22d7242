"""A Crazyflie 2: the airframe that performers and observers share.

Body frame: x forward, y left, z up, origin at the centre of mass. Mass, inertia
and arm length are those of MuJoCo Menagerie's `bitcraze_crazyflie_2`, the
model the paper names as its source (section "Scene, sensors, and information
boundaries"); the shape is drawn in `airframe`.
"""

from collections.abc import Sequence

from dm_control import composer, mjcf
from dm_control.composer.observation import observable
import numpy as np

from waggle_tasks.entities import airframe

# Menagerie, bitcraze_crazyflie_2/cf2.xml, <inertial>.
MASS_KG = 0.027
INERTIA_KG_M2 = (23.951e-6, 23.951e-6, 32.347e-6)

ARM_M = airframe.ARM_M
ROTOR_RADIUS_M = airframe.ROTOR_RADIUS_M
DIAMETER_M = 2.0 * (ARM_M + ROTOR_RADIUS_M)  # Rotor tip to rotor tip.

AMBER = (0.95, 0.62, 0.10, 1.0)
AZURE = (0.16, 0.60, 0.95, 1.0)


class Crazyflie(composer.Entity):
  """A rigid vehicle with its centre of mass at the origin of its model.

  Attach it with `FlightRoom.add_vehicle`, or with any arena's
  `add_free_entity`; it has no actuators of its own.
  """

  def _build(
    self,
    name: str = 'crazyflie',
    accent_rgba: Sequence[float] = AMBER,
    spinning: bool = False,
  ) -> None:
    """Builds the model.

    Args:
      name: Model name, the prefix of everything inside it.
      accent_rgba: Colour of the front rotors and the battery's label, 4 values
        in [0, 1]; tells vehicles apart.
      spinning: Whether it is drawn with propellers that turn.
    """
    self._mjcf_root = mjcf.RootElement(model=name)
    self._airframe = self._mjcf_root.worldbody.add('body', name='airframe')
    self._airframe.add(
      'inertial', pos=(0, 0, 0), mass=MASS_KG, diaginertia=INERTIA_KG_M2
    )
    self._centre = self._airframe.add(
      'site', name='centre', pos=(0, 0, 0), size=(0.001,), group=3
    )
    self._spinning = spinning
    airframe.draw(self._airframe, accent_rgba, spinning)
    airframe.enclose(self._airframe)
    self._velocity = self._mjcf_root.sensor.add(
      'framelinvel', name='velocity', objtype='site', objname=self._centre
    )

  def _build_observables(self) -> 'CrazyflieObservables':
    return CrazyflieObservables(self)

  @property
  def mjcf_model(self) -> mjcf.RootElement:
    """The model; `name` is its prefix in a room."""
    return self._mjcf_root

  @property
  def airframe(self) -> mjcf.Element:
    """The rigid body that carries all of the mass."""
    return self._airframe

  @property
  def centre(self) -> mjcf.Element:
    """The site at the centre of mass, in the body frame."""
    return self._centre

  @property
  def spinning(self) -> bool:
    """Whether its propellers turn, as those that carry it do."""
    return self._spinning

  @property
  def velocity_sensor(self) -> mjcf.Element:
    """World-frame linear velocity of `centre` in m/s, shape (3,)."""
    return self._velocity


class CrazyflieObservables(composer.Observables):
  """True state of the vehicle in the world frame; all off by default."""

  @composer.observable
  def position_m(self) -> observable.MJCFFeature:
    """Position of the centre of mass: (3,) float64, metres."""
    return observable.MJCFFeature('xpos', self._entity.centre)

  @composer.observable
  def velocity_mps(self) -> observable.MJCFFeature:
    """Velocity of the centre of mass: (3,) float64, metres per second."""
    return observable.MJCFFeature('sensordata', self._entity.velocity_sensor)

  @composer.observable
  def orientation(self) -> observable.Generic:
    """Rotation matrix from body to world axes: (3, 3) float64, no unit."""
    centre = self._entity.centre

    def rotation(physics: mjcf.Physics) -> np.ndarray:  # (3, 3)
      return np.reshape(physics.bind(centre).xmat, (3, 3))

    return observable.Generic(rotation)
