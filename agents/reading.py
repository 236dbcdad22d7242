"""A frame as it was read, with what it stands on."""

from collections.abc import Sequence
import dataclasses

import numpy as np

from waggle_tasks.agents import joint_config, lock, slots
from waggle_tasks.agents import shapes as shapes_lib

_SEEN = 0.25  # Of a slot, to be judged by itself.
_SAME_M = 1e-6  # END of gestures begins where it ends, but for rounding.


@dataclasses.dataclass(frozen=True, eq=False)
class Reading:
  """A frame as it was read.

  Attributes:
    misfit: How far its strokes are from what was seen of them, as a share of
      how far the nearest other stroke is from each: 0.25 where everything was
      half-way between two.
    worst: The same of the symbol that fits worst, of those that were seen; of
      a gesture as a share of its own size, if that is less: half of one is
      none.
    mended: How much nearer the nearest of all words is, those of no code among
      them, as a share of how far that is from this one: 1 where it was seen as
      it should be, and 0 where the two differ in what was not seen.
    end: How far END and the rest after it are from what was seen, as a share
      of how far a dancer would be that stayed where it was, or one level
      beside.
    end_seen: What share of their time was seen.
    rest: How far from its hover point the dancer then rested, as a share of how
      far the nearest level is; 0 for gestures, which all end there, so that
      END alone tells their end.
    rest_seen: Whether that rest was seen.
    astray: What share of the track was where no symbol is flown.
    angle_rad: Where it was seen from.
    scale_px: Pixels of a metre at the dancer.
  """

  misfit: float
  worst: float
  mended: float
  end: float
  end_seen: float
  rest: float
  rest_seen: bool
  astray: float
  angle_rad: float
  scale_px: float


def judge(
  frame: slots.Slots,
  word: np.ndarray,  # (N,)
  view: int,
  poses: Sequence[slots.Pose],  # Of START, each symbol, and END.
  mended: float,
) -> Reading:
  """What a word of a frame stands on, from a view, by poses."""
  shapes, count = frame.shapes, frame.count
  states = [0, *(int(shapes.after[symbol]) for symbol in word)]
  levels = len(shapes.ends[view]) > 1
  misfit = near = seen_s = worst = 0.0
  for number, (state, symbol) in enumerate(zip(states, word, strict=False)):
    part = frame.part(number, poses[number + 1])
    own = frame.costs(number, part)[view, state, symbol]
    part_s = min(float(part.weights_s.sum()), shapes.slot_s)
    share_s = shapes.stroke_s * part_s / shapes.slot_s
    strokes = shapes.strokes[view, state]
    nearest = _nearest(strokes, symbol)
    misfit, near = misfit + own, near + nearest * share_s
    if part_s > _SEEN * shapes.slot_s:
      other = nearest if levels else min(nearest, _size(strokes[symbol]))
      worst = max(worst, float(own / (other * share_s)))
    seen_s += part_s
  begin_s = frame.starts_s(0, poses[1])
  whole = frame.samples.between(begin_s, frame.starts_s(count, poses[-1]))
  ended = frame.part(count, poses[-1])
  end_s = float(ended.weights_s.sum())
  resting_s = ended.weights_s * (ended.times_s >= shapes.end_s)
  path = shapes.ends[view, states[-1]]
  stay = _size(path) * shapes.end_s
  stay += float(((path[-1] - path[0]) ** 2).sum()) * frame.after_s
  if levels:  # From near home, END hardly moves.
    last = shapes.strokes[view, states[-2]]
    stay = max(stay, _nearest(last, word[-1]) * shapes.stroke_s)
  error = float(frame.costs(count, ended)[view, states[-1]])
  return Reading(
    float(misfit / max(near, 1e-9)),
    worst,
    mended,
    error / max(stay, 1e-9),
    min(end_s / frame.length_s(count), 1.0),
    _aside(shapes, view, ended.places_m, resting_s),
    bool(resting_s.any()),
    1 - seen_s / max(float(whole.weights_s.sum()), 1e-9),
    float(shapes.angles_rad[view]),
    poses[-1].scale_px,
  )


def doubt(found: Reading, clear: float, limits: joint_config.Reading) -> str:
  """Why a word that was read is none; empty if it may be one.

  Args:
    found: What it stands on.
    clear: How much nearer it is than any other, see `soft.decide`.
    limits: When what was seen is a frame.
  """
  if found.end > limits.max_end:
    return (
      f'what came for END was none: error {found.end:.2f} > {limits.max_end}'
    )
  if not found.rest_seen:
    return 'the rest after END was not seen'
  if found.rest > limits.max_rest:
    return _beside('after END', found.rest, limits)
  if found.astray > limits.max_astray:
    return f'{found.astray:.0%} of what was seen is where no symbol is flown'
  if found.misfit > limits.max_misfit:
    return (
      f'what came for symbols were none: error {found.misfit:.2f} >'
      f' {limits.max_misfit}'
    )
  if found.worst > limits.max_worst:
    return f'one symbol is none: error {found.worst:.2f} > {limits.max_worst}'
  if found.mended > limits.max_mended:
    return (
      'another word was seen than any of the code: nearer by'
      f' {found.mended:.2f} > {limits.max_mended}'
    )
  if clear < limits.min_clear:
    return f'two words are as likely: clear {clear:.2f} < {limits.min_clear}'
  return ''


def unrested(
  start: lock.Lock,
  samples: lock.Samples,
  shapes: shapes_lib.Shapes,
  limits: joint_config.Reading,
) -> str:
  """Why a START is none, by the rest before it; empty if it may be one.

  Args:
    start: What was found.
    samples: Where the target was seen, the rest among it.
    shapes: What the alphabet looks like.
    limits: When what was seen is a frame.
  """
  begin_s = start.begin_s
  rest = samples.between(begin_s - limits.start_rest_s, begin_s)
  if not rest.weights_s.any():
    return 'the rest before START was not seen'
  places_m = (rest.places_px - start.home_px) / start.scale_px
  aside = _aside(shapes, 0, places_m, rest.weights_s)
  return (
    _beside('before START', aside, limits) if aside > limits.max_rest else ''
  )


def _beside(when: str, aside: float, limits: joint_config.Reading) -> str:
  return (
    f'{when} it rested at {aside:.0%} of the way to the next level >'
    f' {limits.max_rest:.0%}'
  )


def _aside(
  shapes: shapes_lib.Shapes,
  view: int,
  places_m: np.ndarray,  # (T, 2)
  weights_s: np.ndarray,  # (T,)
) -> float:
  """How far from the hover point a rest is, in ways to the nearest level."""
  ways_m = shapes.ends[view][:, 0] - shapes.ends[view][:, -1]
  level_m = float(np.hypot(*ways_m.T).min())
  middle_m = weights_s @ places_m / max(weights_s.sum(), 1e-9)
  aside_m = float(np.hypot(*middle_m * shapes.tell))
  return aside_m / level_m if level_m > _SAME_M else 0.0


def _size(path: np.ndarray) -> float:
  """The mean square distance of a path (P, 2) from its begin."""
  return float(((path - path[:1]) ** 2).sum(axis=-1).mean())


def _nearest(paths: np.ndarray, own: int) -> float:
  """The mean square distance of one of (K, P, 2) paths from the nearest."""
  apart = ((paths - paths[own]) ** 2).sum(axis=-1).mean(axis=-1)
  return float(np.delete(apart, own).min())
