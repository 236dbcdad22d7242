"""How a picture moves when its camera turns, or when it merely shifts.

A camera that turns about its own centre moves its picture as a plane: without
parallax, whatever is in it (Hartley and Zisserman 2004, section 8.4). Motions
are in pixels: of the picture's middle along x and y, and for a turn about the
line of sight of what is a focal length away from the middle.
"""

from typing import Protocol

import cv2
import numpy as np


class Geometry(Protocol):
  """What a picture can do as a whole.

  Attributes:
    count: How many numbers tell of it; the first two are of the middle.
  """

  count: int

  def smaller(self, times: int) -> 'Geometry':
    """That of pictures that are so many times smaller."""
    ...

  def flow(self, places_px: np.ndarray) -> np.ndarray:
    """How places (2, K) move with each number, (count, 2, K), at rest."""
    ...

  def moved(self, places_px: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Where places (2, K) are after a motion (count,), (2, K) float32."""
    ...

  def undone(
    self, grey: np.ndarray, motion: np.ndarray, outside: np.ndarray
  ) -> np.ndarray:
    """A picture (H, W) uint8 without a motion; `outside` where nothing is."""
    ...


class Shifts:
  """Of a part of a picture: it shifts along x and y."""

  count = 2

  def smaller(self, times: int) -> 'Shifts':
    """See `Geometry`."""
    return self

  def flow(self, places_px: np.ndarray) -> np.ndarray:
    """See `Geometry`."""
    return np.repeat(np.eye(2)[:, :, None], places_px.shape[1], axis=2)

  def moved(self, places_px: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """See `Geometry`."""
    return places_px + motion[:, None].astype(np.float32)

  def undone(
    self, grey: np.ndarray, motion: np.ndarray, outside: np.ndarray
  ) -> np.ndarray:
    """See `Geometry`."""
    plane = np.array([[1, 0, motion[0]], [0, 1, motion[1]], [0, 0, 1]], float)
    return _undone(grey, plane, outside)


class Turns:
  """Of a whole picture: its camera turns about all three axes."""

  count = 3

  def __init__(self, size: tuple[int, int], focal_px: float) -> None:
    """Makes it for the pictures of a camera.

    Args:
      size: Their width and height.
      focal_px: Its focal length.
    """
    self._size, self._focal_px = size, focal_px
    self._middle_px = (np.array(size) - 1) / 2
    self._to_rays = np.eye(3)
    self._to_rays[:2, 2] = -self._middle_px
    self._to_rays[:2] /= focal_px
    self._to_pixels = np.linalg.inv(self._to_rays)

  def smaller(self, times: int) -> 'Turns':
    """See `Geometry`."""
    width, height = self._size
    return Turns((width // times, height // times), self._focal_px / times)

  def flow(self, places_px: np.ndarray) -> np.ndarray:
    """See `Geometry`."""
    p, q = (places_px - self._middle_px[:, None]) / self._focal_px
    return np.array([[1 + p * p, p * q], [p * q, 1 + q * q], [-q, p]])

  def moved(self, places_px: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """See `Geometry`."""
    plane = self._plane(motion)
    x, y, depth = plane[:, :2] @ places_px + plane[:, 2:]
    return np.stack([x / depth, y / depth]).astype(np.float32)

  def undone(
    self, grey: np.ndarray, motion: np.ndarray, outside: np.ndarray
  ) -> np.ndarray:
    """See `Geometry`."""
    return _undone(grey, self._plane(motion), outside)

  def _plane(self, motion: np.ndarray) -> np.ndarray:
    """The homography (3, 3) from pixels before to pixels after."""
    x, y, roll = motion / self._focal_px
    turn, _ = cv2.Rodrigues(np.array([-y, x, roll]))
    return self._to_pixels @ turn @ self._to_rays


def _undone(
  grey: np.ndarray, plane: np.ndarray, outside: np.ndarray
) -> np.ndarray:
  """The picture of which `grey` is what a homography has made."""
  return cv2.warpPerspective(
    grey, plane, grey.shape[::-1], outside.copy(),
    cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, cv2.BORDER_TRANSPARENT,
  )  # fmt: skip
