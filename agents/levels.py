"""Finds how a picture has moved and how its light has changed, at one scale.

Gauss and Newton's method at the edges of a reference, but for those that do
not fit, which is where something moves (Lucas and Kanade 1981, with a gain and
an offset).
"""

import dataclasses
import math

import cv2
import numpy as np

from waggle_tasks.agents import difference, medians, turns

_STEEP = 2.0  # Edges are of so many grey levels per pixel...
_USUAL = 8.0  # ...and so many times the usual.
_STEPS = 5  # At most.
_ENOUGH_PX = 0.02  # A smaller step is the last one.
_OUTLIER = 4.0  # So many medians of all residuals...
_OUTLIER_LEVELS = 3.0  # ...and at least so many grey levels do not fit.
_EXPLAINED = 0.5  # Of the range of levels; what is nearer than this fits.
_LEAST_SEEN = 0.25  # Of all pixels that are compared; fewer tell nothing.
_EDGE_PX = 0.5  # What is farther out of a picture is not seen.


@dataclasses.dataclass(frozen=True)
class Edges:
  """Which pixels tell of shifts.

  Attributes:
    cell_px: The steepest in each cell of this side.
    spared_px: None in a square of this side in the middle.
    fewest: Fewer tell nothing.
    grid: Along each side, more pixels that tell of light.
  """

  cell_px: int
  spared_px: int
  fewest: int
  grid: int


class Level:
  """Compares pictures with a reference.

  Attributes:
    tells_shifts: Whether there are enough edges to know where it is.
    places: (2, K) rows and columns of the pixels that are compared.
    levels: (K,) their grey levels.
    inverse: (n, K) what a change of each of them says of each number.
  """

  def __init__(
    self, soft: np.ndarray, geometry: turns.Geometry, edges: Edges
  ) -> None:
    """Begins with the reference.

    Args:
      soft: (H, W) uint8.
      geometry: How it may move.
      edges: Where to look.
    """
    self._geometry = geometry
    rows, columns, self.tells_shifts = _telling(soft, edges)
    self.places = np.stack([rows, columns])
    self._places_px = np.stack([columns, rows]).astype(np.float32)
    self.levels = soft[rows, columns].astype(float)
    slopes = np.array([each[rows, columns] for each in difference.slopes(soft)])
    flow = geometry.flow(self._places_px)
    motions = self.tells_shifts * (flow * slopes).sum(axis=1)
    # What changes at each pixel with each of the numbers: (n, K).
    self._table = np.stack([*-motions, self.levels, np.ones_like(self.levels)])
    self.inverse = np.linalg.pinv(self._table.T)
    self._range = float(np.abs(self.levels - self.levels.mean()).mean())

  def solve(
    self, soft: np.ndarray, start: np.ndarray
  ) -> tuple[np.ndarray, float, float]:
    """How a picture differs, (n,): motions in pixels, a gain and an offset.

    Args:
      soft: (H, W) uint8.
      start: (n,) about how it may differ.

    Returns:
      Also the share of pixels that it fits, and the scatter of residuals.
    """
    fit, table = start.copy(), self._table.copy()
    for _ in range(_STEPS):
      residual, seen = self._residual(soft, fit)
      if seen.mean() < _LEAST_SEEN:
        return fit, 0.0, math.inf
      fits = seen & (np.abs(residual) <= outlier(scatter(residual[seen])))
      table[:-2] = fit[-2] * self._table[:-2]
      step = np.linalg.lstsq(table[:, fits].T, residual[fits], rcond=1e-6)[0]
      fit += step
      if np.abs(step[:-2]).max() < _ENOUGH_PX:
        break
    residual, seen = self._residual(soft, fit)
    if seen.mean() < _LEAST_SEEN:
      return fit, 0.0, math.inf
    residual = residual[seen]
    explained = np.abs(residual) < _EXPLAINED * fit[-2] * self._range
    return fit, float(explained.mean()), scatter(residual)

  def _residual(
    self, soft: np.ndarray, fit: np.ndarray
  ) -> tuple[np.ndarray, np.ndarray]:
    """What an image has more than the reference brought to it, (K,).

    Returns:
      Also which pixels are in the image, (K,).
    """
    places = self._geometry.moved(self._places_px, fit[:-2])
    outer_px = np.array(soft.shape[::-1])[:, None] - 1 + _EDGE_PX
    inside = (places >= -_EDGE_PX) & (places <= outer_px)  # (2, K)
    levels = cv2.remap(soft, *places, cv2.INTER_LINEAR).ravel()
    return levels - fit[-2:] @ self._table[-2:], np.all(inside, axis=0)


def scatter(residual: np.ndarray) -> float:  # (K,)
  """The median deviation from zero, which the few that do not fit leave."""
  return float(medians.of(np.abs(residual)))


def outlier(scatter: float) -> float:
  """Residuals that are larger do not belong to the rest."""
  return max(_OUTLIER * scatter, _OUTLIER_LEVELS)


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
