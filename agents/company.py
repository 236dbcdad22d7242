"""Whether somebody else hovers beside a dancer, by a picture of its rest."""

import cv2
import numpy as np

_SCALES = 0.7, 1.0, 1.4  # At which others may look like a dancer.
_ALIKE = 0.7  # Correlation of two vehicles.
_FINE_PX = 1.5  # Over which noise is averaged.
_MIDDLE_PX = 32  # As far from the middle a dancer may hover that is faced.
_STANDS_OUT = 0.15  # Energy of something, as a share of the dancer's.


class Rest:
  """A picture in which a dancer rests, and maybe others."""

  def __init__(
    self,
    grey: np.ndarray,
    place_px: np.ndarray,
    width_px: float,
    zoom: float,
  ) -> None:
    """Takes a picture.

    Args:
      grey: (H, W) uint8.
      place_px: (2,) where the dancer is in it...
      width_px: ...and how wide.
      zoom: Its pixels over those of the paper's camera.
    """
    self._grey, self._zoom = grey, zoom
    self._place_px, self._width_px = place_px, width_px
    self._middle_px = np.array(grey.shape[::-1]) / 2

  def middle_holds(self) -> bool:
    """Whether something else stands out in the middle, as the dancer does.

    That is where a dancer hovers that is faced, whatever it looks like.
    """
    fine = cv2.GaussianBlur(self._grey, (0, 0), _FINE_PX).astype(np.float32)
    side = max(int(self._width_px), 4)
    coarse = cv2.GaussianBlur(fine, (0, 0), side / 2)
    energy = cv2.boxFilter((fine - coarse) ** 2, -1, (side, side))
    rows, columns = np.indices(energy.shape)
    x, y = np.abs([columns - self._place_px[0], rows - self._place_px[1]])
    here = np.maximum(x, y) <= 2
    own = np.maximum(x, y) < 1.5 * side
    reach_px = max(_MIDDLE_PX * self._zoom, self._width_px)
    x, y = np.abs([columns - self._middle_px[0], rows - self._middle_px[1]])
    middle = (np.maximum(x, y) <= reach_px) & ~own
    most = energy[here].max(initial=0.0)
    return bool((energy[middle] > _STANDS_OUT * most).any())

  def alike(self, reach_px: float) -> bool:
    """Whether something looks like the dancer within a way of the middle."""
    half_px = max(int(self._width_px / 2), 4)
    left, top = (np.rint(self._place_px) - (half_px, half_px // 2)).astype(int)
    looks = self._grey[
      max(top, 0) : top + half_px, max(left, 0) : left + 2 * half_px
    ]
    if reach_px <= 0 or min(looks.shape) < 3:
      return False
    far_px = reach_px + half_px
    low = np.maximum(np.rint(self._middle_px - far_px), 0).astype(int)
    high = np.rint(self._middle_px + far_px).astype(int)
    part = self._grey[low[1] : high[1], low[0] : high[0]]
    for scale in _SCALES:
      size = tuple(max(round(scale * side), 3) for side in looks.shape[::-1])
      if size[0] > part.shape[1] or size[1] > part.shape[0]:
        continue
      other = cv2.resize(looks, size, interpolation=cv2.INTER_AREA)
      likeness = cv2.matchTemplate(part, other, cv2.TM_CCOEFF_NORMED)
      rows, columns = np.nonzero(likeness >= _ALIKE)
      places = np.stack([columns, rows], axis=1) + low + np.array(size) / 2
      if (np.hypot(*(places - self._middle_px).T) < reach_px).any():
        return True
    return False
