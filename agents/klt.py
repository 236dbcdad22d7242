"""Sparse optical flow: where the dancing target is in each image.

Features are Shi-Tomasi corners followed by pyramidal Lucas-Kanade flow, with
a forward-backward and a support check (paper, section 'RGB optical flow';
OpenCV, module video, calcOpticalFlowPyrLK).
"""

from collections import deque
import dataclasses
import math

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import medians

# Speed is measured over at least so long, the time from one image to the next
# of the paper's camera: faster cameras, and recordings that show each image
# several times, would measure their noise, or nothing and twice as much in
# turn.
_SPEED_S = 0.04


@dataclasses.dataclass(frozen=True, eq=False)
class Track:
  """The target in one image.

  Attributes:
    time_s: Time of the image.
    centre_px: (2,) x right and y down; the last known one when lost.
    speed_px_s: Image speed, over a short time.
    support: Features that survived all checks.
    quality: Their share of those that were followed.
    valid: Whether the support is enough.
    outside: Whether it is lost because it has left the picture.
    width_px: How wide the target was at rest, where the tracker knows.
  """

  time_s: float
  centre_px: np.ndarray
  speed_px_s: float
  support: int
  quality: float
  valid: bool
  outside: bool = False
  width_px: float | None = None

  def loss(self, config: config_lib.Tracking) -> str:
    """Why the frame is not valid."""
    if self.support < config.min_support:
      return f'support {self.support} < {config.min_support}'
    checked = 'forward-backward' if config.forward_backward else 'support'
    return f'{checked} ratio {self.quality:.2f} < {config.min_quality}'


@dataclasses.dataclass(frozen=True, eq=False)
class _Patch:
  """A grey square of an image.

  Attributes:
    left: Its first column in the image.
    top: Its first row in the image.
    grey: (h, w) uint8.
    image_size: Width and height of the whole image.
  """

  left: int
  top: int
  grey: np.ndarray
  image_size: tuple[int, int]

  @classmethod
  def of(cls, image: np.ndarray, centre_px: np.ndarray, side: int) -> '_Patch':
    """Cuts a square, moved inwards where it would leave the image."""
    size = image.shape[1], image.shape[0]
    left, top = (
      int(min(max(centre - side / 2, 0), max(length - side, 0)))
      for centre, length in zip(centre_px, size, strict=True)
    )
    square = image[top : top + side, left : left + side]
    return cls(left, top, cv2.cvtColor(square, cv2.COLOR_RGB2GRAY), size)

  @property
  def origin_px(self) -> np.ndarray:
    """(2,) float32 place of its first pixel in the image."""
    return np.array([self.left, self.top], np.float32)

  def crop(self, left: int, top: int, right: int, bottom: int) -> '_Patch':
    """A part of it, given and clipped in image coordinates."""
    height, width = self.grey.shape
    left, top = max(left, self.left), max(top, self.top)
    right = min(right, self.left + width)
    bottom = min(bottom, self.top + height)
    rows = slice(top - self.top, max(bottom, top) - self.top)
    columns = slice(left - self.left, max(right, left) - self.left)
    return _Patch(left, top, self.grey[rows, columns], self.image_size)


