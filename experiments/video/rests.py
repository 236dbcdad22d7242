"""When nothing moves in the middle of a recording, to say why it is not read.

It knows of no receiver: it compares each picture with one a moment before.
"""

from collections import deque
import dataclasses
import math

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import pace, receivers
from waggle_tasks.protocol import agreement as agreement_lib

_LAG_S = 0.2
_SIDE = 60  # Pixels of the small picture that stands for the middle.
_LEVELS = 3.0, 6.0, 12.0, 24.0  # A pixel that changes by more has changed...
_NOISE = 8.0  # ...if that is so many times the usual change of all.
_PIXELS = 2  # Fewest of a motion.
_FAST_PX_S = 8.0  # Of a place, before the paper's camera.


@dataclasses.dataclass(frozen=True)
class Look:
  """What a picture tells.

  Attributes:
    time_s: When it was.
    usual: How much most of its pixels changed.
    changed: How many changed by more than each of `_LEVELS`.
  """

  time_s: float
  usual: float
  changed: tuple[int, ...]


class Rests:
  """Watches pictures, or places; asked at the end."""

  def __init__(self) -> None:
    self._greys: deque[tuple[float, np.ndarray]] = deque()
    self._looks: list[Look] = []
    self._pace = pace.Pace(config_lib.Differencing().speed_s)

  def picture(self, image: np.ndarray, time_s: float) -> None:
    """Takes a picture, (H, W, 3) uint8 RGB, with the target in its middle."""
    height, width, _ = image.shape
    half = max(min(height, width) // 4, 1)
    top, left = height // 2 - half, width // 2 - half
    middle = np.ascontiguousarray(
      image[top : top + 2 * half, left : left + 2 * half]
    )
    small = cv2.resize(
      cv2.cvtColor(middle, cv2.COLOR_RGB2GRAY), (_SIDE, _SIDE), None, 0, 0,
      cv2.INTER_AREA,
    )  # fmt: skip
    greys = self._greys
    greys.append((time_s, small))
    while len(greys) > 2 and time_s - greys[1][0] > _LAG_S - 1e-6:
      greys.popleft()
    change = cv2.absdiff(small, greys[0][1])
    counts = tuple(int(np.count_nonzero(change > each)) for each in _LEVELS)
    self._looks.append(Look(time_s, float(change.mean()), counts))

  def place(self, place: np.ndarray, time_s: float, zoom: float) -> None:
    """Takes a place as `tracks.place` makes it.

    Args:
      place: The place.
      time_s: When it was.
      zoom: Focal length over that of the paper's camera.
    """
    if not np.isfinite(place[:2]).all():
      self._pace.forget()
      return
    fast = self._pace.step((time_s, *place[:2])) > zoom * _FAST_PX_S
    counts = (_PIXELS * int(fast),) * len(_LEVELS)
    self._looks.append(Look(time_s, 0.0, counts))

  def reason(self, what: str, need_s: float) -> str:
    """Why nothing can be learned of a target at rest; empty where it can.

    Args:
      what: What this is, such as 'film'.
      need_s: How long a rest before the dance must be.
    """
    spans = self._spans()
    if not self._looks or not spans:
      return ''
    lengths_s = [end_s - begin_s for begin_s, end_s in spans]
    begin_s = self._looks[0].time_s
    if max(lengths_s) < need_s:
      return (
        f'the {what} has no rest: of {need_s:.2g} s that it takes to learn the'
        ' background and where the target hovers, the longest has'
        f' {max(lengths_s):.2g} s'
      )
    if spans[0][0] - begin_s < 1e-6 and lengths_s[0] >= need_s:
      return ''
    first_s = next(
      begin for (begin, _), length_s in zip(spans, lengths_s, strict=True)
      if length_s >= need_s
    )  # fmt: skip
    return (
      f'the {what} begins in motion: no rest to learn the background from, and'
      f' where the target hovers, before {first_s:.1f} s; what was danced until'
      ' then cannot be read'
    )

  def _spans(self) -> list[tuple[float, float]]:
    """From when to when nothing moved."""
    usual = min((each.usual for each in self._looks[1:]), default=0.0)
    level = next(
      (k for k, each in enumerate(_LEVELS) if each >= _NOISE * usual), -1
    )
    spans: list[tuple[float, float]] = []
    since_s = math.nan
    for each in self._looks:
      if each.changed[level] >= _PIXELS:
        since_s = math.nan
        continue
      if math.isnan(since_s):
        since_s = each.time_s
        spans.append((since_s, since_s))
      spans[-1] = since_s, each.time_s
    return spans or [(self._looks[0].time_s,) * 2] if self._looks else []


def need_s(name: str, agreement: agreement_lib.Agreement) -> float:
  """How long a target must rest before a receiver can read its dance.

  Args:
    name: As `receivers.make` takes it.
    agreement: What both sides know.
  """
  null = receivers.describe(name, agreement).null
  if null is not None:
    return null.hold_s
  tracking = getattr(receivers.configured(name)[1], 'tracking', None)
  return float(getattr(tracking, 'learn_s', 0.0))
