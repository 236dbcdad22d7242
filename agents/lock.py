"""Finds START: where, when and how large a frame begins."""

from collections.abc import Sequence
import dataclasses
import math

import numpy as np

from waggle_tasks.agents import shapes as shapes_lib

# A sample of a track stands for no more than this time.
_SAMPLE_S = 0.1


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
  weights = part.weights_s
  during = weights[part.times_s >= begin_s].sum() / start_s
  if len(weights) < 4 or not during:
    return None
  weights = weights / weights.sum()
  paths = shapes_lib.at(shapes.start, (part.times_s - begin_s) / start_s)
  mean = weights @ paths  # (V, 2)
  home_px = weights @ part.places_px
  paths, places_px = paths - mean[:, None], part.places_px - home_px
  power = np.einsum('t,vtc,vtc->v', weights, paths, paths)
  along = np.einsum('t,vtc,tc->v', weights, paths, places_px)
  power = np.maximum(power, 1e-12)
  total = np.einsum('t,tc,tc->', weights, places_px, places_px)
  left = total - along**2 / power
  best = int(np.argmin(left))
  scale_px = float(along[best] / power[best])
  if scale_px <= 0:
    return None
  size_px = scale_px * math.sqrt(power[best])
  error = math.sqrt(max(left[best], 0.0)) / size_px
  return Lock(begin_s, error, scale_px, home_px - scale_px * mean[best], during)
