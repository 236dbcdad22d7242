"""How a dancer wanders from slot to slot, while it says one thing or another.

What is seen in a slot tells how far the dancer's pose is from a known one, if
this or that was danced; from one slot to the next the pose changes a little, at
random. All of it is linear and Gaussian: a Kalman filter in information form
has the best poses, and what they cost, for many words at once.
"""

import dataclasses

import numpy as np

_One = int | slice | np.ndarray | np.integer | None
_Index = _One | tuple[_One, ...]
# Of a pose: right and down in m, lateness in s, and size as a share.
SIZE = 4
# How exactly a dancer is seen in one second, in m.
_SEEN_M = 0.002
# How much of each changes from slot to slot, and what is known before START.
_CHANGE = np.diag(np.square([0.006, 0.006, 0.01, 1e-4]))
_BEFORE = np.diag(np.square([0.05, 0.05, 0.05, 0.05]))


@dataclasses.dataclass(frozen=True, eq=False)
class Evidence:
  """What was seen of a pose: the cost is rest - 2 linear d + d square d.

  Attributes:
    square: (..., 4, 4).
    linear: (..., 4).
    rest: (...).
  """

  square: np.ndarray
  linear: np.ndarray
  rest: np.ndarray

  @classmethod
  def of(
    cls,
    places_m: np.ndarray,  # (T, 2)
    weights_s: np.ndarray,  # (T,)
    paths_m: np.ndarray,  # (..., T, 2)
    rates_mps: np.ndarray,  # (..., T, 2)
  ) -> 'Evidence':
    """Of places that were seen, if paths were flown.

    Args:
      places_m: Where, from the known pose.
      weights_s: For how long each was seen.
      paths_m: Where each path was then.
      rates_mps: How quick it was there.
    """
    ways = np.zeros((*paths_m.shape, SIZE))
    ways[..., 0, 0] = ways[..., 1, 1] = 1.0
    ways[..., 2], ways[..., 3] = -rates_mps, paths_m
    off_m, trust = places_m - paths_m, weights_s / _SEEN_M**2
    trusted = ways * trust[:, None, None]
    return cls(
      np.einsum('...tci,...tcj->...ij', trusted, ways),
      np.einsum('...tci,...tc->...i', trusted, off_m),
      np.einsum('t,...tc->...', trust, off_m**2),
    )

  def __getitem__(self, index: _Index) -> 'Evidence':
    return Evidence(self.square[index], self.linear[index], self.rest[index])


@dataclasses.dataclass(frozen=True, eq=False)
class Beliefs:
  """What is believed of poses, and what it costs that it was so.

  Attributes:
    mean: (..., 4).
    covariance: (..., 4, 4).
    cost: (...) twice the negative logarithm of the likelihood.
  """

  mean: np.ndarray
  covariance: np.ndarray
  cost: np.ndarray

  @classmethod
  def before(cls, shape: tuple[int, ...]) -> 'Beliefs':
    """Before anything was seen."""
    covariance = np.broadcast_to(_BEFORE, (*shape, SIZE, SIZE))
    return cls(np.zeros((*shape, SIZE)), covariance, np.zeros(shape))

  def __getitem__(self, index: _Index) -> 'Beliefs':
    return Beliefs(self.mean[index], self.covariance[index], self.cost[index])

  def seen(self, found: Evidence) -> 'Beliefs':
    """After something was seen."""
    known = np.linalg.inv(self.covariance)
    drawn = np.einsum('...ij,...j->...i', known, self.mean)
    covariance = np.linalg.inv(known + found.square)
    pull = drawn + found.linear
    mean = np.einsum('...ij,...j->...i', covariance, pull)
    kept = (self.mean * drawn).sum(axis=-1) - (pull * mean).sum(axis=-1)
    return Beliefs(mean, covariance, self.cost + found.rest + kept)

  def moved(self, step: np.ndarray) -> 'Beliefs':
    """In the next slot, of which the known pose is by a step (4,) elsewhere."""
    return Beliefs(self.mean - step, self.covariance + _CHANGE, self.cost)


def smooth(found: Evidence, steps: np.ndarray) -> np.ndarray:
  """The best poses of slots in a row, by all that was seen in them.

  Args:
    found: (N, ...) what was seen in each.
    steps: (N - 1, 4) how far each known pose is from the one before.

  Returns:
    (N, 4) how far each is from the known one.
  """
  count = len(found.rest)
  square = np.zeros((count, SIZE, count, SIZE))
  pull = found.linear.copy()
  for slot in range(count):
    square[slot, :, slot] += found.square[slot]
  square[0, :, 0] += np.linalg.inv(_BEFORE)
  stiff = np.linalg.inv(_CHANGE)
  for slot, step in enumerate(steps):
    for one in (slot, slot + 1):
      square[one, :, one] += stiff
    square[slot, :, slot + 1] -= stiff
    square[slot + 1, :, slot] -= stiff
    pull[slot] += stiff @ step
    pull[slot + 1] -= stiff @ step
  whole = square.reshape(count * SIZE, count * SIZE)
  return np.linalg.solve(whole, pull.ravel()).reshape(count, SIZE)
