"""Hover as it is measured: place and attitude by spectrum.

A signal is a sum of waves of random phases in bands of frequency, whose root
mean squares are those of a `Spectrum`. So it is smooth and known at any time
with its velocity and acceleration, and it wanders over the shortest time as
over the longest. A vehicle that is pushed aside leans: the part of its tilt
that moves it is a = g tan(tilt), the rest is tilt that moves nothing.
"""

from collections.abc import Sequence
import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, minimum_jerk

# A window of 4 s with its mean removed shows little of the first band, which
# is the slow wander of a hover.
EDGES_HZ = (0.02, 0.2, 0.55, 1.0, 2.0, 4.0, 10.0)
BANDS = len(EDGES_HZ) - 1
# Of each band; enough for their sum to wander as if by chance.
_WAVES = 10
# How steeply power falls with frequency within a band, over its logarithm:
# place as velocity that is equally strong everywhere, attitude as white noise;
# in the slow band both are long memory, equally strong in every octave.
_STEEPNESS = {'place': 2.0, 'attitude': -1.0}
# References are set once a frame: what is faster than this share of their rate
# could not be told from what is slower.
_SHARE_OF_RATE = 0.4
_GRAVITY_MPS2 = 9.81
# A vehicle begins at its place, and its hover grows from nothing.
GROWTH_S = 2.0


class HoverError(errors.WaggleError):
  """A hover that cannot be flown."""


@dataclasses.dataclass(frozen=True)
class Spectrum:
  """Root mean square of a hover in each band between two of `EDGES_HZ`.

  Attributes:
    x_mm: Place along the world's x, 0 to 30 mm in each band.
    y_mm: The same along y.
    z_mm: The same along z.
    roll_deg: Roll, 0 to 5 degrees in each band; positive to the right.
    pitch_deg: Pitch, the same; positive with the nose down.
    yaw_deg: Heading, the same; positive to the left.
  """

  x_mm: tuple[float, ...]
  y_mm: tuple[float, ...]
  z_mm: tuple[float, ...]
  roll_deg: tuple[float, ...]
  pitch_deg: tuple[float, ...]
  yaw_deg: tuple[float, ...]

  def __post_init__(self) -> None:
    for field in dataclasses.fields(self):
      most = 30.0 if field.name.endswith('_mm') else 5.0
      values = getattr(self, field.name)
      if isinstance(values, str) or not isinstance(values, Sequence):
        raise HoverError(f'`{field.name}` must be numbers: got {values!r}')
      if len(values) != BANDS:
        raise HoverError(
          f'`{field.name}` must be {BANDS} numbers, one for each band between'
          f' {EDGES_HZ} Hz: got {len(values)}'
        )
      checked = [
        checks.number(field.name, value, 0.0, most, HoverError)
        for value in values
      ]
      checks.settle(self, field.name, tuple(map(float, checked)))

  @property
  def place_m(self) -> np.ndarray:  # (3, B)
    """Root mean squares of x, y and z in metres."""
    return np.array([self.x_mm, self.y_mm, self.z_mm]) / 1000

  @property
  def attitude_rad(self) -> np.ndarray:  # (3, B)
    """Root mean squares of roll, pitch and yaw in radians."""
    return np.radians([self.roll_deg, self.pitch_deg, self.yaw_deg])

  @property
  def rms_m(self) -> float:
    """Root mean square of place along the axis that wanders most."""
    return float(np.linalg.norm(self.place_m, axis=1).max())


