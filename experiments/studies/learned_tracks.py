"""Draws windows of tracks from which a receiver learns: symbols, END, and none.

A window is a slot of a frame as a tracker would see it from somewhere: with the
tracker's noise, a hover that wanders, a clock that differs, a size that START
told not quite, and times in which nothing is seen. What is no symbol is drawn
too: rests, curves, strokes from a wrong place, of a wrong size or at a wrong
time, START, motions that are turned, broken off, or that jump.
"""

from collections.abc import Callable
import dataclasses

import numpy as np

from waggle_tasks.agents import windows
from waggle_tasks.protocol import alphabets, levels, schedule, sights

Alphabet = levels.Levels | alphabets.Gestures

_SAMPLES = 65  # Of a path.
_NONE, _END = 0.3, 0.15  # Shares of windows; the rest are symbols.
# How far a dancer wanders from slot to slot, and within one, in m: as is taken
# of hovering vehicles by `agents.wander_chain`.
_WANDER_M, _DRIFT_M = 0.006, 0.004
_MOST_M = 0.016  # A dancer that wanders farther is not asked for.
_LATE = 0.04  # Deviation of lateness, as a share of a stroke.
_NOISE_M = (0.0005, 0.003)  # Trackers err by 2 mm.
_SCALE = 0.02
_DISTANCES_M, _WIDEST_DEG = (0.5, 5.0), sights.WIDEST_DEG
_LOST = 0.4  # Share of windows in which something is not seen.
_UNKNOWN = 0.1  # Share of windows before which the symbol was not told.


@dataclasses.dataclass(frozen=True, eq=False)
class Batch:
  """Windows with what they are.

  Attributes:
    places: (B, P, 2) in units, 0 where nothing was seen.
    seen: (B, P).
    states: (B, S) what the dancer did before; (B, 0) where there is one state.
    kinds: (B,) symbols, END, or none.
    moves: (B, 3) how the pose differs, in units.
  """

  places: np.ndarray
  seen: np.ndarray
  states: np.ndarray
  kinds: np.ndarray
  moves: np.ndarray

  def __getitem__(self, rows: np.ndarray) -> 'Batch':
    return Batch(
      *(getattr(self, field.name)[rows] for field in dataclasses.fields(self))
    )

  @property
  def inputs(self) -> np.ndarray:
    """(B, D) see `network.Network.inputs`."""
    count = len(self.places)
    flat = self.places.reshape(count, -1)
    return np.concatenate([flat, self.seen, self.states], axis=1)


