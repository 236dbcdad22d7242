"""Reads a frame as a whole: every symbol by the agreed clock, from one view.

A frame is a path through the states of its alphabet. Viterbi's algorithm finds
the one that is nearest to what was seen (Forney 1973,
doi:10.1109/PROC.1973.9030); from slot to slot the reader learns how the dancer
wanders and how its own clock differs, from what it has decided so far.
"""

from collections.abc import Sequence
import dataclasses

import numpy as np

from waggle_tasks.agents import lock as lock_lib
from waggle_tasks.agents import shapes as shapes_lib

# Of a dancer, from slot to slot: how far it may wander, in m, and how far two
# clocks may part, in s; and how exactly it is seen in one second.
_WANDER_M, _CLOCK_S, _SEEN_M = 0.006, 0.01, 0.002
# Farther from all that it can fly, it is something else that is seen.
_FAR_M = 0.03
_SLOTS = 3  # What is told from the last ones.


@dataclasses.dataclass(frozen=True, eq=False)
class Pose:
  """How a frame lies in the picture during a slot.

  Attributes:
    home_px: (2,) where the dancer would hover.
    late_s: How much later than by the clock of START.
  """

  home_px: np.ndarray
  late_s: float


@dataclasses.dataclass(frozen=True, eq=False)
class Reading:
  """A frame as it was read.

  Attributes:
    word: (N,) its symbols, each the nearest.
    gains: (N, M) how much farther every other symbol is from what was seen, if
      all others are as they were read: m^2 s.
    apart: (N, M, M) how far that is between two symbols, if all is seen.
    misfits: (N, M) how far a symbol's own stroke is from what was seen...
    near: ...and how far the nearest other one is from it, (N, M), m^2 s.
    seen: (N,) what share of its slot was seen.
    end: How far END and the rest after it are from what was seen, as a share
      of how far a dancer would be that stayed where it was, or one level
      beside.
    end_seen: What share of their time was seen.
    angle_rad: Where it was seen from.
    poses: One for each symbol, and for END.
  """

  word: np.ndarray
  gains: np.ndarray
  apart: np.ndarray
  misfits: np.ndarray
  near: np.ndarray
  seen: np.ndarray
  end: float
  end_seen: float
  angle_rad: float
  poses: tuple[Pose, ...]

  def misfit(self, word: np.ndarray) -> float:
    """How far the strokes of a word are from what was seen of them.

    As a share of how far the nearest other stroke is from each: 0.25 where
    everything was half-way between two.

    Args:
      word: (N,) symbols.
    """
    places = np.arange(len(word))
    near = (self.near[places, word] * self.seen).sum()
    return float(self.misfits[places, word].sum() / max(near, 1e-9))


