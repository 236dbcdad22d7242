"""The air below a vehicle that hovers: one turbulent jet.

L. Bauersfeld and others, 'Robotics meets fluid dynamics: a characterization of
the induced airflow below a quadrotor as a turbulent jet' (arXiv 2403.13321):
from 2.5 drone sizes down, the mean flow below quadrotors of any size is one jet
that follows from mass, propeller and size. The size is the distance of opposite
motors: with it, and with these numbers, the jet carries the vehicle's weight.
"""

import math

import numpy as np

from waggle_tasks.entities import crazyflie
from waggle_tasks.protocol import limits

AIR_KG_M3 = 1.225
SIZE_M = 2 * crazyflie.ARM_M
# What propellers suck in at hover, by momentum theory.
INDUCED_MPS = math.sqrt(
  crazyflie.MASS_KG * limits.GRAVITY_MPS2
  / (2 * AIR_KG_M3 * 4 * math.pi * crazyflie.ROTOR_RADIUS_M**2)
)  # fmt: skip
# Speed on the axis, in those of the propellers, times distance in sizes; where
# the jet would come from, in sizes above the vehicle; and how its half-width
# grows with distance.
_DECAY, _ORIGIN, _SPREAD = 10.11, 5.817, 0.07668
_NEAR = 2.5  # Where it begins to be a jet, in sizes.


def speed_mps(down_m: np.ndarray, aside_m: np.ndarray) -> np.ndarray:
  """Speed of the air, downwards, below a vehicle.

  Args:
    down_m: How far below it.
    aside_m: How far beside its axis; of the same shape.

  Returns:
    Of that shape. Nearer than 2.5 sizes the jet is taken to be as wide as
    there, and to grow from nothing; above the vehicle there is none.
  """
  sizes = np.maximum(down_m / SIZE_M, _NEAR) + _ORIGIN
  across = aside_m / (_SPREAD * SIZE_M * sizes)
  profile = (1 + (math.sqrt(2) - 1) * across**2) ** -2
  grown = np.clip(down_m / (_NEAR * SIZE_M), 0, 1)
  return grown * INDUCED_MPS * _DECAY / sizes * profile


def downwash_mps(positions_m: np.ndarray) -> np.ndarray:
  """(N,) how fast the air sinks at each of N vehicles, (N, 3), by the others.

  Jets of several vehicles above one another add up.
  """
  apart = positions_m[:, None] - positions_m  # Of each from the others.
  return speed_mps(
    apart[..., 2] * -1, np.hypot(apart[..., 0], apart[..., 1])
  ).sum(axis=1)