class KltTracker:
  """Follows one target that begins near the middle of the image.

  Work is confined to squares around the target: features are sought in one of
  `box_px`, followed in one of twice that side, and one of three times that
  side is kept for the next image.
  """

  def __init__(self, config: config_lib.Tracking) -> None:
    self._config = config
    self._last: _Patch | None = None
    self._time_s = -np.inf
    self._points = np.empty((0, 2), np.float32)
    # Durations and shifts of the last images, of which speed is made.
    self._recent: deque[tuple[float, np.ndarray]] = deque()
    self._centre_px = np.empty(0)  # (2,) from the first image on.
    self.anchor_px: np.ndarray | None = None

  def step(self, image: np.ndarray, time_s: float) -> Track:
    """Takes one image.

    Args:
      image: (H, W, 3) uint8 RGB; it is not kept.
      time_s: Its time, later than the last one's.

    Returns:
      The target in this image.
    """
    config = self._config
    if not self._centre_px.size:
      self._centre_px = np.array([image.shape[1], image.shape[0]]) / 2
    patch = _Patch.of(image, self._centre_px, 3 * config.box_px)
    elapsed_s = time_s - self._time_s
    if elapsed_s > config.max_gap_s:
      self._points = self._points[:0]  # Nothing to follow across a gap.
    followed = len(self._points)
    shift_px, support = np.zeros(2), 0
    if followed and self._last is not None:
      shift_px, support = self._follow(self._last, patch, elapsed_s)
    quality = support / followed if followed else 0.0
    valid = support >= config.min_support and quality >= config.min_quality
    if valid:
      self._centre_px = self._centre_px + shift_px
    else:
      self._points = self._points[:0]
      self._recent.clear()
    if len(self._points) < config.redetect_below:
      self._replenish(patch)
    self._last, self._time_s = patch, time_s
    speed_px_s = self._speed(elapsed_s, shift_px) if valid else 0.0
    return Track(
      time_s, self._centre_px.copy(), speed_px_s, support, quality, valid
    )

  def _speed(self, elapsed_s: float, shift_px: np.ndarray) -> float:
    """Image speed over the last images, with one more shift, (2,)."""
    recent = self._recent
    recent.append((elapsed_s, shift_px))
    total_s = sum(each_s for each_s, _ in recent)
    while total_s - recent[0][0] > _SPEED_S - 1e-6:
      total_s -= recent.popleft()[0]
    way_px = sum((shift for _, shift in recent), np.zeros(2))
    return math.hypot(*way_px) / total_s

  def _square(self, patch: _Patch, side_px: int) -> _Patch:
    left, top = (int(c - side_px / 2) for c in self._centre_px)
    return patch.crop(left, top, left + side_px, top + side_px)

  def _follow(
    self, last: _Patch, patch: _Patch, elapsed_s: float
  ) -> tuple[np.ndarray, int]:
    """Moves the features to the new image; the target's shift and support."""
    config = self._config
    before = self._square(last, 2 * config.box_px)
    height, width = before.grey.shape
    after = patch.crop(
      before.left, before.top, before.left + width, before.top + height
    )
    if np.array_equal(before.grey, after.grey):
      return np.zeros(2), len(self._points)  # Not a pixel has changed.
    if before.grey.shape != after.grey.shape:
      return np.zeros(2), 0  # It moved further than a patch reaches.
    start = (self._points - before.origin_px)[:, None]
    # In twice the time features go twice as far, which a level more reaches.
    more = max(round(math.log2(elapsed_s / _SPEED_S)), 0)
    levels = self._config.levels + more
    there, kept = self._flow(before, after, start, levels)
    if config.forward_backward:
      back, returned = self._flow(after, before, there, levels)
      error_px = np.hypot(*(back - start)[:, 0].T)
      kept &= returned & (error_px < config.forward_backward_px)
    there = there[:, 0] + before.origin_px
    kept &= (there >= 0).all(1) & (there < patch.image_size).all(1)
    if not kept.any():
      return np.zeros(2), 0
    shifts = (there - self._points)[kept]
    median = medians.of(shifts)
    agree = np.abs(shifts - median).max(1) < config.forward_backward_px
    self._points = there[kept][agree]
    return median.astype(float), int(agree.sum())

  def _flow(
    self, before: _Patch, after: _Patch, points: np.ndarray, levels: int
  ) -> tuple[np.ndarray, np.ndarray]:
    """Where points (N, 1, 2) go, and (N,) whether they were found there."""
    side_px = self._config.window_px
    there, found, _ = cv2.calcOpticalFlowPyrLK(
      before.grey, after.grey, points, None,
      winSize=(side_px, side_px), maxLevel=levels,
    )  # fmt: skip
    return there, found[:, 0] == 1

  def _replenish(self, patch: _Patch) -> None:
    """Finds new features around the target."""
    config = self._config
    square = self._square(patch, config.box_px)
    if not square.grey.size:
      return
    mask = np.full(square.grey.shape, 255, np.uint8)
    for x, y in self._points - square.origin_px:
      cv2.circle(mask, (int(x), int(y)), int(config.corner_distance_px), 0, -1)
    corners = cv2.goodFeaturesToTrack(
      square.grey,
      config.max_corners - len(self._points),
      config.corner_quality,
      config.corner_distance_px,
      mask=mask,
    )
    if corners is None:
      return
    new = corners[:, 0] + square.origin_px
    self._points = np.concatenate([self._points, new])
    if self.anchor_px is None and len(new) >= config.min_support:
      self._centre_px = np.median(new, axis=0).astype(float)
      self.anchor_px = self._centre_px.copy()
