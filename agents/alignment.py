"""Undoes what happens to a whole picture: a camera that sways, or light.

A background is learned once; a picture in which everything has moved a little,
or become brighter, is brought back to it. A few numbers say how: how its camera
has turned, see `turns`, a gain and an offset, found by least squares (Lucas and
Kanade 1981, with gain and offset) at the reference's edges, but for those that
do not fit, which is where something moves.
"""

import dataclasses

import cv2
import numpy as np

from waggle_tasks.agents import bands, difference, turns

_STEEP = 2.0  # Edges are of so many grey levels per pixel...
_USUAL = 8.0  # ...and so many times the usual.
_STEPS = 5  # Of Gauss and Newton, at most.
_ENOUGH_PX = 0.02  # A smaller step is the last one.
_OUTLIER = 4.0  # So many medians of all residuals...
_OUTLIER_LEVELS = 3.0  # ...and at least so many grey levels do not fit.
_EXPLAINED = 0.5  # Of the range of levels; what is nearer than this fits.
_MIN_FIT = 0.5  # Share of pixels that must.
_MIN_RANGE = 8.0  # Grey levels; a reference of fewer tells nothing.
_GAINS = (0.25, 4.0)
_STILL_PX, _STILL_LEVELS = 0.1, 1.0  # Less is left alone...
# ...and what so many median deviations do; a wrong guess costs time alone.
_DEVIATIONS, _GUESS_DEVIATIONS = 20.0, 6.0
_REST_PX = 0.03  # A camera that swayed is at rest within this.


@dataclasses.dataclass(frozen=True)
class Edges:
  """Which pixels tell of shifts.

  Attributes:
    cell_px: The steepest in each cell of this side.
    spared_px: None in a square of this side in the middle.
    fewest: Fewer tell nothing.
    grid: Along each side, more pixels that tell of light.
    settles: Whether a shift that may be none is none.
    banded: Whether rows may be brighter by themselves.
  """

  cell_px: int
  spared_px: int
  fewest: int
  grid: int
  settles: bool
  banded: bool


# All but the target, which may move by itself.
ROOM = Edges(16, 160, 24, 8, True, True)
# Of a picture of little else.
TARGET = Edges(4, 0, 8, 2, False, False)


