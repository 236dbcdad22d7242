"""Undoes what happens to a whole picture: a camera that sways, or light.

A background is learned once; a picture in which everything has moved a little,
or become brighter, is brought back to it. Four numbers say how: a shift along
x and y, a gain and an offset, found by least squares (Lucas and Kanade 1981,
with gain and offset) at the reference's edges, but for those that do not fit,
which is where something moves.
"""

import cv2
import numpy as np

from waggle_tasks.agents import difference

_SOFT_PX = 5  # Pictures are averaged over this side, which widens edges.
_EDGE_CELL_PX = 16  # In each cell of this side the steepest pixel is used...
_STEEP = 2.0  # ...of so many grey levels per pixel...
_USUAL = 8.0  # ...and so many times the usual; fewer of them...
_FEWEST = 24  # ...than this tell nothing of shifts.
_TARGET_PX = 160  # Side of the square, in the middle, that may move by itself.
_LEVEL_CELL_PX = 64  # And one in each cell of this side, of light.
_STEPS = 5  # Of Gauss and Newton, at most.
_ENOUGH_PX = 0.02  # A smaller step is the last one.
_OUTLIER = 4.0  # So many medians of all residuals...
_OUTLIER_LEVELS = 3.0  # ...and at least so many grey levels do not fit.
_MIN_FIT = 0.5  # Share of pixels that must fit.
_MIN_RANGE = 8.0  # Grey levels; a reference of fewer tells nothing.
_GAINS = (0.25, 4.0)
# Less is left alone, and what noise would do with so many deviations.
_STILL_PX, _STILL_LEVELS, _SIGMAS = 0.1, 1.0, 6.0
_REST_PX = 0.03  # A camera that swayed is at rest within this.
_NOTHING = np.array([0.0, 0.0, 1.0, 0.0])  # x, y, gain, offset.


class Alignment:
  """Brings images of one scene to the first of them.

  Attributes:
    moving: Whether the last image had to be shifted.
  """

  def __init__(self, image: np.ndarray) -> None:
    """Begins with the reference, (H, W, 3) uint8 RGB or (H, W) grey."""
    self._reference = difference.grey(image)
    soft = _soften(self._reference)
    rows, columns, self._shifts = _telling(soft)
    self._places_px = np.stack([columns, rows]).astype(np.float32)  # (2, K)
    self._index = rows * soft.shape[1] + columns  # (K,)
    self._sharp = self._reference[rows, columns].astype(float)
    levels = soft[rows, columns].astype(float)
    slopes = [each[rows, columns] for each in difference.slopes(soft)]
    shifts = self._shifts * np.array(slopes, float)
    # What changes at each pixel with each of the four numbers: (4, K).
    self._table = np.stack([*-shifts, levels, np.ones_like(levels)])
    self._inverse = np.linalg.pinv(self._table.T)  # (4, K)
    # Deviation of a shift for that of the pixels.
    self._spread = np.linalg.norm(self._inverse[:2], axis=1).max()
    self._useful = np.ptp(levels) > _MIN_RANGE
    self._fit = _NOTHING
    self._sways = self.moving = False

  def step(self, image: np.ndarray) -> np.ndarray | None:
    """Takes an image of the same scene, (H, W, 3) uint8 RGB.

    Returns:
      The same where nothing has happened to it as a whole; otherwise (H, W)
      uint8 grey like the reference; None when it is another picture.
    """
    self.moving = False
    rested = self._fit is _NOTHING
    if not self._useful or (rested and self._as_it_was(image)):
      return image
    grey = difference.grey(image)
    fit, share, limit = self._solve(_soften(grey))
    if share < _MIN_FIT or not _GAINS[0] < fit[2] < _GAINS[1]:
      self._fit = _NOTHING
      return None
    shift_px = np.abs(fit[:2]).max()
    still_px = self._still_px(limit)
    self._sways |= bool(shift_px > still_px)
    if shift_px < (_REST_PX if self._sways else still_px):
      fit[:2] = 0.0
    light = (fit[2] - 1) * self._sharp + fit[3]
    still = not fit[:2].any() and _small(light)
    self._fit = _NOTHING if still else fit
    return self._undo(grey)

  def _as_it_was(self, image: np.ndarray) -> bool:
    """Whether a first guess, which is quick, finds nothing to undo."""
    seen = cv2.cvtColor(
      image.reshape(-1, 1, 3)[self._index], cv2.COLOR_RGB2GRAY
    )
    change = seen.ravel() - self._sharp
    limit = _outlier(change)
    guess = self._inverse @ np.clip(change, -limit, limit)
    light = guess[2] * self._sharp + guess[3]
    still = np.abs(guess[:2]).max() < self._still_px(limit)
    return bool(still and _small(light))

  def _still_px(self, limit: float) -> float:
    """The largest shift that may be none, by the limit of outliers."""
    return max(_STILL_PX, _SIGMAS * limit / _OUTLIER * self._spread)

  def _solve(self, soft: np.ndarray) -> tuple[np.ndarray, float, float]:
    """How an image differs, (4,).

    Also the share of pixels that it fits, and the limit of those that do not.
    """
    fit, table = self._fit.copy(), self._table.copy()
    for _ in range(_STEPS):
      places = self._places_px + fit[:2, None].astype(np.float32)
      seen = cv2.remap(soft, *places, cv2.INTER_LINEAR).ravel()
      residual = seen - fit[2:] @ self._table[2:]
      limit = _outlier(residual)
      fits = np.abs(residual) <= limit
      table[:2] = fit[2] * self._table[:2]
      step = np.linalg.lstsq(table[:, fits].T, residual[fits], rcond=1e-6)[0]
      fit += step
      if np.abs(step[:2]).max() < _ENOUGH_PX:
        break
    return fit, float(fits.mean()), limit

  def _undo(self, grey: np.ndarray) -> np.ndarray:
    x, y, gain, offset = self._fit
    if gain != 1 or offset:
      levels = (np.arange(256) - offset) / gain
      grey = cv2.LUT(grey, np.clip(np.rint(levels), 0, 255).astype(np.uint8))
    self.moving = bool(x or y)
    return _shifted(grey, x, y, self._reference) if self.moving else grey


