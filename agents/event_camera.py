"""Events from frames: what an event camera would have seen between two images.

The model is that of simulators of event cameras (Rebecq et al. 2018, 'ESIM: an
Open Event Camera Simulator', CoRL; Hu et al. 2021, 'v2e: From Video Frames to
Realistic DVS Events', CVPRW): every pixel remembers a logarithm of brightness,
and each time that its own has moved from there by a threshold it sends an event
and remembers one threshold farther. Between two images brightness is
interpolated linearly in its logarithm. Below 20 grey levels the logarithm is a
straight line, as in v2e, where it would make noise of nothing.

Left out are what v2e adds for real sensors: thresholds that differ from pixel
to pixel, bandwidth, shot noise and leaks. What noise images have makes events
as it does there. Grey levels are taken for brightness as they are.
"""

import dataclasses
import math

import cv2
import numpy as np

from waggle_tasks.agents import difference, group

_LINEAR = 20  # Grey levels up to which the logarithm is a straight line.
# Logarithms are whole parts of a threshold, so that sums of them are exact.
_PARTS = 1024


@dataclasses.dataclass(frozen=True)
class Pixels(group.Group):
  """The pixels of an event camera.

  Attributes:
    contrast: The threshold, in natural logarithms of brightness: 0.2 is what
      v2e takes by default.
    event_rate_hz: How often brightness is looked at between two images: times
      of events are whole steps of this rate.
  """

  contrast: float = group.number(0.2, 0.02, 2)
  event_rate_hz: float = group.number(1000.0, 10, 1_000_000)


@dataclasses.dataclass(frozen=True, eq=False)
class Events:
  """Events between two images, in the order of their times.

  Attributes:
    times_s: (N,) when.
    rows: (N,) and...
    columns: ...(N,) where.
    signs: (N,) int8, 1 for brighter and -1 for darker.
  """

  times_s: np.ndarray
  rows: np.ndarray
  columns: np.ndarray
  signs: np.ndarray

  @classmethod
  def none(cls) -> 'Events':
    """No events."""
    nothing = np.zeros(0, int)
    return cls(np.zeros(0), nothing, nothing, np.zeros(0, np.int8))


class EventCamera:
  """Turns images into events.

  A pixel that is as bright as at first has sent as many events of each sign,
  however long that takes.
  """

  def __init__(self, pixels: Pixels) -> None:
    """Begins without an image."""
    self._rate_hz = pixels.event_rate_hz
    levels = np.arange(256.0)
    slope = math.log(_LINEAR) / _LINEAR
    logs = np.where(
      levels <= _LINEAR, slope * levels, np.log(np.maximum(levels, 1.0))
    )
    parts = np.rint(_PARTS * logs / pixels.contrast)
    self._table = (parts / _PARTS).astype(np.float32)  # In thresholds.
    self._known = np.zeros((0, 0), np.float32)  # What pixels remember.
    self._grey = np.zeros((0, 0), np.uint8)
    self._time_s = -math.inf

  def step(self, image: np.ndarray, time_s: float) -> Events:
    """Takes an image, (H, W, 3) uint8 RGB, and returns the events before it.

    The first one only tells pixels what to remember.
    """
    grey = difference.grey(image)
    logs = cv2.LUT(grey, self._table)
    before_s, before, self._time_s = self._time_s, self._grey, time_s
    self._grey = grey
    if not before.size:
      self._known = logs
      return Events.none()
    change = cv2.subtract(logs, self._known)
    places = cv2.findNonZero(
      cv2.compare(cv2.absdiff(change, 0.0), 1.0, cv2.CMP_GE)
    )
    if places is None:
      return Events.none()
    columns, rows = places.reshape(-1, 2).T
    last = self._table[before[rows, columns]]
    now, known = logs[rows, columns], self._known[rows, columns]
    whole = np.trunc(change[rows, columns])
    self._known[rows, columns] += whole
    counts, signs = np.abs(whole).astype(int), np.sign(whole).astype(np.int8)
    pixel = np.repeat(np.arange(len(whole)), counts)
    number = np.arange(len(pixel)) - np.repeat(
      np.cumsum(counts) - counts, counts
    )
    crossed = known[pixel] + signs[pixel] * (number + 1)
    times_s = self._times_s(crossed, last[pixel], now[pixel], before_s, time_s)
    order = np.argsort(times_s, kind='stable')
    pixel = pixel[order]
    return Events(times_s[order], rows[pixel], columns[pixel], signs[pixel])

  def _times_s(
    self,
    crossed: np.ndarray,  # (N,)
    last: np.ndarray,  # (N,)
    now: np.ndarray,  # (N,)
    before_s: float,
    time_s: float,
  ) -> np.ndarray:
    """When brightness, on its way from one image to the next, crosses levels.

    Rounded up to steps of the rate, none later than the image.
    """
    shares = np.clip((crossed - last) / (now - last), 0.0, 1.0)
    steps = np.ceil(shares * (time_s - before_s) * self._rate_hz - 1e-6)
    return np.minimum(before_s + steps / self._rate_hz, time_s)