class Alignment:
  """Brings images of one scene to the first of them.

  Attributes:
    tells_shifts: Whether there are enough edges to know where it is.
    moving: Whether the last image had to be shifted.
  """

  def __init__(
    self, image: np.ndarray, geometry: turns.Geometry, edges: Edges = ROOM
  ) -> None:
    """Begins with the reference.

    Args:
      image: (H, W, 3) uint8 RGB or (H, W) grey.
      geometry: How it may move.
      edges: Where to look.
    """
    self._geometry, self._settles = geometry, edges.settles
    self._nothing = np.array([*np.zeros(geometry.count), 1.0, 0.0])
    self._reference = difference.grey(image)
    soft = difference.soften(self._reference)
    rows, columns, self.tells_shifts = _telling(soft, edges)
    self._places_px = np.stack([columns, rows]).astype(np.float32)  # (2, K)
    self._index = rows * soft.shape[1] + columns  # (K,)
    self._sharp = self._reference[rows, columns].astype(float)
    levels = soft[rows, columns].astype(float)
    slopes = np.array([each[rows, columns] for each in difference.slopes(soft)])
    flow = geometry.flow(self._places_px)
    motions = self.tells_shifts * (flow * slopes).sum(axis=1)
    # What changes at each pixel with each of the numbers: (n, K).
    self._table = np.stack([*-motions, levels, np.ones_like(levels)])
    self._inverse = np.linalg.pinv(self._table.T)  # (n, K)
    # Deviation of each motion for that of the pixels.
    self._spread = np.linalg.norm(self._inverse[:-2], axis=1)
    self._range = float(np.abs(levels - levels.mean()).mean())
    self._useful = np.ptp(levels) > _MIN_RANGE
    self._fit = self._last = self._nothing
    self._banded = edges.banded
    self._bands = bands.Bands(self._reference)
    self._sways = self.moving = False

  @property
  def shift_px(self) -> np.ndarray:
    """How far the last image was shifted, (2,) along x and y."""
    return self._fit[:2]

  def step(self, image: np.ndarray) -> np.ndarray | None:
    """Takes an image of the same scene, (H, W, 3) uint8 RGB or (H, W) grey.

    Returns:
      The same where nothing has happened to it as a whole; otherwise (H, W)
      uint8 grey like the reference; None when it is another picture.
    """
    self.moving = False
    if not self._useful:
      return image
    change = self._change(image)
    if self._banded and not self._sways and _scatter(change) >= _STILL_LEVELS:
      image = self._bands.undo(difference.grey(image))
      change = self._change(image)
    if self._fit is self._nothing and self._as_it_was(change):
      return image
    grey = difference.grey(image)
    return self._undo(grey) if self._find(grey) else None

  def _find(self, grey: np.ndarray) -> bool:
    """Finds what happened to an image, (H, W) uint8, of the same scene.

    Returns:
      Whether it is one.
    """
    soft = difference.soften(grey)
    # From where it was last, or else from where it was first.
    for start in (self._last, self._nothing):
      fit, share, scatter = self._solve(soft, start)
      if share >= _MIN_FIT and _GAINS[0] < fit[-2] < _GAINS[1]:
        break
      if start is self._nothing:
        self._fit = self._nothing
        return False
    motion_px = np.abs(fit[:-2])
    still_px = self._still_px(_DEVIATIONS * scatter)
    self._sways |= bool((motion_px > still_px).any())
    if (motion_px < (_REST_PX if self._sways else still_px)).all():
      fit[:-2] = 0.0
    light = (fit[-2] - 1) * self._sharp + fit[-1]
    still = not fit[:-2].any() and _small(light)
    self._fit = self._last = self._nothing if still else fit
    return True

  def _change(self, image: np.ndarray) -> np.ndarray:
    """What an image has more than the reference, (K,), where pixels tell."""
    in_a_row = image.reshape(1, self._reference.size, *image.shape[2:])
    return difference.grey(in_a_row[:, self._index])[0] - self._sharp

  def _as_it_was(self, change: np.ndarray) -> bool:  # (K,)
    """Whether a first guess, which is quick, finds nothing to undo."""
    scatter = _scatter(change)
    limit = _outlier(scatter)
    guess = self._inverse @ np.clip(change, -limit, limit)
    light = guess[-2] * self._sharp + guess[-1]
    still_px = self._still_px(_GUESS_DEVIATIONS * scatter)
    still = (np.abs(guess[:-2]) < still_px).all()
    return bool(still and _small(light))

  def _still_px(self, levels: float) -> np.ndarray:
    """The largest motions that pixels wrong by so many levels may feign."""
    if not self._settles:
      return np.zeros_like(self._spread)
    return np.maximum(_STILL_PX, levels * self._spread)

  def _solve(
    self, soft: np.ndarray, start: np.ndarray
  ) -> tuple[np.ndarray, float, float]:
    """How an image differs, (n,), sought from a start on.

    Also the share of pixels that it fits, and the scatter of residuals.
    """
    fit, table = start.copy(), self._table.copy()
    for _ in range(_STEPS):
      residual = self._residual(soft, fit)
      fits = np.abs(residual) <= _outlier(_scatter(residual))
      table[:-2] = fit[-2] * self._table[:-2]
      step = np.linalg.lstsq(table[:, fits].T, residual[fits], rcond=1e-6)[0]
      fit += step
      if np.abs(step[:-2]).max() < _ENOUGH_PX:
        break
    residual = self._residual(soft, fit)
    explained = np.abs(residual) < _EXPLAINED * fit[-2] * self._range
    return fit, float(explained.mean()), _scatter(residual)

  def _residual(self, soft: np.ndarray, fit: np.ndarray) -> np.ndarray:
    """What an image has more than the reference brought to it, (K,)."""
    places = self._geometry.moved(self._places_px, fit[:-2])
    seen = cv2.remap(soft, *places, cv2.INTER_LINEAR).ravel()
    return seen - fit[-2:] @ self._table[-2:]

  def _undo(self, grey: np.ndarray) -> np.ndarray:
    motion, (gain, offset) = self._fit[:-2], self._fit[-2:]
    if gain != 1 or offset:
      levels = (np.arange(256) - offset) / gain
      grey = cv2.LUT(grey, np.clip(np.rint(levels), 0, 255).astype(np.uint8))
    self.moving = bool(motion.any())
    if not self.moving:
      return grey
    return self._geometry.undone(grey, motion, self._reference)


def _scatter(residual: np.ndarray) -> float:  # (K,)
  """The median deviation from zero, which the few that do not fit leave."""
  return float(np.median(np.abs(residual)))


def _outlier(scatter: float) -> float:
  """Residuals that are larger do not belong to the rest."""
  return max(_OUTLIER * scatter, _OUTLIER_LEVELS)


def _small(light: np.ndarray) -> bool:  # (K,)
  """Whether a change of light is small, in grey levels."""
  return bool(np.abs(light).mean() < _STILL_LEVELS)


def _telling(
  soft: np.ndarray, which: Edges
) -> tuple[np.ndarray, np.ndarray, bool]:
  """Rows and columns of pixels that tell, and whether they tell of shifts."""
  slopes = [np.abs(each) for each in difference.slopes(soft)]
  edges = np.concatenate([_largest(each, which.cell_px) for each in slopes], 1)
  steepness = np.maximum(*slopes)
  usual = float(np.median(steepness))  # That of noise; few pixels are edges.
  steep = steepness[*edges] > max(_STEEP, _USUAL * usual)
  step_px = min(soft.shape) // which.grid
  grid = tuple(slice(step_px // 2, length, step_px) for length in soft.shape)
  levels = np.mgrid[grid].reshape(2, -1)
  middle_px = np.array(soft.shape)[:, None] / 2
  steep &= (np.abs(edges - middle_px) > which.spared_px / 2).any(axis=0)
  rows, columns = np.concatenate([edges[:, steep], levels], 1)
  return rows, columns, bool(np.count_nonzero(steep) >= which.fewest)


def _largest(values: np.ndarray, side: int) -> np.ndarray:  # (H, W)
  """Row and column, (2, K), of the largest value in each cell."""
  height, width = (length // side for length in values.shape)
  cells = values[: height * side, : width * side]
  cells = cells.reshape(height, side, width, side).swapaxes(1, 2)
  row, column = np.divmod(cells.reshape(height, width, -1).argmax(-1), side)
  rows = row + side * np.arange(height)[:, None]
  columns = column + side * np.arange(width)
  return np.stack([rows.ravel(), columns.ravel()])
