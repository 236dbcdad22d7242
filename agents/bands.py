"""Undoes bands of light: lamps flicker while a camera exposes row after row."""

import cv2
import numpy as np

_COLUMNS, _ROW_PX = 16, 4  # Cells across a picture, and the height of one.
_SMOOTH = 5  # Cells; bands are wider, and edges of a room are not.
_LEAST = 0.7  # Grey levels; weaker bands are left.
_MOST = 0.35  # A row whose gain is farther from 1 is of another picture.


class Bands:
  """Brings the rows of pictures to the light of a reference."""

  def __init__(self, reference: np.ndarray) -> None:
    """Begins with a reference, (H, W) uint8."""
    self._size = _COLUMNS, max(len(reference) // _ROW_PX, 1)
    self._was = np.maximum(self._cells(reference), 1)

  def _cells(self, grey: np.ndarray) -> np.ndarray:
    cells = cv2.resize(grey, self._size, interpolation=cv2.INTER_AREA)
    return cells.astype(np.float32)

  def undo(self, grey: np.ndarray) -> np.ndarray:
    """A picture (H, W) uint8 in which each row is lit as all of it is.

    A row's gain is that of most cells of it, so a target changes nothing. What
    one gain and one offset of the whole picture explain is left.
    """
    cells = self._cells(grey)
    usual = np.maximum(self._relit(cells), 1)
    gain = np.median(cells / usual, axis=1).astype(np.float32)
    gain = cv2.medianBlur(gain[:, None], _SMOOTH)
    gain = cv2.blur(gain, (1, _SMOOTH), borderType=cv2.BORDER_REPLICATE)
    levels = np.abs(gain[:, 0] - 1) * usual.mean(axis=1)
    if levels.max() < _LEAST or np.abs(gain - 1).max() > _MOST:
      return grey
    factor = cv2.resize(1 / gain, (1, len(grey)))
    factor = np.broadcast_to(factor, grey.shape)
    return cv2.multiply(grey, factor, dtype=cv2.CV_8U)

  def _relit(self, cells: np.ndarray) -> np.ndarray:
    """The reference's cells in the light of the whole picture."""
    was, now = self._was - self._was.mean(), cells - cells.mean()
    for _ in range(2):  # The second time without what does not fit.
      slope = float((was * now).sum() / max(float((was * was).sum()), 1.0))
      off = np.abs(now - slope * was)
      now = np.where(off <= 3 * np.median(off) + 1, now, slope * was)
    return cells.mean() + slope * was
