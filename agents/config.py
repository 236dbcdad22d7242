"""Every number of the receiver, named after the section it comes from."""

import dataclasses
import math


@dataclasses.dataclass(frozen=True)
class Tracking:
  """Feature tracking; the paper names the method and gives no numbers.

  Attributes:
    box_px: Side of the square, around the track, in which features are found.
    max_corners: Most features at a time.
    corner_quality: Weakest corner, as a share of the strongest (Shi-Tomasi).
    corner_distance_px: Smallest distance between two new features.
    window_px: Side of the Lucas-Kanade window.
    levels: Pyramid levels above the image.
    forward_backward_px: Largest error of tracking there and back.
    min_support: Fewest surviving features of a valid frame.
    min_quality: Smallest share of surviving features (paper, section 'Visual
      null confirmation': tracking quality at least 0.2).
    redetect_below: Look for new features when fewer are left.
    coast_frames: Lost frames that a gesture survives.
    max_gap_s: Longest time between two images of one track.
  """

  box_px: int = 72
  max_corners: int = 40
  corner_quality: float = 0.05
  corner_distance_px: float = 3.0
  window_px: int = 15
  levels: int = 2
  forward_backward_px: float = 1.0
  min_support: int = 5
  min_quality: float = 0.2
  redetect_below: int = 20
  coast_frames: int = 5
  max_gap_s: float = 0.2


@dataclasses.dataclass(frozen=True)
class Motion:
  """When a gesture begins and ends (paper, section 'RGB optical flow').

  Attributes:
    on_px_s: Image speed above which motion begins...
    on_s: ...once it has lasted this long.
    off_px_s: Image speed below which motion ends...
    off_s: ...once it has lasted this long.
  """

  on_px_s: float = 3.5
  on_s: float = 0.08
  off_px_s: float = 2.5
  off_s: float = 0.68


@dataclasses.dataclass(frozen=True)
class Recognition:
  """When a path is a symbol (paper, section 'RGB optical flow').

  Attributes:
    max_rmse: Largest error to the best template.
    min_margin: Smallest lead over the second best.
    max_closure: Largest distance from end to beginning, in spans.
    min_span_px: Smallest largest side of the path's bounding box.
  """

  max_rmse: float = 0.17
  min_margin: float = 0.075
  max_closure: float = 0.18
  min_span_px: float = 28.0


@dataclasses.dataclass(frozen=True)
class Stillness:
  """When stillness is a null (paper, section 'Visual null confirmation').

  Attributes:
    anchor_px: Largest distance from the initial image anchor.
    max_px_s: Largest image speed.
    hold_s: How long all of it must last.
  """

  anchor_px: float = 15.0
  max_px_s: float = 2.5
  hold_s: float = 3.0


@dataclasses.dataclass(frozen=True)
class Config:
  """The paper's receiver with the paper's frozen thresholds."""

  tracking: Tracking = Tracking()
  motion: Motion = Motion()
  recognition: Recognition = Recognition()
  stillness: Stillness = Stillness()


def lasted(since_s: float, now_s: float, duration_s: float) -> bool:
  """Whether a duration is over, to a microsecond.

  Frame times are multiples of 0.04 s in floating point, and so are most
  durations; exact comparison would be decided by rounding.
  """
  return now_s - since_s > duration_s - 1e-6 and math.isfinite(since_s)
