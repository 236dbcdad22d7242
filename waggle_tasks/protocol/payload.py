"""The bits of a payload and the displacement that they command."""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks

_MOST_BITS = 12  # Of a field.
MEANINGS = ('displacement', 'place')


class PayloadError(errors.WaggleError):
  """A payload of another number of bits, or a field out of its range."""


@dataclasses.dataclass(frozen=True)
class Units:
  """How many bits the fields of a payload have, and what one count means.

  The direction is one bit.

  Attributes:
    heading_step_rad: Angle of one heading count, alpha of equation 1; 45
      degrees in the paper.
    distance_unit_m: Length of one distance count, u of equation 2; 0.2 m in the
      paper.
    heading_bits: Bits of the payload's heading, 1 to 12; 3 in the paper.
    distance_bits: Bits of the payload's distance, 1 to 12; 2 in the paper.
    meaning: What a payload names, one of `MEANINGS`: how far each reader flies
      from where it is, as in the paper, or a place that is the same for all,
      counted from the performer's, around which each has a slot.
    slot_m: Radius of the ring of slots about such a place, 0.1 to 4 m.
  """

  heading_step_rad: float = math.pi / 4
  distance_unit_m: float = 0.2
  heading_bits: int = 3
  distance_bits: int = 2
  meaning: str = 'displacement'
  slot_m: float = 0.5

  def __post_init__(self) -> None:
    checks.choice('meaning', self.meaning, MEANINGS, PayloadError)
    limits = {
      'heading_step_rad': (1e-3, math.pi),
      'distance_unit_m': (1e-3, 1.0),
      'heading_bits': (1, _MOST_BITS),
      'distance_bits': (1, _MOST_BITS),
      'slot_m': (0.1, 4.0),
    }
    checks.settle_numbers(self, limits, PayloadError)

  @property
  def num_bits(self) -> int:
    """How many bits a payload has."""
    return 1 + self.heading_bits + self.distance_bits

  @property
  def reach_m(self) -> float:
    """The longest displacement that a payload can command."""
    return (2**self.distance_bits - 1) * self.distance_unit_m


@dataclasses.dataclass(frozen=True)
class Payload:
  """One message: of 64 in the paper (section 'Motion alphabet').

  Attributes:
    direction: d, 0 forward or 1 backward.
    heading: h, 0 to 7 in the paper, counterclockwise from world +Y.
    distance: r, 0 to 3 distance units in the paper.
    heading_bits: Bits of the heading.
    distance_bits: Bits of the distance.
  """

  direction: int
  heading: int
  distance: int
  heading_bits: int = 3
  distance_bits: int = 2

  def __post_init__(self) -> None:
    widths = {'heading_bits': (1, _MOST_BITS), 'distance_bits': (1, _MOST_BITS)}
    checks.settle_numbers(self, widths, PayloadError)
    limits = {
      'direction': (0, 1),
      'heading': (0, 2**self.heading_bits - 1),
      'distance': (0, 2**self.distance_bits - 1),
    }
    checks.settle_numbers(self, limits, PayloadError)

  @classmethod
  def from_bits(cls, bits: str, units: Units = Units()) -> 'Payload':
    """Reads a payload such as '000010'.

    Args:
      bits: Of the direction, the heading and the distance.
      units: How many bits each has.

    Raises:
      PayloadError: if `bits` is not so many characters of 0 and 1.
    """
    if not checks.is_bits(bits) or len(bits) != units.num_bits:
      example = f'{2:0{units.num_bits}b}'
      raise PayloadError(
        f'`payload` must be {units.num_bits} characters of 0 and 1, such as'
        f' {example!r}: got {bits!r}'
      )
    split = 1 + units.heading_bits
    return cls(
      int(bits[0]), int(bits[1:split], 2), int(bits[split:], 2),
      units.heading_bits, units.distance_bits,
    )  # fmt: skip

  @classmethod
  def from_int(cls, value: int, units: Units = Units()) -> 'Payload':
    """Reads a payload from an integer, 0 to 63 in the paper.

    Its first bit is the highest.

    Raises:
      PayloadError: if `value` is not an integer of so many bits.
    """
    most = 2**units.num_bits - 1
    value = checks.integer('payload', value, 0, most, PayloadError)
    return cls.from_bits(f'{value:0{units.num_bits}b}', units)

  @property
  def bits(self) -> str:
    """The bits as text, in the order in which they are flown."""
    heading = f'{self.heading:0{self.heading_bits}b}'
    return f'{self.direction}{heading}{self.distance:0{self.distance_bits}b}'

  @property
  def text(self) -> str:
    """The same for files, with marks between fields of unusual widths."""
    usual = Units()
    widths = self.heading_bits, self.distance_bits
    if widths == (usual.heading_bits, usual.distance_bits):
      return self.bits
    split = 1 + self.heading_bits
    return f'{self.direction}|{self.bits[1:split]}|{self.bits[split:]}'

  @classmethod
  def from_text(cls, text: str) -> 'Payload':
    """Reads `text`.

    Raises:
      PayloadError: if it is none.
    """
    if not isinstance(text, str) or text.count('|') != 2:
      return cls.from_bits(text)
    _, heading, distance = text.split('|')
    units = Units(heading_bits=len(heading), distance_bits=len(distance))
    return cls.from_bits(text.replace('|', ''), units)

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


@dataclasses.dataclass(frozen=True)
class Data:
  """A message of any bits, which commands nothing.

  Attributes:
    bits: Characters of 0 and 1, one at least.
  """

  bits: str

  def __post_init__(self) -> None:
    bits = self.bits
    if not isinstance(bits, str) or not bits or set(bits) - {*'01'}:
      raise PayloadError(
        f'`bits` must be characters of 0 and 1, one at least: got {bits!r}'
      )