class Hover:
  """One vehicle's hover in one episode."""

  def __init__(
    self,
    spectrum: Spectrum,
    amplitude: float,
    random_state: np.random.RandomState,
    yaw_rad: float = 0.0,
    rate_hz: float = 25.0,
  ) -> None:
    """Draws the hover.

    Args:
      spectrum: How strong it is in each band.
      amplitude: By how much that is multiplied.
      random_state: Of the episode.
      yaw_rad: The heading of the vehicle: which way it leans to go where.
      rate_hz: How many references there are in a second; waves that are too
        fast for them are left out.
    """
    low, high = np.array(EDGES_HZ[:-1]), np.array(EDGES_HZ[1:])
    share = random_state.uniform(0.0, 1.0, (6, BANDS, _WAVES))
    phase = random_state.uniform(0.0, 2 * math.pi, (6, BANDS, _WAVES))
    along = (np.arange(_WAVES) + share) / _WAVES  # One in each part, apart.
    hz = low[:, None] * (high / low)[:, None] ** along
    rate = 2 * math.pi * hz
    place = amplitude * _strengths(spectrum.place_m, hz[:3], 'place')
    place *= hz[:3] < _SHARE_OF_RATE * rate_hz
    lean, loose = _leaning(
      place * rate[:3] ** 2 / _GRAVITY_MPS2,
      amplitude * spectrum.attitude_rad,
      yaw_rad,
    )
    rest = _strengths(loose, hz[3:], 'attitude')
    rest *= hz[3:] < _SHARE_OF_RATE * rate_hz
    self._place = _Waves(place, rate[:3], phase[:3])
    # Each of roll, pitch and yaw: the waves that move along x and along y, and
    # its own.
    own = np.arange(3, 6)[:, None]
    rows = np.concatenate([np.tile([0, 1], (3, 1)), own], axis=1)
    self._attitude = _Waves(
      np.concatenate([lean, rest[:, None]], axis=1), rate[rows], phase[rows]
    )

  def place(self, time_s: float) -> np.ndarray:  # (3, 3)
    """Place in m, its velocity and its acceleration at a time; each x, y, z."""
    return self._place.at(time_s)

  def attitude(self, time_s: float) -> np.ndarray:  # (3, 3)
    """Roll, pitch and yaw in rad, their rates and second rates at a time."""
    return self._attitude.at(time_s)


class _Waves:
  """Sums of cosines that grow from rest."""

  def __init__(
    self, strength: np.ndarray, rate: np.ndarray, phase: np.ndarray
  ) -> None:
    """Takes the waves: (N, ...) each, of N sums."""
    strength, self._rate, self._phase = (
      each.reshape(len(each), -1) for each in (strength, rate, phase)
    )
    # Of the value and of its two derivatives.
    self._strengths = [strength * self._rate**order for order in range(3)]

  def at(self, time_s: float) -> np.ndarray:  # (3, N)
    """The sums and their first and second derivatives at a time."""
    angle = self._rate * time_s + self._phase
    cosine, sine = np.cos(angle), np.sin(angle)
    value, falling, second_falling = (
      np.einsum('nw,nw->n', each, wave)
      for each, wave in zip(
        self._strengths, (cosine, sine, cosine), strict=True
      )
    )
    grown, growth, second = minimum_jerk.progress(time_s, GROWTH_S)
    return np.array(
      [
        grown * value,
        growth * value - grown * falling,
        second * value - 2 * growth * falling - grown * second_falling,
      ]
    )


def _strengths(
  rms: np.ndarray,  # (3, B)
  hz: np.ndarray,  # (3, B, W)
  kind: str,
) -> np.ndarray:  # (3, B, W)
  """Amplitudes of waves that have a root mean square in each band."""
  steepness = np.full((BANDS, 1), _STEEPNESS[kind])
  steepness[0] = 0.0
  power = hz**-steepness
  power /= power.sum(axis=2, keepdims=True)
  return rms[..., None] * np.sqrt(2 * power)


def _leaning(
  tilt: np.ndarray,  # (3, B, W)
  rms_rad: np.ndarray,  # (3, B)
  yaw_rad: float,
) -> tuple[np.ndarray, np.ndarray]:  # (3, 2, B, W), (3, B)
  """Splits attitude into the lean that moves a vehicle, and the rest.

  Args:
    tilt: Amplitudes of acceleration along x, y and z over gravity.
    rms_rad: Root mean squares of roll, pitch and yaw.
    yaw_rad: The vehicle's heading.

  Returns:
    Amplitudes of the waves along x and along y in roll, pitch and yaw; where
    these alone would be more than was measured, they are less than a move of
    these waves takes. And the root mean squares of what is not such lean.
  """
  cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
  # Whatever accelerates is opposite in phase to place.
  share = -np.array([[sine, -cosine], [cosine, sine], [0.0, 0.0]])
  lean = share[:, :, None, None] * tilt[None, :2]
  power = (lean**2).sum(axis=(1, 3)) / 2  # (3, B)
  scale = np.minimum(1.0, rms_rad / np.sqrt(np.maximum(power, 1e-30)))
  lean *= scale[:, None, :, None]
  rest = np.maximum(rms_rad**2 - power * scale**2, 0.0)
  return lean, np.sqrt(rest)