def _outlier(residual: np.ndarray) -> float:  # (K,)
  """Larger ones do not belong to the rest."""
  return max(_OUTLIER * float(np.median(np.abs(residual))), _OUTLIER_LEVELS)


def _small(light: np.ndarray) -> bool:  # (K,)
  """Whether a change of light is small, in grey levels."""
  return bool(np.abs(light).mean() < _STILL_LEVELS)


def _soften(grey: np.ndarray) -> np.ndarray:
  return cv2.blur(grey, (_SOFT_PX, _SOFT_PX))


def _telling(soft: np.ndarray) -> tuple[np.ndarray, np.ndarray, bool]:
  """Rows and columns of pixels that tell, and whether they tell of shifts."""
  slopes = [np.abs(each) for each in difference.slopes(soft)]
  edges = np.concatenate([_largest(each, _EDGE_CELL_PX) for each in slopes], 1)
  steepness = np.maximum(*slopes)
  usual = float(np.median(steepness))  # That of noise; few pixels are edges.
  steep = steepness[*edges] > max(_STEEP, _USUAL * usual)
  first, step = _LEVEL_CELL_PX // 2, _LEVEL_CELL_PX
  height, width = soft.shape
  levels = np.mgrid[first:height:step, first:width:step].reshape(2, -1)
  middle_px = np.array(soft.shape)[:, None] / 2
  steep &= (np.abs(edges - middle_px) > _TARGET_PX / 2).any(axis=0)
  rows, columns = np.concatenate([edges[:, steep], levels], 1)
  return rows, columns, bool(np.count_nonzero(steep) >= _FEWEST)


def _largest(values: np.ndarray, side: int) -> np.ndarray:  # (H, W)
  """Row and column, (2, K), of the largest value in each cell."""
  height, width = (length // side for length in values.shape)
  cells = values[: height * side, : width * side]
  cells = cells.reshape(height, side, width, side).swapaxes(1, 2)
  row, column = np.divmod(cells.reshape(height, width, -1).argmax(-1), side)
  rows = row + side * np.arange(height)[:, None]
  columns = column + side * np.arange(width)
  return np.stack([rows.ravel(), columns.ravel()])


def _shifted(
  grey: np.ndarray, x: float, y: float, outside: np.ndarray
) -> np.ndarray:
  """The image (H, W) with its content moved by -x, -y pixels, bilinearly.

  Args:
    grey: (H, W) uint8.
    x: To the right.
    y: Down.
    outside: (H, W) uint8, where nothing of the image comes to be.
  """
  left, top = int(np.floor(x)), int(np.floor(y))
  across, down = x - left, y - top
  mix = cv2.addWeighted(grey[:, :-1], 1 - across, grey[:, 1:], across, 0)
  mix = cv2.addWeighted(mix[:-1], 1 - down, mix[1:], down, 0)
  out = outside.copy()
  height, width = mix.shape
  to_rows = slice(max(-top, 0), height + min(-top, 0))
  to_columns = slice(max(-left, 0), width + min(-left, 0))
  rows = slice(max(top, 0), height + min(top, 0))
  columns = slice(max(left, 0), width + min(left, 0))
  out[to_rows, to_columns] = mix[rows, columns]
  return out