class Reader:
  """Reads one frame, whose START is known."""

  def __init__(
    self,
    samples: lock_lib.Samples,
    shapes: shapes_lib.Shapes,
    found: lock_lib.Lock,
    count: int,
    rest_s: float,
  ) -> None:
    """Begins.

    Args:
      samples: Where the target was seen, to the end of the frame.
      shapes: What the alphabet looks like at the dancer's distance.
      found: Its START.
      count: How many symbols it has.
      rest_s: How much of the rest after END belongs to it.
    """
    self._samples, self._shapes, self._found = samples, shapes, found
    self._count, self._rest_s = count, rest_s
    self._scale_px = found.scale_px
    self._view = 0
    self._poses: tuple[Pose, ...] = ()

  def read(self) -> Reading:
    """The whole frame."""
    poses = [Pose(self._found.home_px, 0.0)]
    cost = np.full(
      (len(self._shapes.angles_rad), self._shapes.ends.shape[1]), np.inf
    )
    cost[:, 0] = 0.0
    steps: list[tuple[np.ndarray, np.ndarray]] = []
    for number in range(self._count):
      cost, step = self._step(cost, self._costs(number, poses[-1]))
      steps.append(step)
      view, word = _trace(cost, steps)
      poses.append(self._follow(view, word, poses[-1]))
    ends = self._end_costs(poses[-1])
    self._view, word = _trace(cost + ends, steps)
    self._poses = self._smooth(self._view, word, poses)
    return self._judge(self._view, word, self._poses)

  def again(self, word: Sequence[int]) -> Reading:
    """The frame as it is seen when it is known to be a word; after `read`."""
    symbols = [*word]
    self._poses = self._smooth(self._view, symbols, [*self._poses])
    return self._judge(self._view, symbols, self._poses)

  def _begin_s(self, number: int, pose: Pose) -> float:
    """When a slot begins; that of END follows the last symbol's."""
    shapes = self._shapes
    after_s = shapes.start_s + number * shapes.slot_s
    return self._found.begin_s + pose.late_s + after_s

  def _during(
    self, number: int, pose: Pose, length_s: float
  ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Seconds since a slot began, places in m, and weights, in a slot."""
    begin_s = self._begin_s(number, pose)
    part = self._samples.between(begin_s, begin_s + length_s)
    places_m = (part.places_px - pose.home_px) / self._scale_px
    times_s = part.times_s - begin_s
    return (
      times_s,
      places_m,
      part.weights_s * self._is_seen(number, times_s, places_m),
    )

  def _is_seen(
    self, number: int, times_s: np.ndarray, places_m: np.ndarray
  ) -> np.ndarray:
    """(T,) whether the dancer can be there; else it is something else."""
    shapes = self._shapes
    if number == self._count:
      paths = shapes_lib.at(shapes.ends, times_s / shapes.end_s)
    else:
      paths = shapes_lib.at(shapes.strokes, times_s / shapes.stroke_s)
    squares = _squares(paths, places_m)
    nearest = squares.min(axis=tuple(range(squares.ndim - 1)))
    return nearest <= _FAR_M**2

  def _costs(self, number: int, pose: Pose) -> np.ndarray:  # (V, S, M)
    """How far what was seen is from each stroke: m^2 s."""
    shapes = self._shapes
    times_s, places_m, weights_s = self._during(number, pose, shapes.slot_s)
    paths = shapes_lib.at(shapes.strokes, times_s / shapes.stroke_s)
    return _squares(paths, places_m) @ weights_s

  def _end_costs(self, pose: Pose) -> np.ndarray:  # (V, S)
    """The same for END and the rest after it, from each state."""
    shapes = self._shapes
    length_s = shapes.end_s + self._rest_s
    times_s, places_m, weights_s = self._during(self._count, pose, length_s)
    paths = shapes_lib.at(shapes.ends, times_s / shapes.end_s)
    return _squares(paths, places_m) @ weights_s

  def _step(
    self, cost: np.ndarray, costs: np.ndarray
  ) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """One slot on: the cost of each state, its symbol and the state before."""
    totals = cost[:, :, None] + costs  # (V, S, M)
    before = totals.argmin(axis=1)  # (V, M)
    least = totals.min(axis=1)
    after = self._shapes.after
    states = range(cost.shape[1])
    groups = [np.flatnonzero(after == state) for state in states]
    picked = np.stack(
      [each[least[:, each].argmin(axis=1)] for each in groups], axis=1
    )  # (V, S) symbols
    rows = np.arange(len(cost))[:, None]
    return least[rows, picked], (picked, before[rows, picked])

  def _follow(self, view: int, word: list[int], last: Pose) -> Pose:
    """The pose after some symbols, from the last ones."""
    first = max(len(word) - _SLOTS, -1)
    return self._fit(view, word, range(first, len(word)), last)

  def _smooth(
    self, view: int, word: list[int], poses: list[Pose]
  ) -> tuple[Pose, ...]:
    """Each slot's pose, from those before and after it too."""
    out = []
    for number in range(self._count + 1):
      near = range(max(number - 2, -1), min(number + 3, self._count + 1))
      out.append(self._fit(view, word, near, poses[number]))
    return tuple(out)

  def _path(
    self, view: int, word: list[int], number: int
  ) -> tuple[np.ndarray, float, float]:
    """What is flown in a slot, how long it takes, and how long the slot is.

    START has the number -1, and END that after the last symbol.
    """
    shapes = self._shapes
    if number < 0:
      start_s = shapes.alphabet.start.duration_s
      return shapes.start[view], start_s, shapes.start_s
    state = 0 if number == 0 else int(shapes.after[word[number - 1]])
    if number == self._count:
      return shapes.ends[view, state], shapes.end_s, shapes.end_s + self._rest_s
    path = shapes.strokes[view, state, word[number]]
    return path, shapes.stroke_s, shapes.slot_s

  def _fit(self, view: int, word: list[int], near: range, last: Pose) -> Pose:
    """How a pose changes so that some slots are where they were seen."""
    # Of right, down and lateness; what is known before.
    left = np.diag([_WANDER_M**-2, _WANDER_M**-2, _CLOCK_S**-2])
    right = np.zeros(3)
    for number in near:
      path, stroke_s, slot_s = self._path(view, word, number)
      if number < 0:
        begin_s = self._found.begin_s + last.late_s
        part = self._samples.between(begin_s, begin_s + slot_s)
        times_s = part.times_s - begin_s
        places_m = (part.places_px - last.home_px) / self._scale_px
        weights_s = part.weights_s
      else:
        times_s, places_m, weights_s = self._during(number, last, slot_s)
      shares = times_s / stroke_s
      step = 0.25 / (len(path) - 1)
      rates = (
        shapes_lib.at(path, shares + step) - shapes_lib.at(path, shares - step)
      ) / (2 * step * stroke_s)
      off_m = places_m - shapes_lib.at(path, shares)
      trust = weights_s / _SEEN_M**2
      left[0, 0] += trust.sum()
      left[1, 1] += trust.sum()
      crossed = -(trust @ rates)
      left[:2, 2] += crossed
      left[2, :2] += crossed
      left[2, 2] += trust @ (rates**2).sum(axis=1)
      right[:2] += trust @ off_m
      right[2] -= trust @ (rates * off_m).sum(axis=1)
    x_m, y_m, late_s = np.linalg.solve(left, right)
    home_px = last.home_px + self._scale_px * np.array([x_m, y_m])
    return Pose(home_px, last.late_s + float(late_s))

  def _judge(
    self, view: int, word: list[int], poses: tuple[Pose, ...]
  ) -> Reading:
    """What each symbol stands on, with all others as they were read."""
    shapes, count = self._shapes, self._count
    size = len(shapes.after)
    costs = [self._costs(n, poses[n])[view] for n in range(count)]
    ends = self._end_costs(poses[-1])[view]
    states = [0, *(int(shapes.after[k]) for k in word)]
    gains, misfits, near = np.zeros((3, count, size))
    apart, seen = np.zeros((count, size, size)), np.zeros(count)
    others = np.where(np.eye(size), np.inf, 0.0)
    for number, state in enumerate(states[:-1]):
      misfits[number] = here = costs[number][state]
      last = number + 1 == count
      later = ends if last else costs[number + 1][:, word[number + 1]]
      gains[number] = here + later[shapes.after]
      gains[number] -= gains[number, word[number]]
      own = _pairs(shapes.strokes[view, state]) * shapes.stroke_s
      near[number] = (own + others).min(axis=1)
      if last:
        ways = _pairs(shapes.ends[view]) * shapes.end_s
      else:
        paths = shapes.strokes[view, :, word[number + 1]]
        ways = _pairs(paths) * shapes.stroke_s
      apart[number] = own + ways[np.ix_(shapes.after, shapes.after)]
      _, _, weights_s = self._during(number, poses[number], shapes.slot_s)
      seen[number] = min(weights_s.sum() / shapes.slot_s, 1.0)
    length_s = shapes.end_s + self._rest_s
    _, _, weights_s = self._during(count, poses[-1], length_s)
    path = shapes.ends[view, states[-1]]
    stay = float(_mean_square(path - path[:1])) * shapes.end_s
    stay += float(((path[-1] - path[0]) ** 2).sum()) * self._rest_s
    if len(shapes.ends[view]) > 1:  # From near home, END hardly moves.
      stay = max(stay, float(near[-1, word[-1]]))
    return Reading(
      np.array(word, int), gains, apart, misfits, near, seen,
      float(ends[states[-1]]) / max(stay, 1e-9),
      min(float(weights_s.sum()) / length_s, 1.0),
      float(shapes.angles_rad[view]), poses,
    )  # fmt: skip


def _pairs(paths: np.ndarray) -> np.ndarray:
  """The mean square distance of every two of paths (K, P, 2): (K, K)."""
  return _mean_square(paths[:, None] - paths)


def _mean_square(paths: np.ndarray) -> np.ndarray:
  """Of paths (..., P, 2): (...)."""
  return (paths**2).sum(axis=-1).mean(axis=-1)


def _squares(
  paths: np.ndarray,  # (..., T, 2)
  places_m: np.ndarray,  # (T, 2)
) -> np.ndarray:
  """Squared distances of places from paths, (..., T)."""
  return ((paths - places_m) ** 2).sum(axis=-1)


def _trace(
  cost: np.ndarray,  # (V, S)
  steps: list[tuple[np.ndarray, np.ndarray]],
) -> tuple[int, list[int]]:
  """The view and the symbols of the path that costs least."""
  view, state = np.unravel_index(int(cost.argmin()), cost.shape)
  word = []
  for symbols, befores in reversed(steps):
    word.append(int(symbols[view, state]))
    state = befores[view, state]
  return int(view), word[::-1]
