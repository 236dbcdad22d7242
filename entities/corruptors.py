"""What spoils single pictures; each class changes what it is given."""

import functools
import math
import statistics

import cv2
import numpy as np

from waggle_tasks import sensor
from waggle_tasks.protocol import agreement as agreement_lib

_WHITE = 255
# A bank holds this many pictures' worth of noise.
_BANK_PICTURES = 4
# How finely the normal distribution is cut: by 16-bit words.
_WORDS = 2**16


@functools.cache
def _quantiles() -> np.ndarray:
  """The middles of `_WORDS` equally likely parts of a unit normal."""
  normal = statistics.NormalDist()
  shares = (np.arange(_WORDS) + 0.5) / _WORDS
  return np.array([*map(normal.inv_cdf, shares)])


class SensorNoise:
  """Gaussian noise, and shot noise as Gaussian noise that grows with light.

  The variance of a value of level L is sigma^2 + 255 L / photons: that of a
  Poisson count with `photons` at full white, which a Gaussian stands for. It
  is rounded to whole levels, which adds 1/12, and clipped to 0 to 255.

  Drawing millions of values for every picture would cost more than rendering
  it. So a bank is drawn once, and a picture takes a stretch of it from a
  random place on; consecutive stretches share no value.
  """

  def __init__(
    self,
    sigma: float,
    photons: float,
    shape: tuple[int, ...],
    random_state: np.random.RandomState,
  ) -> None:
    """Draws the bank.

    Args:
      sigma: Standard deviation in grey levels, whatever the light.
      photons: How many make full white; 0 for no shot noise.
      shape: Of the pictures, uint8.
      random_state: Source of the bank, and of the places in it.
    """
    self._shape, self._random_state = shape, random_state
    self._size = math.prod(shape)
    self._begin = 0
    unit, self._spread, self._scale = sigma, None, 1.0
    if photons:
      unit, self._spread, self._scale = _shot(sigma, photons)
    count = _BANK_PICTURES * self._size
    words = np.frombuffer(random_state.bytes(2 * count), '<u2')
    words = np.concatenate([words, words[: self._size]])  # Round the end.
    sizes = np.rint(np.minimum(abs(unit * _quantiles()), _WHITE))
    self._amounts = sizes.astype(np.uint8)[words]
    signs = np.where(_quantiles() < 0, _WHITE, 0).astype(np.uint8)
    self._signs = signs[words]

  def __call__(self, image: np.ndarray) -> None:
    """Adds noise to an image of the shape that was asked for."""
    begin = self._advance()
    stretch = slice(begin, begin + self._size)
    amount = self._amounts[stretch].reshape(self._shape)
    sign = self._signs[stretch].reshape(self._shape)
    if self._spread is not None:
      spread = cv2.LUT(image, self._spread)
      amount = cv2.multiply(spread, amount, dst=spread, scale=self._scale)
    # To subtract is to add to the negative: saturated, either is exact.
    cv2.bitwise_xor(image, sign, dst=image)
    cv2.add(image, amount, dst=image)
    cv2.bitwise_xor(image, sign, dst=image)

  def _advance(self) -> int:
    """Where the next stretch begins: clear of the last one, on both sides."""
    free = (_BANK_PICTURES - 2) * self._size
    step = self._size + self._random_state.randint(free + 1)
    self._begin = (self._begin + step) % (_BANK_PICTURES * self._size)
    return self._begin


def _shot(sigma: float, photons: float) -> tuple[float, np.ndarray, float]:
  """Noise that depends on the level, as a product of two bytes.

  Returns:
    What a unit normal is multiplied with to fill a byte, (256,) uint8 the
    deviation by level, and the scale of their product.
  """
  levels = np.arange(_WHITE + 1)
  deviation = np.sqrt(sigma**2 + _WHITE * levels / photons)
  unit = _WHITE / abs(_quantiles()).max()
  spread = np.rint(deviation * _WHITE / deviation[-1]).astype(np.uint8)
  return unit, spread, deviation[-1] / (unit * _WHITE)


class Light:
  """Brightness that steps and flickers."""

  def __init__(
    self,
    chosen: sensor.Sensor,
    random_state: np.random.RandomState,
    agreement: agreement_lib.Agreement,
  ) -> None:
    """Draws the phase of the flicker."""
    self._chosen, self._agreement = chosen, agreement
    self._phase_rad = random_state.uniform(0.0, 2 * math.pi)

  def gain(self, frame: int) -> float:
    """Brightness in a frame; 1 is the room as it is."""
    chosen, time_s = self._chosen, frame * self._agreement.frame_s
    turn_rad = 2 * math.pi * chosen.flicker_hz * time_s + self._phase_rad
    gain = 1 + chosen.flicker_share * math.sin(turn_rad)
    if frame >= self._agreement.frames(chosen.step_s):
      gain *= chosen.step_gain
    return gain

  def __call__(
    self, image: np.ndarray, frame: int, exposure: float = 1.0
  ) -> None:
    """Scales an image, also by what a camera's exposure is."""
    gain = self.gain(frame) * exposure
    if gain != 1:
      cv2.convertScaleAbs(image, dst=image, alpha=gain)


class Blur:
  """Exposure: motion since the last image is blended in."""

  def __init__(self, exposed: float) -> None:
    """Makes it for an exposure, 0 to 1 of the time between two images."""
    # Of the mean over the exposure, when one image fades into the next.
    self._share = exposed / 2
    self._last: np.ndarray | None = None

  def __call__(self, image: np.ndarray) -> None:
    """Blends an image with the one before, as that was before its blending."""
    if not self._share:
      return
    last, self._last = self._last, image.copy()
    if last is not None:
      cv2.addWeighted(image, 1 - self._share, last, self._share, 0.0, dst=image)


def blacken(image: np.ndarray, share: float) -> None:
  """Makes a share of an image's width black, from the left."""
  image[:, : round(share * image.shape[1])] = 0
