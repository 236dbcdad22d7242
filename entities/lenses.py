"""What a lens makes of the picture of a pinhole, and how its camera shakes.

The renderer draws pinholes. So a larger picture of one is drawn, with the same
focal length, and each pixel of the eye's picture is looked up in it (OpenCV,
module imgproc, remap). What stands still in the larger picture is still drawn
once, also where the eye shakes: a camera that turns about its centre sees the
same rays.
"""

import functools
import math

import cv2
import numpy as np

from waggle_tasks import eyes
from waggle_tasks.protocol import camera as camera_lib

# A shake of normal amplitude is larger once in 16 000 times.
_FAR = 4.0
_SPARE_PX = 2  # For looking up between pixels.
# A vibration is of so many frequencies, up to this share beside its own.
_WAVES, _BAND = 5, 0.2
_ROLLING_BAND = 0.3, 1.8  # As that of a drift, times its time.


def drawn(camera: camera_lib.Camera, eye: eyes.Eye) -> camera_lib.Camera:
  """The pinhole whose picture holds all that an eye sees."""
  if not (camera.lens.bends or eye.shakes):
    return camera_lib.Camera(camera.columns, camera.rows, camera.focal_px)
  half_px = np.abs(camera.border).max(axis=0) * camera.focal_px
  spare_px = _SPARE_PX + _FAR * (
    eye.vibration_px * (1 + float(half_px @ half_px) / camera.focal_px**2)
    + math.radians(eye.rolling_deg) * float(np.hypot(*half_px))
  )
  columns, rows = (2 * math.ceil(each + spare_px) for each in half_px)
  return camera_lib.Camera(columns, rows, camera.focal_px)


class Shake:
  """How an eye turns beside its vehicle in one episode."""

  def __init__(
    self, eye: eyes.Eye, focal_px: float, random_state: np.random.RandomState
  ) -> None:
    """Draws it.

    Args:
      eye: The camera.
      focal_px: Its focal length, by which its shaking is told in pixels.
      random_state: What it draws from.
    """
    shares = np.arange(_WAVES) + random_state.uniform(size=(3, _WAVES))
    shares /= _WAVES  # One in each part of the band.
    band = 1 + _BAND * (2 * shares - 1)
    self._rate = 2 * math.pi * eye.vibration_hz * band  # (3, W) rad/s
    low, high = _ROLLING_BAND
    self._rate[2] = (low + (high - low) * shares[2]) / eye.rolling_s
    self._phase = random_state.uniform(0, 2 * math.pi, (3, _WAVES))
    aside_rad = eye.vibration_px / focal_px
    rms = np.array([aside_rad, aside_rad, math.radians(eye.rolling_deg)])
    self._amplitude = rms[:, None] * math.sqrt(2 / _WAVES)

  def turns(self, times_s: np.ndarray) -> np.ndarray:
    """(K, 3, 3) from the shaken eye's axes to its own, at times (K,)."""
    angles = self._rate * times_s[:, None, None] + self._phase  # (K, 3, W)
    vectors = (self._amplitude * np.cos(angles)).sum(axis=2)  # (K, 3)
    return np.array([cv2.Rodrigues(each)[0] for each in vectors])


class Projection:
  """Makes an eye's picture of the larger one."""

  def __init__(
    self,
    camera: camera_lib.Camera,
    eye: eyes.Eye,
    random_state: np.random.RandomState,
  ) -> None:
    """Prepares the look-up.

    Args:
      camera: The eye's calibration.
      eye: The eye.
      random_state: What its shaking is drawn from.
    """
    self._camera, self._drawn = camera, drawn(camera, eye)
    self._shake = Shake(eye, camera.focal_px, random_state)
    self._shakes = eye.shakes
    self._seen = seen(camera)
    self._maps: tuple[np.ndarray, np.ndarray] | None = None
    if camera.lens.bends and not eye.shakes:
      places = self._places(self._seen).astype(np.float32)
      self._maps = cv2.convertMaps(places, None, cv2.CV_16SC2)

  def picture(self, larger: np.ndarray, time_s: float) -> np.ndarray:
    """The eye's picture, (H, W, 3) uint8, a new one.

    Args:
      larger: That of `drawn`.
      time_s: The time of its last row.
    """
    if self._shakes:
      return cv2.remap(
        larger, self._shaken(time_s), None, cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
      )  # fmt: skip
    if self._maps is not None:
      return cv2.remap(larger, *self._maps, cv2.INTER_LINEAR)
    return larger.copy()

  def turns(self, time_s: float) -> np.ndarray:
    """(rows, 3, 3), or (1, 3, 3) for all, see `Shake.turns`."""
    rows = self._camera.rows
    ago_s = self._camera.readout_s * (1 - (np.arange(rows) + 0.5) / rows)
    times_s = time_s - (ago_s if self._camera.readout_s else np.zeros(1))
    return self._shake.turns(times_s)

  def _shaken(self, time_s: float) -> np.ndarray:
    turns = self.turns(time_s).astype(np.float32)
    ahead = self._seen @ turns[:, :, :2].swapaxes(1, 2) + turns[:, None, :, 2]
    return self._places(ahead[..., :2] / ahead[..., 2:])

  def _places(self, seen: np.ndarray) -> np.ndarray:
    """Where directions (H, W, 2) are in the larger picture, as cv2 counts."""
    middle = np.array(self._drawn.size, np.float32) / 2 - np.float32(0.5)
    return seen * np.float32(self._drawn.focal_px) + middle


@functools.lru_cache(maxsize=8)
def seen(camera: camera_lib.Camera) -> np.ndarray:
  """(H, W, 2) float32 where a pinhole shows what each pixel shows."""
  rows, columns = np.indices(camera.shape[:2], np.float32) + np.float32(0.5)
  places = np.stack([columns, rows], axis=-1) - np.array(camera.size) / 2
  return camera.lens.seen(places / camera.focal_px).astype(np.float32)


@functools.lru_cache(maxsize=8)
def rows_of(camera: camera_lib.Camera, eye: eyes.Eye) -> np.ndarray:
  """(H, W) or (H, 1) int, the eye's row of each pixel of the larger picture."""
  larger = drawn(camera, eye)
  if not camera.lens.bends:
    rows = np.arange(larger.rows)[:, None] - (larger.rows - camera.rows) // 2
  else:
    shown = camera.lens.shown(seen(larger))
    rows = np.floor(shown[..., 1] * camera.focal_px + camera.rows / 2)
  return np.clip(rows, 0, camera.rows - 1).astype(int)
