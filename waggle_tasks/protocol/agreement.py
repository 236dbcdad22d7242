"""What both sides of the link know before a message, as one value."""

import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import (
  alphabets,
  checks,
  coding,
  gestures,
  languages,
  payload,
  schedule,
  timing,
)
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import clock as clock_lib
from waggle_tasks.protocol import packets as packets_lib

# Vehicles are flown, and physics is stepped, at this rate. A frame is a whole
# number of such steps: two of them at least, and few enough to fly well.
STEPS_HZ = 250
_STEPS = (2, 25)
# How a rate may be rounded.
_SAME = 1e-6
# Between these everything that flies has room, but for tall gestures.
_HEIGHT_M = (0.5, 5.5)
_PACKET_CHECK = 'crc8'
# The paper's final null (section 'Visual null confirmation').
_NULL_S = 3.0
# Of the lowest point of a gesture from the floor.
_CLEAR_M = 0.1


class AgreementError(errors.WaggleError):
  """An agreement that nobody can keep."""


@dataclasses.dataclass(frozen=True)
class Agreement:
  """The language, its clock, what bits mean, the camera, and where it is flown.

  Attributes:
    codebook: The gestures.
    pauses: The rests between them.
    tolerance: How far from its time a motion may be seen.
    units: The payload's fields, and what a count of each means.
    camera: What observers see with.
    rate_hz: How many images and references there are in a second: 250 over a
      whole number, 10 to 125; 25 in the paper (section 'Evaluation protocol').
    hover_height_m: Where everybody hovers and where a message leads to, 0.5 to
      5.5 m above the floor; 1.3 m in the paper (sections 'Scene, sensors, and
      information boundaries' and 'Per-observer navigation').
    language: What is spoken; None for the paper's frames of the gestures of
      `codebook`, with a null after each.
    packets: How data are cut, where data of any length are sent in place of a
      payload; None for payloads.
  """

  codebook: gestures.Codebook = gestures.v_codebook()
  pauses: timing.Timing = timing.Timing()
  tolerance: clock_lib.Tolerance = clock_lib.Tolerance()
  units: payload.Units = payload.Units()
  camera: camera_lib.Camera = camera_lib.Camera()
  rate_hz: float = 25.0
  hover_height_m: float = 1.3
  language: languages.Language | None = None
  packets: packets_lib.Packets | None = None

  def __post_init__(self) -> None:
    few, many = _STEPS
    limits = {
      'rate_hz': (STEPS_HZ / many, STEPS_HZ / few),
      'hover_height_m': _HEIGHT_M,
    }
    checks.settle_numbers(self, limits, AgreementError)
    steps = STEPS_HZ / self.rate_hz
    whole = round(steps)
    if abs(steps - whole) > _SAME * steps:
      raise AgreementError(
        f'`rate_hz` must be {STEPS_HZ} over a whole number, as a frame is a'
        f' whole number of physics steps of {1 / STEPS_HZ:g} s, such as'
        f' {STEPS_HZ / math.ceil(steps):.6g} or'
        f' {STEPS_HZ / math.floor(steps):.6g}: got {self.rate_hz!r}'
      )
    checks.settle(self, 'rate_hz', STEPS_HZ / whole)
    lowest_m = _CLEAR_M - self.lowest_m
    if self.hover_height_m < lowest_m - _SAME:
      raise AgreementError(
        f'`hover_height_m` must be at least {lowest_m:g}, so that gestures stay'
        f' {_CLEAR_M:g} m above the floor: got {self.hover_height_m!r}'
      )

  @property
  def motions(self) -> tuple[schedule.Path, ...]:
    """The steepest of all that is flown."""
    if self.language is None:
      return self.codebook.gestures
    return self.language.alphabet.motions

  @property
  def lowest_m(self) -> float:
    """How high the lowest point of a dance is, from the hover point."""
    if self.language is None:
      return self.codebook.lowest_m
    return self.language.alphabet.lowest_m

  @property
  def highest_m(self) -> float:
    """How high the highest point of a dance is, from the hover point."""
    if self.language is None:
      return self.codebook.highest_m
    return self.language.alphabet.highest_m

  @property
  def clock(self) -> clock_lib.Clock:
    """When the motions of a message come."""
    return clock_lib.Clock(self.codebook, self.pauses, self.tolerance)

  @property
  def spoken(self) -> languages.Language:
    """The language, with the paper's as one of gestures between rests.

    Raises:
      AlphabetError: if the codebook makes none.
    """
    if self.language is not None:
      return self.language
    rests = self.pauses
    return languages.Language(
      alphabets.Gestures(self.codebook, rests.pause_s),
      initial_hover_s=rests.initial_hover_s,
      confirm_s=_NULL_S,
    )

  @property
  def coding(self) -> coding.Coding:
    """What makes a frame known from a damaged one; packets have a check."""
    spoken = self.spoken.coding
    if self.packets is None:
      return spoken
    return dataclasses.replace(spoken, check=_PACKET_CHECK)

  def word(self, bits: str) -> tuple[int, ...]:
    """The symbols of a frame."""
    return self.coding.symbols(bits, self.spoken.alphabet.size)

  @property
  def frame_bits(self) -> int:
    """How many bits a frame carries."""
    if self.packets is not None:
      return self.packets.packet_bits
    return self.units.num_bits

  @property
  def frame_s(self) -> float:
    """Seconds from one image to the next."""
    return 1 / self.rate_hz

  def frames(self, duration_s: float) -> int:
    """The number of images nearest to a duration."""
    return round(duration_s * self.rate_hz)