class Tracks:
  """Draws windows of one alphabet."""

  def __init__(self, alphabet: Alphabet, confirm_s: float) -> None:
    """Makes its tables.

    Args:
      alphabet: What is flown.
      confirm_s: How long the rest after END is seen.
    """
    self._alphabet = alphabet
    self.length_s = windows.slot_s(alphabet, confirm_s)
    self._times_s = windows.times_s(self.length_s)
    self._stroke_s = alphabet.slot_s - alphabet.rest_s
    self._end_s = alphabet.end(0).duration_s
    size, states = range(alphabet.size), range(alphabet.states)
    self._strokes = np.array(
      [[_sampled(alphabet.stroke(i, k)) for k in size] for i in states]
    )
    self._ends = np.array([_sampled(alphabet.end(i)) for i in states])
    self._start = _sampled(alphabet.start)
    self._after = np.array([alphabet.after(k) for k in size])
    self._high = not np.any(self._strokes[..., 0])  # It goes up and down alone.
    self.unit_m = float(np.abs(self._strokes).max())
    self.units = np.array([0.01, 0.01, _LATE * self._stroke_s])
    self.none = alphabet.size + 1
    self._wrong: tuple[Callable[..., np.ndarray], ...] = (
      self._rest, self._curve, self._misplaced, self._begun, self._turned,
      self._broken, self._between,
    )  # fmt: skip

  def draw(self, rng: np.random.Generator, count: int) -> Batch:
    """Draws windows."""
    alphabet, end = self._alphabet, self._alphabet.size
    states = rng.integers(alphabet.states, size=count)
    kinds = rng.integers(end, size=count)
    luck = rng.random(count)
    kinds[luck < _END + _NONE] = end
    wrong = luck < _NONE
    late_s = np.clip(rng.normal(0, 1, count), -2.5, 2.5) * self.units[2]
    at_s = self._times_s - late_s[:, None]
    ways = self._flown(states, kinds, at_s)
    for number in np.flatnonzero(wrong):
      make = self._wrong[rng.integers(len(self._wrong))]
      ways[number] = make(rng, states[number], at_s[number])
    kinds[wrong] = self.none
    homes_m = _clipped(rng, _WANDER_M, (count, 2))
    places_m = self._seen_from(rng, ways) + homes_m[:, None]
    drift = np.linspace(-0.5, 0.5, windows.POINTS)[:, None]
    places_m += drift * rng.normal(0, _DRIFT_M, (count, 1, 2))
    noise_m = rng.uniform(*_NOISE_M, (count, 1, 1))
    places_m += noise_m * rng.normal(0, 1, places_m.shape)
    seen = self._in_sight(rng, count)
    told = np.zeros((count, alphabet.states if alphabet.states > 1 else 0))
    if told.shape[1]:
      # Of what is none the place before is told: else it may be a symbol.
      known = wrong | (rng.random(count) >= _UNKNOWN)
      told[np.flatnonzero(known), states[known]] = 1.0
    moves = np.column_stack([homes_m, late_s]) / self.units
    places = places_m / self.unit_m * seen[..., None]
    return Batch(places, seen, told, kinds, moves)

  def _flown(
    self, states: np.ndarray, kinds: np.ndarray, at_s: np.ndarray
  ) -> np.ndarray:
    """(B, P, 2) right and up: symbols and ENDs at times (B, P)."""
    ends = kinds == self._alphabet.size
    paths = self._strokes[states, np.where(ends, 0, kinds)]
    paths[ends] = self._ends[states[ends]]
    took_s = np.where(ends, self._end_s, self._stroke_s)
    return _at(paths, at_s / took_s[:, None])

  def _one(self, state: int, kind: int, at_s: np.ndarray) -> np.ndarray:
    """The same of a single one."""
    return self._flown(np.array([state]), np.array([kind]), at_s[None])[0]

  def _any(self, rng: np.random.Generator) -> int:
    return int(rng.integers(self._alphabet.size))

  def _rest(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """Nothing is flown, at the hover point."""
    del state, rng
    return np.zeros((len(at_s), 2))

  def _curve(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """Something smooth."""
    del state
    turns = rng.uniform(0.2, 2.5, (3, 2)) * 2 * np.pi / self.length_s
    sizes = rng.uniform(0, 0.7, (3, 2)) * self.unit_m
    phases = rng.uniform(0, 2 * np.pi, (3, 2))
    waves = np.sin(at_s[:, None, None] * turns + phases)
    return (sizes * waves).sum(axis=1) + rng.normal(0, 0.3, 2) * self.unit_m

  def _misplaced(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """A stroke from another place, or of another size."""
    states = self._alphabet.states
    if states > 1:
      other = (state + rng.integers(1, states)) % states
      return self._one(int(other), self._any(rng), at_s)
    size = rng.uniform(0.2, 0.65) if rng.random() < 0.7 else rng.uniform(1.5, 2)
    kind = int(rng.integers(self._alphabet.size + 1))
    return size * self._one(state, kind, at_s)

  def _begun(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """A START, or a part of one that is more than its last rest."""
    del state
    start_s = self._alphabet.start.duration_s
    early_s = rng.uniform(-0.3, 0.45) * start_s
    return _at(self._start[None], (at_s[None] + early_s) / start_s)[0]

  def _turned(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """A stroke in another direction, about the place where it begins."""
    way = self._one(state, self._any(rng), at_s)
    angle = np.radians(rng.uniform(40, 140)) * rng.choice((-1, 1))
    turn = np.array(
      [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    )
    off = way - way[0]
    if np.abs(off).max() < 0.2 * self.unit_m:  # It stays where it is.
      off = np.outer(np.linspace(0, 1, len(way)), (0, self.unit_m))
    return way[0] + off @ turn.T

  def _broken(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """At a wrong time, or with a jump to something else."""
    kind = self._any(rng)
    way = self._one(state, kind, at_s)
    if rng.random() < 0.5 and np.ptp(way):  # Who stays is never late.
      shift_s = rng.uniform(0.3, 0.7) * self._stroke_s * rng.choice((-1, 1))
      return self._one(state, kind, at_s + shift_s)
    cut = int(rng.integers(4, len(way) - 4))
    angle = rng.uniform(0, 2 * np.pi)
    jump_m = rng.uniform(0.4, 1.2) * self.unit_m
    way[cut:] += jump_m * np.array([np.cos(angle), np.sin(angle)])
    return way

  def _between(
    self, rng: np.random.Generator, state: int, at_s: np.ndarray
  ) -> np.ndarray:
    """To a place between two levels; one half of a symbol, and of another."""
    if isinstance(self._alphabet, levels.Levels):
      high_m = self._alphabet.height_m(self._any(rng))
      side_m = rng.uniform(0.42, 0.58) * rng.choice((-1, 1))
      other = (state + 1) % self._alphabet.states
      way = self._one(state, int(other), at_s)
      begin_m, end_m = (self._alphabet.height_m(int(k)) for k in (state, other))
      share = (way[:, 1] - begin_m) / (end_m - begin_m)
      goal_m = high_m + side_m * self._alphabet.spacing_m
      way[:, 1] = begin_m + share * (goal_m - begin_m)
      return way
    one, other = rng.permutation(self._alphabet.size + 1)[:2]
    way, later = (
      self._one(state, int(one), at_s),
      self._one(state, int(other), at_s),
    )
    if rng.random() < 0.5:
      later = np.zeros_like(later)
    half = at_s > self._stroke_s / 2
    if rng.random() < 0.5:
      half = ~half
    way[half] = later[half]
    return way

  def _seen_from(
    self, rng: np.random.Generator, ways: np.ndarray
  ) -> np.ndarray:
    """(B, P, 2) right and down in the picture, from anywhere."""
    count = len(ways)
    angles = np.radians(rng.uniform(-_WIDEST_DEG, _WIDEST_DEG, count))[:, None]
    away_m = rng.uniform(*_DISTANCES_M, count)[:, None]
    right, up = ways[..., 0], ways[..., 1]
    nearer_m, across_m = right * np.sin(angles), right * np.cos(angles)
    if self._high:  # From all around it looks the same.
      nearer_m, across_m = 0 * right, right
    grown = away_m / np.maximum(away_m - nearer_m, 0.1 * away_m)
    grown = grown * (1 + rng.normal(0, _SCALE, count))[:, None]
    return np.stack([across_m * grown, -up * grown], axis=-1)

  def _in_sight(self, rng: np.random.Generator, count: int) -> np.ndarray:
    """(B, P) 1 where the target is seen; one time without sight at most."""
    points = np.arange(windows.POINTS)
    first = rng.uniform(-0.2, 1.0, (count, 1)) * windows.POINTS
    lost = rng.uniform(0.0, 0.4, (count, 1)) * windows.POINTS
    lost *= rng.random((count, 1)) < _LOST
    return 1.0 - ((points >= first) & (points < first + lost))


def _clipped(
  rng: np.random.Generator, sigma: float, shape: tuple[int, ...]
) -> np.ndarray:
  return np.clip(rng.normal(0, sigma, shape), -_MOST_M, _MOST_M)


def _sampled(path: schedule.Path) -> np.ndarray:
  """(T, 2) right and up, at equal times."""
  return alphabets.sample(path, _SAMPLES)[:, :2]


def _at(paths: np.ndarray, shares: np.ndarray) -> np.ndarray:
  """Points of paths (B, T, 2) at shares (B, P) of their time: (B, P, 2)."""
  last = paths.shape[1] - 1
  at = np.clip(shares, 0.0, 1.0) * last
  low = np.minimum(at.astype(int), last - 1)
  part, row = (at - low)[..., None], np.arange(len(paths))[:, None]
  return paths[row, low] * (1 - part) + paths[row, low + 1] * part
