"""Undoes light that changes in a part of a picture: shadows, lamps, colour.

A part of a picture is compared with what is behind the target in it, in cells.
Where most cells have become brighter or darker, a gain that is a plane over the
part, and an offset, explain it, found by least squares without the cells that
do not fit, which is where the target is. Where that leaves much, as at the edge
of a shadow, the light goes on through the part as it comes in at its border. In
a part that is wide beside a target each cell goes with most of those around it.
What is left unexplained is told as well, so that it is taken for no target.
"""

import math

import cv2
import numpy as np

from waggle_tasks.agents import medians

_CELLS = 12  # Along the shorter side.
_LEAST_PX = 4  # Side of a cell.
_NEAR = 5  # Cells along a square that are near each other.
_ROUGH_PX = 20  # Side of a cell of a whole picture...
_MOST = 0.5  # ...and by how much it may become brighter or darker.
_LEVELS = 1.0  # Changes of less are left alone, in grey levels.
_STEPS = 3  # Of least squares, each without the outliers of the last.
_OUTLIER = 3.0  # Times the median of all residuals.
_UNEXPLAINED = 0.9  # Share of the cells that fit; the rest may be more...
_TIMES = 3.0  # ...and pixels this much more than the cells that they make.


def lit(
  background: np.ndarray,  # (h, w) uint8
  grey: np.ndarray,  # (h, w) uint8
  noise: float,
  wide: bool = False,
) -> tuple[np.ndarray, int]:
  """What is behind a target, in the light of another picture.

  Args:
    background: What was behind it.
    grey: The other picture.
    noise: Standard deviation of a pixel's noise, in grey levels.
    wide: Whether a target covers little of it.

  Returns:
    (h, w) uint8, the background itself where light is as it was; and how many
    grey levels of difference light may still make.
  """
  cell_px = max(min(grey.shape) // _CELLS, _LEAST_PX)
  if _same(background, grey, cell_px, _LEVELS + noise):
    return background, 0
  size = tuple(max(length // cell_px, 1) for length in grey.shape[::-1])
  if wide:
    return _nearby(background, grey, size)
  now, was = _cells(grey, size), _cells(background, size)
  change = cv2.subtract(now, was, dtype=cv2.CV_32F)
  limit = _LEVELS + noise / cell_px
  gain, offset, unexplained = _fit(change, was, limit)
  if unexplained:
    through, left = _through(change, was)
    if (levels := _unexplained(left, limit)) < unexplained:
      factor = cv2.resize(1 + through, background.shape[::-1])
      return cv2.multiply(background, factor, dtype=cv2.CV_8U), levels
  rows, columns = (
    np.linspace(-1.0, 1.0, length, dtype=np.float32) for length in grey.shape
  )
  factor = (1 + gain[0] + gain[1] * columns) + (gain[2] * rows)[:, None]
  bright = cv2.multiply(background, factor, dtype=cv2.CV_32F)
  levels = np.clip(np.rint(bright + offset), 0, 255).astype(np.uint8)
  return levels, unexplained


def _same(
  background: np.ndarray, grey: np.ndarray, step_px: int, limit: float
) -> bool:
  """Whether light is as it was, by one pixel of each cell: a quick look."""
  grid = slice(step_px // 2, None, step_px), slice(step_px // 2, None, step_px)
  ranked = np.sort(grey[grid].astype(np.int16) - background[grid], axis=None)
  quarter = len(ranked) // 4
  return bool(max(-ranked[quarter], ranked[-1 - quarter]) <= limit)


def _cells(grey: np.ndarray, size: tuple[int, int]) -> np.ndarray:
  """Means (rows, columns) uint8 of a part in so many columns and rows."""
  return cv2.resize(grey, size, interpolation=cv2.INTER_AREA)


def evened(
  background: np.ndarray,  # (H, W) uint8
  grey: np.ndarray,  # (H, W) uint8
) -> np.ndarray | None:
  """A whole picture in the light of another one, (H, W) uint8, roughly.

  Returns:
    None where light has changed by more than it does in a room.
  """
  size = tuple(max(length // _ROUGH_PX, 1) for length in grey.shape[::-1])
  gain = _gain(_cells(background, size), _cells(grey, size))
  if np.abs(gain).max() > _MOST:
    return None
  factor = cv2.resize(1 / (1 + gain), grey.shape[::-1])
  return cv2.multiply(grey, factor, dtype=cv2.CV_8U)


def _gain(was: np.ndarray, now: np.ndarray) -> np.ndarray:
  """By how much most cells near each (n, m) have become brighter, float32."""
  usual = np.maximum(was.astype(np.float32), 1)
  return cv2.medianBlur((now - usual) / usual, _NEAR)


def _nearby(
  background: np.ndarray, grey: np.ndarray, size: tuple[int, int]
) -> tuple[np.ndarray, int]:
  """The background with each cell as much brighter as most of those near it."""
  was, now = _cells(background, size), _cells(grey, size)
  gain = _gain(was, now)
  left = np.sort(np.abs(now - (1 + gain) * was), axis=None)
  rest = float(left[int(_UNEXPLAINED * (len(left) - 1))])
  factor = cv2.resize(1 + gain, background.shape[::-1])
  return cv2.multiply(background, factor, dtype=cv2.CV_8U), int(_TIMES * rest)


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
  residual = wanted - medians.of(wanted)
  for _ in range(_STEPS):
    most = max(_OUTLIER * medians.of(np.abs(residual)), limit)
    fits = np.abs(residual) <= most
    # Weak ridge: a part without contrast tells gain from offset in no way.
    known = table[fits]
    square = known.T @ known + np.diag([1.0, 1e3, 1e3, 1e3])
    numbers = np.linalg.solve(square, known.T @ wanted[fits])
    residual = wanted - table @ numbers
  unexplained = _unexplained(residual[fits], limit)
  return numbers[:3], 64.0 * numbers[3], unexplained


def _unexplained(residual: np.ndarray, limit: float) -> int:
  """The grey levels that light may still make, by what cells leave."""
  left = np.sort(np.abs(residual), axis=None)
  rest = float(left[int(_UNEXPLAINED * (len(left) - 1))])
  return math.ceil(_TIMES * rest) if rest > limit / 2 else 0


def _through(
  change: np.ndarray,  # (n, m) float32
  was: np.ndarray,  # (n, m) uint8
) -> tuple[np.ndarray, np.ndarray]:
  """The gain (n, m) float32 of a part by its border's, and what that leaves.

  The patch of Coons (1967): along each side it is the border's.
  """
  gain = change / np.maximum(was, 1)
  down, across = (np.linspace(0, 1, length) for length in gain.shape)
  down = down[:, None]
  patch = (1 - down) * gain[0] + down * gain[-1]
  patch += (1 - across) * gain[:, :1] + across * gain[:, -1:]
  patch -= (1 - down) * ((1 - across) * gain[0, 0] + across * gain[0, -1])
  patch -= down * ((1 - across) * gain[-1, 0] + across * gain[-1, -1])
  through = patch.astype(np.float32)
  return through, change - through * was
