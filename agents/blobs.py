"""Things apart in a picture of differences."""

import cv2
import numpy as np

from waggle_tasks.agents import difference

_MERGE_PX = 7  # Differences as near as this belong together.
_PART = 0.3  # Of its width: parts of a thing are not farther apart.


class Blobs:
  """Differences that belong together.

  Attributes:
    totals: (N,) the sum of each one's weights; the first, of what is none, is
      zero.
    boxes: (N, 4) left, top, right and bottom of each.
  """

  def __init__(self, weights: np.ndarray) -> None:
    """Finds them.

    Args:
      weights: (H, W) see `difference.Detector.weights`.
    """
    self._weights = weights
    near = np.ones((_MERGE_PX, _MERGE_PX), np.uint8)
    spread = cv2.dilate((weights > 0).astype(np.uint8), near)
    self._count, self._labels, stats, _ = cv2.connectedComponentsWithStats(
      spread
    )
    margin = _MERGE_PX // 2 * np.array([1, 1, -1, -1])
    corners = stats[:, :2], stats[:, :2] + stats[:, 2:4]
    self.boxes = np.concatenate(corners, axis=1) + margin
    self.totals = self.sums(weights)

  def sums(self, weights: np.ndarray) -> np.ndarray:
    """(N,) the sum of other weights (H, W) in the place of each."""
    return np.bincount(self._labels.ravel(), weights.ravel(), self._count)

  def inside(self, box: difference.Box) -> np.ndarray:
    """(N,) whether each has a part in a box of the picture."""
    here = np.zeros(self._count, bool)
    here[np.unique(self._labels[box])] = True
    return here

  def about(self, picked: np.ndarray, place_px: np.ndarray) -> np.ndarray:
    """Which of some blobs, given their numbers, are the one thing at a place.

    A thing may be seen in parts, which are nearer to each other than a part of
    its width; two things are not.

    Args:
      picked: (M,) numbers, at least one.
      place_px: (2,) x and y.
    """
    boxes = self.boxes[picked]
    gaps_px = np.maximum(boxes[:, :2] - place_px, place_px - boxes[:, 2:])
    nearest = int(np.hypot(*np.maximum(gaps_px, 0).T).argmin())
    mine, box = np.zeros(len(picked), bool), boxes[nearest]
    near = np.arange(len(picked)) == nearest
    while (near & ~mine).any():
      mine |= near
      parts = boxes[mine]
      box = np.append(parts[:, :2].min(axis=0), parts[:, 2:].max(axis=0))
      gaps_px = np.maximum(boxes[:, :2] - box[2:], box[:2] - boxes[:, 2:])
      near = np.maximum(gaps_px, 0).max(axis=1) <= _PART * (box[2] - box[0])
    return picked[mine]

  def parts(
    self, picked: np.ndarray, place_px: np.ndarray, size_px: np.ndarray
  ) -> np.ndarray:
    """Which of some blobs, given their numbers, are one thing of a known size.

    Args:
      picked: (M,) numbers, at least one.
      place_px: (2,) x and y of where it is; what is nearest to it belongs to
        it...
      size_px: (2,) ...and what is with that not wider nor higher than this.
    """
    boxes = self.boxes[picked]
    gaps_px = np.maximum(boxes[:, :2] - place_px, place_px - boxes[:, 2:])
    nearest, *others = np.hypot(*np.maximum(gaps_px, 0).T).argsort()
    mine, box = [nearest], boxes[nearest]
    for each in others:
      low = np.minimum(box[:2], boxes[each, :2])
      high = np.maximum(box[2:], boxes[each, 2:])
      if (high - low <= size_px).all():
        mine, box = [*mine, each], np.append(low, high)
    return picked[mine]

  def only(self, picked: np.ndarray) -> np.ndarray:
    """Weights (H, W) of some of them, given their numbers."""
    return np.where(np.isin(self._labels, picked), self._weights, 0).astype(
      self._weights.dtype
    )
