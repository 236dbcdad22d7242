"""What a camera's sensor makes of light: shading, focus, colours and noise."""

import math

import cv2
import numpy as np

from waggle_tasks import eyes
from waggle_tasks.entities import corruptors, lenses
from waggle_tasks.protocol import camera as camera_lib

_WHITE = 255
# Controls leave light alone that is so near to what they want (assumed: a
# control without such a band would follow whatever moves), and reach so far.
_BAND, _REACH = 0.02, 8.0
_METER_PX = 8  # Exposure and balance are metered in cells of this side.


class Sensor:
  """Turns what falls on a camera into its picture.

  Attributes:
    gain: What its exposure control multiplies light by; 1 at first, as it has
      settled before an episode.
  """

  def __init__(
    self,
    eye: eyes.Eye,
    camera: camera_lib.Camera,
    frame_s: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Draws noise and hot pixels.

    Args:
      eye: The camera.
      camera: Its calibration.
      frame_s: From one picture to the next.
      random_state: What it draws from.
    """
    self._eye = eye
    shape = camera.shape[:2] if eye.grey or eye.mosaic else camera.shape
    hot = random_state.random_sample(shape[:2]) < eye.hot_share
    self._hot = np.nonzero(hot)
    self._noise = None
    if eye.read_noise or eye.well_electrons:
      self._noise = corruptors.SensorNoise(
        eye.read_noise, eye.well_electrons, shape, random_state
      )
    self._shade = None
    if eye.vignette:
      self._shade = shade(camera, eye.vignette)
    self._exposure = Control(eye.exposure_lag_s, frame_s)
    self._balance = Control(eye.balance_lag_s, frame_s)

  @property
  def gain(self) -> float:
    """See the class."""
    return float(self._exposure.gain)

  def picture(self, light: np.ndarray) -> np.ndarray:
    """The picture of light, (H, W, 3) uint8 each; light is not kept."""
    eye = self._eye
    if self._shade is not None:
      light = cv2.multiply(light, self._shade, dst=light, scale=1 / _WHITE)
    if eye.defocus_px:
      light = cv2.GaussianBlur(light, (0, 0), eye.defocus_px)
    red, blue = np.broadcast_to(self._balance.gain, 2)
    if red != 1 or blue != 1:
      levels = np.outer(np.arange(_WHITE + 1), (red, 1.0, blue))
      table = np.clip(np.rint(levels), 0, _WHITE).astype(np.uint8)
      light = cv2.LUT(light, table[:, None])
    out = self._read(light)
    if eye.line_px:
      out = cv2.GaussianBlur(
        out, (2 * math.ceil(3 * eye.line_px) + 1, 1), eye.line_px
      )
    self._meter(out)
    return out

  def _read(self, light: np.ndarray) -> np.ndarray:
    if self._eye.grey:
      raw = cv2.cvtColor(light, cv2.COLOR_RGB2GRAY)
    elif self._eye.mosaic:
      raw = mosaic(light)
    else:
      raw = light
    if self._noise is not None:
      self._noise(raw)
    raw[self._hot] = _WHITE
    if self._eye.grey:
      return cv2.cvtColor(raw, cv2.COLOR_GRAY2RGB)
    if self._eye.mosaic:
      return cv2.cvtColor(raw, cv2.COLOR_BayerRGGB2RGB)
    return raw

  def _meter(self, picture: np.ndarray) -> None:
    """Lets the controls see what came of it."""
    if not (self._eye.exposure_lag_s or self._eye.balance_lag_s):
      return
    cells = picture[_METER_PX // 2 :: _METER_PX, _METER_PX // 2 :: _METER_PX]
    red, green, blue = np.maximum(cells.mean(axis=(0, 1)), 0.5)
    self._exposure.see(np.array((red + green + blue) / 3))
    self._balance.see(np.array([red, blue]) / green)


class Control:
  """Brings a measure back to what it was at first, with a lag.

  The logarithm of the gain nears what is wanted as a first-order system does.

  Attributes:
    gain: What light is multiplied by.
  """

  def __init__(self, lag_s: float, frame_s: float) -> None:
    """Makes it for a time constant; 0 for none."""
    self._step = 1 - math.exp(-frame_s / lag_s) if lag_s else 0.0
    self._wanted: np.ndarray | None = None
    self.gain = np.array(1.0)

  def see(self, measure: np.ndarray) -> None:
    """Takes the measure of a picture that was made with the gain."""
    if self._wanted is None:
      self._wanted = measure
    off = np.log(self._wanted / measure)
    off = np.where(np.abs(off) > math.log1p(_BAND), off, 0.0)
    gain = self.gain * np.exp(self._step * off)
    self.gain = np.clip(gain, 1 / _REACH, _REACH)


def shade(camera: camera_lib.Camera, share: float) -> np.ndarray:
  """(H, W, 3) uint8, how much light comes to each pixel, 255 for all of it.

  In the middle all; elsewhere a share of what the fourth power of the cosine
  of the angle from the axis takes away is gone.
  """
  square = (lenses.seen(camera) ** 2).sum(axis=-1)
  light = 1 - share * (1 - (1 + square) ** -2)
  return cv2.merge([np.rint(_WHITE * light).astype(np.uint8)] * 3)


def mosaic(light: np.ndarray) -> np.ndarray:
  """(H, W) of (H, W, 3): red and green in even rows, green and blue in odd."""
  raw = light[..., 1].copy()
  raw[::2, ::2] = light[::2, ::2, 0]
  raw[1::2, 1::2] = light[1::2, 1::2, 2]
  return raw
