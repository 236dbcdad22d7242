"""Rectangles of a picture: left, top, right and bottom edge in pixels."""

from collections.abc import Hashable, Mapping, Sequence

Window = tuple[int, int, int, int]


def touch(a: Sequence[int], b: Sequence[int]) -> bool:
  """Whether two windows share a pixel; an empty one shares none."""
  return (
    max(a[0], b[0]) < min(a[2], b[2]) and max(a[1], b[1]) < min(a[3], b[3])
  )  # fmt: skip


def slices(window: Window) -> tuple[slice, slice]:
  """The rows and columns of a window."""
  left, top, right, bottom = window
  return slice(top, bottom), slice(left, right)


def merge(
  boxes: Mapping[Hashable, Sequence[int]],
) -> dict[Window, frozenset[Hashable]]:
  """Disjoint windows that hold boxes, which are merged where they overlap.

  Args:
    boxes: A window for each name; empty ones are left out.

  Returns:
    The names that each window holds.
  """
  out: dict[Window, frozenset[Hashable]] = {}
  for name, box in boxes.items():
    window, names = tuple(map(int, box)), frozenset([name])
    if not touch(window, window):
      continue
    while near := [other for other in out if touch(other, window)]:
      names |= out.pop(near[0])
      window = _union(window, near[0])
    out[window] = names
  return out


def _union(a: Window, b: Window) -> Window:
  return min(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), max(a[3], b[3])
