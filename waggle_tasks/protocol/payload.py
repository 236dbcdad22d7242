"""The six payload bits d|hhh|rr and the displacement that they command."""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks

NUM_BITS = 6


class PayloadError(errors.WaggleError):
  """A payload that is not six bits, or a field out of its range."""


@dataclasses.dataclass(frozen=True)
class Units:
  """What one count of the heading and the distance field means.

  Attributes:
    heading_step_rad: Angle of one heading count, alpha of equation 1; 45
      degrees in the paper.
    distance_unit_m: Length of one distance count, u of equation 2; 0.2 m in the
      paper.
  """

  heading_step_rad: float = math.pi / 4
  distance_unit_m: float = 0.2

  def __post_init__(self) -> None:
    limits = {
      'heading_step_rad': (1e-3, math.pi),
      'distance_unit_m': (1e-3, 1.0),
    }
    checks.settle_numbers(self, limits, PayloadError)


@dataclasses.dataclass(frozen=True)
class Payload:
  """One of the 64 messages (paper, section 'Motion alphabet').

  Attributes:
    direction: d, 0 forward or 1 backward.
    heading: h, 0 to 7, counted counterclockwise from world +Y.
    distance: r, 0 to 3 distance units.
  """

  direction: int
  heading: int
  distance: int

  def __post_init__(self) -> None:
    limits = {'direction': (0, 1), 'heading': (0, 7), 'distance': (0, 3)}
    checks.settle_numbers(self, limits, PayloadError)

  @classmethod
  def from_bits(cls, bits: str) -> 'Payload':
    """Reads a payload such as '000010'.

    Raises:
      PayloadError: if `bits` is not six characters of 0 and 1.
    """
    is_bits = isinstance(bits, str) and not set(bits) - {*'01'}
    if not is_bits or len(bits) != NUM_BITS:
      raise PayloadError(
        f'`payload` must be {NUM_BITS} characters of 0 and 1, such as'
        f" '000010': got {bits!r}"
      )
    return cls(int(bits[0]), int(bits[1:4], 2), int(bits[4:], 2))

  @classmethod
  def from_int(cls, value: int) -> 'Payload':
    """Reads a payload from an integer 0 to 63, its first bit the highest.

    Raises:
      PayloadError: if `value` is not an integer from 0 to 63.
    """
    value = checks.integer('payload', value, 0, 2**NUM_BITS - 1, PayloadError)
    return cls(value >> 5, value >> 2 & 0b111, value & 0b11)

  @property
  def bits(self) -> str:
    """The six bits as text, in the order in which they are flown."""
    return f'{self.direction:01b}{self.heading:03b}{self.distance:02b}'

  def __int__(self) -> int:
    return int(self.bits, 2)

  def displacement_m(self, units: Units = Units()) -> np.ndarray:
    """The commanded displacement in world axes, equations 1 and 2.

    Args:
      units: The agreed heading step and distance unit.

    Returns:
      (3,) metres; z is zero.
    """
    theta_rad = math.pi / 2 + self.heading * units.heading_step_rad
    reach_m = (-1) ** self.direction * self.distance * units.distance_unit_m
    return reach_m * np.array([math.cos(theta_rad), math.sin(theta_rad), 0.0])
