"""Rectangles of a picture: left, top, right and bottom edge in pixels."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
import functools
from typing import TypeVar

import numpy as np

# The twelve edges of a box whose corners count through the signs of x, y, z.
_EDGES = np.array(
  [(a, a | bit) for bit in (1, 2, 4) for a in range(8) if not a & bit]
)
# Left, top, right, bottom; the last pixel begins a pixel before its end.
_MARGINS_PX = np.array([-1, -1, 2, 2])

Window = tuple[int, int, int, int]
Name = TypeVar('Name', bound=Hashable)


def touch(a: Sequence[int], b: Sequence[int]) -> bool:
  """Whether two windows share a pixel; an empty one shares none."""
  return (
    max(a[0], b[0]) < min(a[2], b[2]) and max(a[1], b[1]) < min(a[3], b[3])
  )  # fmt: skip


def slices(window: Window) -> tuple[slice, slice]:
  """The rows and columns of a window."""
  left, top, right, bottom = window
  return slice(top, bottom), slice(left, right)


def touching(window: Window, boxes: np.ndarray) -> np.ndarray:
  """Which of (M, 4) boxes share a pixel with a window, (M,) bool."""
  first = np.maximum(boxes[:, :2], window[:2])
  last = np.minimum(boxes[:, 2:], window[2:])
  return (first < last).all(axis=1)


def size(window: Window) -> tuple[int, int]:
  """Width and height of a window."""
  left, top, right, bottom = window
  return right - left, bottom - top


def merge(
  boxes: Mapping[Name, Sequence[int]],
) -> dict[Window, frozenset[Name]]:
  """Disjoint windows that hold boxes, which are merged where they overlap.

  Args:
    boxes: A window for each name; empty ones are left out.

  Returns:
    The names that each window holds.
  """
  out: dict[Window, frozenset[Name]] = {}
  for name, box in boxes.items():
    left, top, right, bottom = map(int, box)
    window, names = (left, top, right, bottom), frozenset([name])
    if not touch(window, window):
      continue
    while near := [other for other in out if touch(other, window)]:
      names |= out.pop(near[0])
      window = _union(window, near[0])
    out[window] = names
  return out


def around_all(several: Iterable[Window]) -> Window:
  """The window around several; an empty one around none."""
  parts = [each for each in several if touch(each, each)]
  return functools.reduce(_union, parts) if parts else (0, 0, 0, 0)


def shifted(window: Window, right_px: int, down_px: int) -> Window:
  """A window as counted from elsewhere."""
  left, top, right, bottom = window
  return left + right_px, top + down_px, right + right_px, bottom + down_px


def _union(a: Window, b: Window) -> Window:
  return min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])


def around(
  corners_m: np.ndarray, near_m: float, focal_px: float, size: tuple[int, int]
) -> np.ndarray:
  """Windows that hold boxes seen by a camera in the middle of a picture.

  A box that reaches behind the near plane is cut off there.

  Args:
    corners_m: (K, 8, 3) in the camera's frame: x right, y up, looking along
      -z; corners in the order of `rigid.Part`.
    near_m: Distance of the near plane.
    focal_px: Focal length.
    size: Width and height of the picture.

  Returns:
    (K, 4) int; empty windows for boxes out of view.
  """
  depth = -corners_m[..., 2]  # (K, 8)
  if (depth > near_m).all():  # The usual case, and the fast one.
    places = corners_m[..., :2] * (focal_px, -focal_px)
    places /= depth[..., None]
    places += (size[0] / 2, size[1] / 2)  # (K, 8, 2)
    low, high = places.min(axis=1), places.max(axis=1)
    return _edges(low, high, size)
  begin, end = corners_m[:, _EDGES[:, 0]], corners_m[:, _EDGES[:, 1]]
  depth_begin, depth_end = -begin[..., 2], -end[..., 2]  # (K, 12)
  cut = (depth_begin > near_m) != (depth_end > near_m)
  share = (near_m - depth_begin) / np.where(cut, depth_end - depth_begin, 1.0)
  cuts = begin + share[..., None] * (end - begin)
  points = np.concatenate([corners_m, cuts], axis=1)  # (K, 20, 3)
  seen = np.concatenate([-corners_m[..., 2] > near_m, cut], axis=1)
  depth = np.where(seen, -points[..., 2], 1.0)
  places = points[..., :2] * (focal_px, -focal_px) / depth[..., None]
  places += np.array(size) / 2  # (K, 20, 2)
  low = np.where(seen[..., None], places, np.inf).min(axis=1)
  high = np.where(seen[..., None], places, -np.inf).max(axis=1)
  return _edges(low, high, size)


def _edges(
  low_px: np.ndarray, high_px: np.ndarray, size: tuple[int, int]
) -> np.ndarray:  # (K, 4)
  """Windows around boxes from `low_px` to `high_px`, (K, 2) each."""
  edges = np.concatenate([low_px, high_px], axis=1)
  edges += _MARGINS_PX
  np.floor(edges, out=edges)
  np.maximum(edges, 0, out=edges)
  np.minimum(edges, (*size, *size), out=edges)
  return edges.astype(int)
