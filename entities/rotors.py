"""Four rotors that carry a vehicle, and the air that holds it back.

Each rotor is a MuJoCo actuator on its own site: thrust along the body's z axis,
with the torque that its propeller leaves behind, behind a first-order lag that
MuJoCo integrates exactly (`dyntype=filterexact`,
https://mujoco.readthedocs.io/en/stable/XMLreference.html#actuator-general).
Drag is linear in the velocity relative to the air, along each body axis: an
actuator of it pulls towards the velocity of the air, which is its control.
"""

import dataclasses
import math

from dm_control import mjcf
import numpy as np

from waggle_tasks.entities import airframe, crazyflie
from waggle_tasks.protocol import limits

# J. Foerster, System identification of the Crazyflie 2.0 nano quadrocopter,
# ETH Zurich 2015: thrust follows its command as 1 / (1 - 0.9695404 / z) at
# 500 Hz, and torque is so many metres times thrust.
LAG_S = -0.002 / math.log(0.9695404)  # 0.065 s.
TORQUE_M = 0.005964552
# Along the body's axes, identified; sideways it is the rotors' own drag.
DRAG_NS_M = np.array([0.0147, 0.0147, 0.0128])

# Front left, rear left, rear right, front right; the first turns clockwise as
# seen from above, and its torque on the body is counterclockwise.
_X_M, _Y_M = (
  airframe.ARM_M * turn(airframe.MOTORS_RAD) for turn in (np.cos, np.sin)
)
_SENSES = np.array([1.0, -1.0, 1.0, -1.0])
# Thrusts of the four rotors, (4,), to thrust and torque about x, y and z, (4,).
EFFECT = np.stack([np.ones(4), _Y_M, -_X_M, TORQUE_M * _SENSES])  # (4, 4)


@dataclasses.dataclass(frozen=True)
class Rotors:
  """A vehicle's actuators.

  Attributes:
    thrusts: Those of the rotors; their controls are thrusts in N.
    drags: Those of the drag along x, y and z; their controls are velocities of
      the air along the body's axes in m/s.
  """

  thrusts: tuple[mjcf.Element, ...]
  drags: tuple[mjcf.Element, ...]


def mount(vehicle: crazyflie.Crazyflie) -> Rotors:
  """Gives a vehicle its rotors and its drag."""
  root, thrusts = vehicle.mjcf_model, []
  for number, sense in enumerate(_SENSES):
    site = vehicle.airframe.add(
      'site',
      name=f'rotor_{number + 1}',
      pos=(_X_M[number], _Y_M[number], airframe.TOP_M),
      size=(0.001,),
      group=3,
    )
    thrusts.append(
      root.actuator.add(
        'general',
        name=site.name,
        site=site,
        gear=(0, 0, 1, 0, 0, sense * TORQUE_M),
        dyntype='filterexact',
        dynprm=[LAG_S],
        gainprm=[1.0],
        ctrllimited=True,
        ctrlrange=limits.THRUST_N,
      )
    )
  drags = [
    root.actuator.add(
      'general',
      name=f'drag_{"xyz"[axis]}',
      site=vehicle.centre,
      gear=np.eye(6)[axis],
      gainprm=[drag],
      biastype='affine',
      biasprm=[0, 0, -drag],
    )
    for axis, drag in enumerate(DRAG_NS_M)
  ]
  return Rotors(tuple(thrusts), tuple(drags))
