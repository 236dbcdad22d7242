"""A frame as it was read, with what it stands on."""

from collections.abc import Sequence
import dataclasses

import numpy as np

from waggle_tasks.agents import slots

_SAME_M = 1e-6  # END of gestures begins where it ends, but for rounding.


@dataclasses.dataclass(frozen=True, eq=False)
class Reading:
  """A frame as it was read.

  Attributes:
    misfit: How far its strokes are from what was seen of them, as a share of
      how far the nearest other stroke is from each: 0.25 where everything was
      half-way between two.
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
) -> Reading:
  """What a word of a frame stands on, from a view, by poses."""
  shapes, count = frame.shapes, frame.count
  states = [0, *(int(shapes.after[symbol]) for symbol in word)]
  misfit = near = seen_s = 0.0
  for number, (state, symbol) in enumerate(zip(states, word, strict=False)):
    part = frame.part(number, poses[number + 1])
    own = frame.costs(number, part)[view, state, symbol]
    nearest = _nearest(shapes.strokes[view, state], symbol) * shapes.stroke_s
    part_s = min(float(part.weights_s.sum()), shapes.slot_s)
    misfit, near = misfit + own, near + nearest * part_s / shapes.slot_s
    seen_s += part_s
  begin_s = frame.starts_s(0, poses[1])
  whole = frame.samples.between(begin_s, frame.starts_s(count, poses[-1]))
  ended = frame.part(count, poses[-1])
  end_s = float(ended.weights_s.sum())
  resting_s = ended.weights_s * (ended.times_s >= shapes.end_s)
  middle_m = resting_s @ ended.places_m / max(resting_s.sum(), 1e-9)
  ways_m = shapes.ends[view][:, 0] - shapes.ends[view][:, -1]
  level_m = float(np.hypot(*ways_m.T).min())
  aside_m = float(np.hypot(*middle_m * shapes.tell))
  rest = aside_m / level_m if level_m > _SAME_M else 0.0
  path = shapes.ends[view, states[-1]]
  stay = float(((path - path[:1]) ** 2).sum(axis=-1).mean()) * shapes.end_s
  stay += float(((path[-1] - path[0]) ** 2).sum()) * frame.after_s
  if len(shapes.ends[view]) > 1:  # From near home, END hardly moves.
    last = shapes.strokes[view, states[-2]]
    stay = max(stay, _nearest(last, word[-1]) * shapes.stroke_s)
  error = float(frame.costs(count, ended)[view, states[-1]])
  return Reading(
    float(misfit / max(near, 1e-9)),
    error / max(stay, 1e-9),
    min(end_s / frame.length_s(count), 1.0),
    rest,
    bool(resting_s.any()),
    1 - seen_s / max(float(whole.weights_s.sum()), 1e-9),
    float(shapes.angles_rad[view]),
    poses[-1].scale_px,
  )


def _nearest(paths: np.ndarray, own: int) -> float:
  """The mean square distance of one of (K, P, 2) paths from the nearest."""
  apart = ((paths - paths[own]) ** 2).sum(axis=-1).mean(axis=-1)
  return float(np.delete(apart, own).min())
