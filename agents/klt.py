"""Sparse optical flow: where the dancing target is in each image.

Features are Shi-Tomasi corners followed by pyramidal Lucas-Kanade flow, with
a forward-backward and a support check (paper, section 'RGB optical flow';
OpenCV, module video, calcOpticalFlowPyrLK).
"""

import dataclasses

import cv2
import numpy as np

from waggle_tasks.agents import config as config_lib


@dataclasses.dataclass(frozen=True, eq=False)
class Track:
  """The target in one image.

  Attributes:
    time_s: Time of the image.
    centre_px: (2,) x right and y down; the last known one when lost.
    speed_px_s: Image speed since the last image.
    support: Features that survived all checks.
    quality: Their share of those that were followed.
    valid: Whether the support is enough.
  """

  time_s: float
  centre_px: np.ndarray
  speed_px_s: float
  support: int
  quality: float
  valid: bool

  def loss(self, config: config_lib.Tracking) -> str:
    """Why the frame is not valid."""
    if self.support < config.min_support:
      return f'support {self.support} < {config.min_support}'
    return f'forward-backward ratio {self.quality:.2f} < {config.min_quality}'


class KltTracker:
  """Follows one target that begins near the middle of the image."""

  def __init__(self, config: config_lib.Tracking) -> None:
    self._config = config
    self._grey: np.ndarray | None = None
    self._time_s = -np.inf
    self._points = np.empty((0, 2), np.float32)
    self._centre_px: np.ndarray | None = None
    self.anchor_px: np.ndarray | None = None

  def step(self, image: np.ndarray, time_s: float) -> Track:
    """Takes one image.

    Args:
      image: (H, W, 3) uint8 RGB.
      time_s: Its time, later than the last one's.

    Returns:
      The target in this image.
    """
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    elapsed_s = time_s - self._time_s
    if elapsed_s > self._config.max_gap_s:
      self._points = self._points[:0]  # Nothing to follow across a gap.
    followed = len(self._points)
    shift_px, support = np.zeros(2), 0
    if followed:
      shift_px, support = self._follow(grey)
    quality = support / followed if followed else 0.0
    valid = (
      support >= self._config.min_support
      and quality >= self._config.min_quality
    )
    if valid:
      self._centre_px = self._centre_px + shift_px
    else:
      self._points = self._points[:0]
    self._replenish(grey)
    self._grey, self._time_s = grey, time_s
    speed_px_s = float(np.hypot(*shift_px)) / elapsed_s if valid else 0.0
    return Track(
      time_s, self._centre_px.copy(), speed_px_s, support, quality, valid
    )

  def _follow(self, grey: np.ndarray) -> tuple[np.ndarray, int]:
    """Moves the features to the new image; the target's shift and support."""
    config = self._config
    left, top, right, bottom = self._around(2 * config.box_px, grey.shape)
    origin = np.array([left, top], np.float32)
    before = self._grey[top:bottom, left:right]
    after = grey[top:bottom, left:right]
    flow = {
      'winSize': (config.window_px, config.window_px),
      'maxLevel': config.levels,
    }
    start = (self._points - origin)[:, None]
    there, found, _ = cv2.calcOpticalFlowPyrLK(
      before, after, start, None, **flow
    )
    back, returned, _ = cv2.calcOpticalFlowPyrLK(
      after, before, there, None, **flow
    )
    error_px = np.linalg.norm(back - start, axis=2)[:, 0]
    there = there[:, 0] + origin
    height, width = grey.shape
    kept = (
      (found[:, 0] == 1)
      & (returned[:, 0] == 1)
      & (error_px < config.forward_backward_px)
      & (there >= 0).all(1)
      & (there < (width, height)).all(1)
    )
    if not kept.any():
      return np.zeros(2), 0
    shifts = (there - self._points)[kept]
    median = np.median(shifts, axis=0)
    agree = np.abs(shifts - median).max(1) < config.forward_backward_px
    self._points = there[kept][agree]
    return median.astype(float), int(agree.sum())

  def _replenish(self, grey: np.ndarray) -> None:
    """Finds new features around the target when few are left."""
    config = self._config
    if len(self._points) >= config.redetect_below:
      return
    if self._centre_px is None:
      self._centre_px = np.array(grey.shape[::-1]) / 2
    left, top, right, bottom = self._around(config.box_px, grey.shape)
    mask = np.full((bottom - top, right - left), 255, np.uint8)
    for x, y in self._points - (left, top):
      cv2.circle(mask, (int(x), int(y)), int(config.corner_distance_px), 0, -1)
    corners = cv2.goodFeaturesToTrack(
      grey[top:bottom, left:right],
      config.max_corners - len(self._points),
      config.corner_quality,
      config.corner_distance_px,
      mask=mask,
    )
    if corners is None:
      return
    new = corners[:, 0] + np.array([left, top], np.float32)
    self._points = np.concatenate([self._points, new])
    if self.anchor_px is None and len(new) >= config.min_support:
      self._centre_px = np.median(new, axis=0).astype(float)
      self.anchor_px = self._centre_px.copy()

  def _around(
    self, side_px: int, shape: tuple[int, ...]
  ) -> tuple[int, int, int, int]:
    """A square around the target, inside the image: left, top, right, bottom.

    Near an edge it is moved inwards, so that it never becomes too small.
    """
    out = []
    for centre, size in zip(self._centre_px, shape[::-1], strict=True):
      low = int(np.clip(centre - side_px / 2, 0, max(size - side_px, 0)))
      out.append((low, min(low + side_px, size)))
    (left, right), (top, bottom) = out
    return left, top, right, bottom
