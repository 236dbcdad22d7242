"""Undoes light that changes in a part of a picture: shadows, lamps, colour.

A part of a picture is compared with what is behind the target in it, in cells.
Where most cells have become brighter or darker, a gain that is a plane over the
part, and an offset, explain it, found by least squares without the cells that
do not fit, which is where the target is. What they leave unexplained, such as
the edge of a shadow, is told as well, so that it is taken for no target.
"""

import math

import cv2
import numpy as np

_CELLS = 12  # Along the shorter side.
_LEAST_PX = 4  # Side of a cell.
_LEVELS = 1.0  # Changes of less are left alone, in grey levels.
_STEPS = 3  # Of least squares, each without the outliers of the last.
_OUTLIER = 3.0  # Times the median of all residuals.
_UNEXPLAINED = 0.9  # Share of the cells that fit; the rest may be more...
_TIMES = 3.0  # ...and pixels this much more than the cells that they make.


def lit(
  background: np.ndarray,  # (h, w) uint8
  grey: np.ndarray,  # (h, w) uint8
  noise: float,
) -> tuple[np.ndarray, int]:
  """What is behind a target, in the light of another picture.

  Args:
    background: What was behind it.
    grey: The other picture.
    noise: Standard deviation of a pixel's noise, in grey levels.

  Returns:
    (h, w) uint8, the background itself where light is as it was; and how many
    grey levels of difference light may still make.
  """
  cell_px = max(min(grey.shape) // _CELLS, _LEAST_PX)
  size = tuple(max(length // cell_px, 1) for length in grey.shape[::-1])
  now, was = (
    cv2.resize(each, size, interpolation=cv2.INTER_AREA)
    for each in (grey, background)
  )
  change = cv2.subtract(now, was, dtype=cv2.CV_32F)
  ranked = np.sort(change, axis=None)
  quarter = len(ranked) // 4
  limit = _LEVELS + noise / cell_px
  if max(-ranked[quarter], ranked[-1 - quarter]) < limit:
    return background, 0
  gain, offset, unexplained = _fit(change, was, limit)
  rows, columns = (
    np.linspace(-1.0, 1.0, length, dtype=np.float32) for length in grey.shape
  )
  factor = (1 + gain[0] + gain[1] * columns) + (gain[2] * rows)[:, None]
  bright = cv2.multiply(background, factor, dtype=cv2.CV_32F)
  levels = np.clip(np.rint(bright + offset), 0, 255).astype(np.uint8)
  return levels, unexplained


def _fit(
  change: np.ndarray,  # (n, m) float32
  was: np.ndarray,  # (n, m) uint8
  limit: float,
) -> tuple[np.ndarray, float, int]:
  """The gain's plane (3,), the offset, and the levels that they leave."""
  rows, columns = (
    (np.arange(length) + 0.5) * 2 / length - 1 for length in change.shape
  )
  level = was.astype(float)
  table = np.stack(
    [level, level * columns, level * rows[:, None], np.full_like(level, 64.0)],
    axis=-1,
  ).reshape(-1, 4)
  wanted = change.ravel().astype(float)
  residual = wanted - np.median(wanted)
  for _ in range(_STEPS):
    most = max(_OUTLIER * np.median(np.abs(residual)), limit)
    fits = np.abs(residual) <= most
    # Weak ridge: a part without contrast tells gain from offset in no way.
    known = table[fits]
    square = known.T @ known + np.diag([1.0, 1e3, 1e3, 1e3])
    numbers = np.linalg.solve(square, known.T @ wanted[fits])
    residual = wanted - table @ numbers
  left = np.sort(np.abs(residual[fits]))
  rest = float(left[int(_UNEXPLAINED * (len(left) - 1))])
  unexplained = math.ceil(_TIMES * rest) if rest > limit / 2 else 0
  return numbers[:3], 64.0 * numbers[3], unexplained
