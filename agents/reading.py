"""A frame as it was read, with what each of its symbols stands on."""

import dataclasses

import numpy as np


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
    rest_m: How far from its hover point the dancer then rested.
    astray: What share of the track was where no symbol is flown.
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
  rest_m: float
  astray: float
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
