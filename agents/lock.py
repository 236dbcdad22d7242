"""Finds START: where, when and how large a frame begins."""

from collections.abc import Sequence
import dataclasses
import math

import numpy as np

from waggle_tasks.agents import shapes as shapes_lib

# A sample of a track stands for no more than this time.
_SAMPLE_S = 0.1
# What is so far from a START, as a share of its size, is something before it:
# it is left out, a few times over.
_FAR, _ROUNDS = 0.35, 4
_FEWEST = 5  # Samples of a START.


@dataclasses.dataclass(frozen=True, eq=False)
class Samples:
  """Where a target was seen.

  Attributes:
    times_s: (T,) in order.
    places_px: (T, 2).
    weights_s: (T,) for how long each stands: what is not seen has no weight.
  """

  times_s: np.ndarray
  places_px: np.ndarray
  weights_s: np.ndarray

  @classmethod
  def of(cls, rows: Sequence[tuple[float, float, float]]) -> 'Samples':
    """Of times with places, in order."""
    table = np.array(rows, float).reshape(-1, 3)
    gaps_s = np.minimum(np.diff(table[:, 0]), _SAMPLE_S)
    weights_s = np.zeros(len(table))
    weights_s[1:] += gaps_s / 2
    weights_s[:-1] += gaps_s / 2
    return cls(table[:, 0], table[:, 1:], weights_s)

  def between(self, begin_s: float, end_s: float) -> 'Samples':
    """Those from one time to another."""
    low, high = np.searchsorted(self.times_s, [begin_s - 1e-9, end_s - 1e-9])
    part = slice(low, high)
    return Samples(
      self.times_s[part], self.places_px[part], self.weights_s[part]
    )


@dataclasses.dataclass(frozen=True, eq=False)
class Lock:
  """A START that was found.

  Attributes:
    begin_s: When it began.
    error: What is left of it, as a share of its size.
    scale_px: Pixels of a metre at the dancer.
    home_px: (2,) where the dancer hovers.
    seen: What share of its time it was seen.
  """

  begin_s: float
  error: float
  scale_px: float
  home_px: np.ndarray
  seen: float


def fit(
  samples: Samples, shapes: shapes_lib.Shapes, begin_s: float, rest_s: float
) -> Lock | None:
  """How well a START that began then would fit; None where nothing is seen.

  Args:
    samples: Where the target was seen.
    shapes: What START looks like.
    begin_s: When it would have begun.
    rest_s: How much of the rest before it belongs to it.
  """
  start_s = shapes.alphabet.start.duration_s
  part = samples.between(begin_s - rest_s, begin_s + start_s)
  paths = shapes_lib.at(shapes.start, (part.times_s - begin_s) / start_s)
  weights_s, begun = part.weights_s.copy(), part.times_s >= begin_s
  for _ in range(_ROUNDS):
    during = weights_s[begun].sum() / start_s
    if np.count_nonzero(weights_s) < _FEWEST or not during:
      return None
    view, scale_px, home_px = _least(part.places_px, paths, weights_s)
    if scale_px <= 0:
      return None
    path = paths[view]
    off_px = np.linalg.norm(part.places_px - home_px - scale_px * path, axis=1)
    share = weights_s / weights_s.sum()
    size_px = scale_px * math.sqrt(share @ ((path - share @ path) ** 2).sum(1))
    rms_px = math.sqrt(share @ off_px**2)
    far = (off_px > max(_FAR * size_px, 2 * rms_px)) & (weights_s > 0)
    if not far.any():
      break
    weights_s[far] = 0.0
  error = rms_px / max(size_px, 1e-9)
  return Lock(begin_s, error, scale_px, home_px, float(during))


def _least(
  places_px: np.ndarray,  # (T, 2)
  paths: np.ndarray,  # (V, T, 2)
  weights: np.ndarray,  # (T,)
) -> tuple[int, float, np.ndarray]:
  """The view, the scale and the place by which a path fits best."""
  share = weights / weights.sum()
  middle_px, middles = share @ places_px, share @ paths
  off_px, offs = places_px - middle_px, paths - middles[:, None]
  power = np.maximum(np.einsum('t,vtc,vtc->v', share, offs, offs), 1e-12)
  along = np.einsum('t,vtc,tc->v', share, offs, off_px)
  view = int((along**2 / power * (along > 0)).argmax())
  scale_px = float(along[view] / power[view])
  return view, scale_px, middle_px - scale_px * middles[view]
