"""Reads a frame as a whole: every symbol by the agreed clock, from one view.

A frame is a path through the states of its alphabet. Viterbi's algorithm finds
the one that is nearest to what was seen (Forney 1973,
doi:10.1109/PROC.1973.9030); from slot to slot the reader learns how the dancer
wanders and how its own clock differs, from what it has decided so far.
"""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.agents import lock as lock_lib
from waggle_tasks.agents import reading
from waggle_tasks.agents import shapes as shapes_lib

# Of a dancer, from slot to slot: how far it may wander, in m, and how far two
# clocks may part, in s; and how exactly it is seen in one second.
_WANDER_M, _CLOCK_S, _SEEN_M = 0.006, 0.01, 0.002
# Farther from all that it can fly, it is something else that is seen.
_FAR_M = 0.03
_ASTRAY = 0.2  # Of a slot.
_SLOTS = 3  # What is told from the last ones.


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
    self._poses: tuple[reading.Pose, ...] = ()

  def read(self) -> reading.Reading:
    """The whole frame."""
    poses = [reading.Pose(self._found.home_px, 0.0)]
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

  def again(self, word: Sequence[int]) -> reading.Reading:
    """The frame as it is seen when it is known to be a word; after `read`."""
    symbols = [*word]
    self._poses = self._smooth(self._view, symbols, [*self._poses])
    return self._judge(self._view, symbols, self._poses)

  def _begin_s(self, number: int, pose: reading.Pose) -> float:
    """When a slot begins; that of END follows the last symbol's."""
    shapes = self._shapes
    after_s = shapes.start_s + number * shapes.slot_s
    return self._found.begin_s + pose.late_s + after_s

  def _during(
    self, number: int, pose: reading.Pose, length_s: float
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
    """(T,) whether the dancer can be there; else it is something else.

    A slot of which much is something else tells nothing. What comes for END is
    all there is to tell it from another symbol.
    """
    if number == self._count:
      return np.ones(len(times_s), bool)
    shapes = self._shapes
    paths = shapes_lib.at(shapes.strokes, times_s / shapes.stroke_s)
    squares = _squares(paths, places_m)
    nearest = squares.min(axis=tuple(range(squares.ndim - 1)))
    near = nearest <= _FAR_M**2
    whole = near.mean() >= 1 - _ASTRAY if len(near) else False
    return near & whole

  def _costs(self, number: int, pose: reading.Pose) -> np.ndarray:  # (V, S, M)
    """How far what was seen is from each stroke: m^2 s."""
    shapes = self._shapes
    times_s, places_m, weights_s = self._during(number, pose, shapes.slot_s)
    paths = shapes_lib.at(shapes.strokes, times_s / shapes.stroke_s)
    return _squares(paths, places_m) @ weights_s

  def _end_costs(self, pose: reading.Pose) -> np.ndarray:  # (V, S)
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

  def _follow(
    self, view: int, word: list[int], last: reading.Pose
  ) -> reading.Pose:
    """The pose after some symbols, from the last ones."""
    first = max(len(word) - _SLOTS, -1)
    return self._fit(view, word, range(first, len(word)), last)

  def _smooth(
    self, view: int, word: list[int], poses: list[reading.Pose]
  ) -> tuple[reading.Pose, ...]:
    """Each slot's pose, from those before and after it too."""
    out = []
    for number in range(self._count + 1):
      # END is judged by what came before it, and vouches for nothing.
      near = range(max(number - 2, -1), min(number + 3, self._count))
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

  def _fit(
    self, view: int, word: list[int], near: range, last: reading.Pose
  ) -> reading.Pose:
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
    return reading.Pose(home_px, last.late_s + float(late_s))

  def _judge(
    self, view: int, word: list[int], poses: tuple[reading.Pose, ...]
  ) -> reading.Reading:
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
    times_s, places_m, weights_s = self._during(count, poses[-1], length_s)
    resting = weights_s * (times_s >= shapes.end_s)
    middle_m = resting @ places_m / max(resting.sum(), 1e-9)
    rest_m = float(np.hypot(*middle_m)) if resting.any() else np.inf
    begin_s = self._begin_s(0, poses[0])
    whole = self._samples.between(begin_s, self._begin_s(count, poses[-1]))
    astray = 1 - seen.sum() * shapes.slot_s / max(whole.weights_s.sum(), 1e-9)
    path = shapes.ends[view, states[-1]]
    stay = float(_mean_square(path - path[:1])) * shapes.end_s
    stay += float(((path[-1] - path[0]) ** 2).sum()) * self._rest_s
    if len(shapes.ends[view]) > 1:  # From near home, END hardly moves.
      stay = max(stay, float(near[-1, word[-1]]))
    return reading.Reading(
      np.array(word, int), gains, apart, misfits, near, seen,
      float(ends[states[-1]]) / max(stay, 1e-9),
      min(float(weights_s.sum()) / length_s, 1.0),
      rest_m, astray,
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
