"""Every number of the receiver, named after the section it comes from."""

import dataclasses

from waggle_tasks.agents import group, viewpoints
from waggle_tasks.agents import wandering as wandering_lib
from waggle_tasks.protocol import camera, frame


@dataclasses.dataclass(frozen=True)
class Tracking(group.Group):
  """Feature tracking; the paper names the method and gives no numbers.

  Attributes:
    box_px: Side of the square, around the track, in which features are found.
    max_corners: Most features at a time.
    corner_quality: Weakest corner, as a share of the strongest (Shi-Tomasi).
    corner_distance_px: Smallest distance between two new features.
    window_px: Side of the Lucas-Kanade window.
    levels: Pyramid levels above the image.
    forward_backward: Whether features are also tracked back, and dropped where
      they do not return to where they were.
    forward_backward_px: Largest error of tracking there and back, and largest
      difference of a feature's way from that of all.
    min_support: Fewest surviving features of a valid frame.
    min_quality: Smallest share of surviving features (paper, section 'Visual
      null confirmation': tracking quality at least 0.2).
    redetect_below: Look for new features when fewer are left.
    coast_s: How long a gesture may be out of sight.
    max_gap_s: Longest time between two images of one track.
  """

  box_px: int = group.number(72, 8, 4096)
  max_corners: int = group.number(40, 1, 10_000)
  corner_quality: float = group.number(0.05, 1e-6, 1)
  corner_distance_px: float = 3.0
  window_px: int = group.number(15, 3, 255)
  levels: int = group.number(2, 0, 10)
  forward_backward: bool = True
  forward_backward_px: float = 1.0
  min_support: int = group.number(5, 1, 10_000)
  min_quality: float = group.number(0.2, 0, 1)
  redetect_below: int = group.number(20, 0, 10_000)
  coast_s: float = 0.2
  max_gap_s: float = 0.3


@dataclasses.dataclass(frozen=True)
class Differencing(group.Group):
  """Tracking by difference from a learned background.

  Attributes:
    learn_s: How much stillness makes a background.
    watch_px: Side of the square, in the middle, in which motion first shows.
    min_contrast: Fewest grey levels between what is in the middle and what is
      around it: less is nothing to look at.
    min_levels: Weakest difference that counts in images without noise.
    noise_levels: Noise above which difference energy in boxes is used...
    box_px: ...of this side...
    box_sigmas: ...so many standard deviations above that of noise alone.
    watch_sigmas: The same while nothing but noise may be there.
    focal_px: Focal length of the camera, whose turns are undone.
    slack_px: How far pictures of a camera that sways may be out of place once
      they are aligned...
    rest_px: ...and how far a target may sway before it has ever moved.
    follow_s: Over how long pictures of such a camera are averaged, after which
      the background follows them...
    follow_px: ...where it has moved by no more than this meanwhile.
    speed_s: Over how long speed is measured; longer in noise and while swaying.
    speed_noise: Up to this it is none, in grey levels.
    gate_widths: Half the side of the square around the target in which it is
      looked for, in apparent widths...
    gate_px: ...and so many pixels more.
    middle_px: How far to a side of the middle a target may hover...
    middle_widths: ...or so many apparent widths.
    lost_share: Smallest share of the hovering target's difference.
    most_share: Largest share of it: a target that comes close grows.
    most_wider: How many times wider or narrower it may come to look, 0: any...
    most_higher: ...and higher: what is flat looks so from above and below.
    sway_wider: The same of a target that leaves its place before a camera that
      sways, where nothing else is proof, if any may look so elsewhere...
    sway_higher: ...and higher.
    reach_widths: How far from where it hovered, in apparent widths, it is
      sought when it was lost, 0 for anywhere.
    separate_s: How long a first motion may take to leave its own ghost.
    forget_s: How long another picture may hide a scene in which nothing has
      left its place yet, before that one is learned.
    relearn_s: How long a target may be lost before all is learned anew.
    max_gap_s: Longest time between two images of one rest.
  """

  learn_s: float = group.number(1.5, 0.1, 600)
  watch_px: int = group.number(240, 16, 100_000)
  min_contrast: float = group.number(12.0, 0, 255)
  min_levels: int = group.number(6, 1, 255)
  noise_levels: float = group.number(1.5, 0, 255)
  box_px: int = group.number(5, 1, 255)
  box_sigmas: float = 4.0
  watch_sigmas: float = 8.0
  focal_px: float = group.number(camera.Camera.focal_px, 1, 1e5)
  slack_px: float = group.number(1.0, 0, 64)
  rest_px: float = 16.0
  follow_s: float = group.number(0.4, 0.04, 60)
  follow_px: int = group.number(3, 0, 64)
  speed_s: float = group.number(0.4, 0.04, 60)
  speed_noise: float = group.number(4.0, 0, 255)
  gate_widths: float = 0.9
  gate_px: float = 8.0
  middle_px: float = 24.0
  middle_widths: float = 1.0
  lost_share: float = group.number(0.1, 0, 1)
  most_share: float = group.number(6.0, 1, 1000)
  most_wider: float = group.number(0.0, 0, 1000)
  most_higher: float = group.number(0.0, 0, 1000)
  sway_wider: float = group.number(1.5, 0, 1000)
  sway_higher: float = group.number(2.5, 0, 1000)
  reach_widths: float = group.number(0.0, 0, 1000)
  separate_s: float = 4.0
  forget_s: float = 1.5
  relearn_s: float = 10.0
  max_gap_s: float = 0.2

  @property
  def swaying(self) -> 'Differencing':
    """The numbers where a camera sways before the target has moved."""
    if self.most_wider:
      return self
    return dataclasses.replace(
      self, most_wider=self.sway_wider, most_higher=self.sway_higher
    )


@dataclasses.dataclass(frozen=True)
class Motion(group.Group):
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
class Excursion(group.Group):
  """When a gesture begins and ends, for a tracker of absolute positions.

  Attributes:
    radius_widths: How far from rest a target is away, in apparent widths...
    radius_px: ...and at least so far...
    on_s: ...once it has been so for this long.
    lead_s: How long before that its way begins.
    off_px_s: Image speed below which it is at rest again (paper, section 'RGB
      optical flow')...
    off_widths_s: ...or below so many apparent widths a second: whoever hovers
      near sways by more pixels...
    off_s: ...once back for this long; shorter than the paper's, as speed is
      measured over several images...
    stay_s: ...or anywhere else for this long.
    coast_s: How long a gesture may be out of sight.
    outside_s: How long it may be out of the picture.
  """

  radius_widths: float = 0.12
  radius_px: float = 2.0
  on_s: float = 0.08
  lead_s: float = group.number(1.0, 0.04, 60)
  off_px_s: float = 2.5
  off_widths_s: float = 0.15
  off_s: float = 0.48
  stay_s: float = 3.0
  coast_s: float = 0.5
  outside_s: float = 5.0

  def away_px(self, width_px: float) -> float:
    """How far from rest a target of this apparent width is away."""
    return max(self.radius_px, self.radius_widths * width_px)

  def slow_px_s(self, width_px: float) -> float:
    """The image speed below which a target of this apparent width rests."""
    return max(self.off_px_s, self.off_widths_s * width_px)


@dataclasses.dataclass(frozen=True)
class RecognitionLimits(group.Group):
  """When a path is a symbol (paper, section 'RGB optical flow').

  Attributes:
    max_rmse: Largest error to the best template.
    min_margin: Smallest lead over the second best.
    max_closure: Largest distance from end to beginning, in spans.
    min_span_px: Smallest largest side of the path's bounding box...
    min_span_widths: ...in apparent widths of the target, where they are known.
  """

  max_rmse: float = 0.17
  min_margin: float = 0.075
  max_closure: float = 0.18
  min_span_px: float = 28.0
  min_span_widths: float = 0.3

  def least_span_px(self, width_px: float | None) -> float:
    """The smallest span of a target of this apparent width, or of unknown."""
    if width_px is None:
      return self.min_span_px
    return self.min_span_widths * width_px


@dataclasses.dataclass(frozen=True)
class Stillness(group.Group):
  """When stillness is a null (paper, section 'Visual null confirmation').

  Attributes:
    anchor_px: Largest distance from the initial image anchor.
    max_px_s: Largest image speed.
    hold_s: How long all of it must last.
    null_quality: Smallest tracking quality.
    max_widths_s: Largest speed in apparent widths of the target a second, where
      they are known and that is more; 0, as in the paper, for pixels alone.
    jump_widths: How far, in apparent widths, a picture may jump within a rest;
      0, as in the paper, for not at all...
    jump_s: ...and within how long it must be back at rest.
    in_sight_s: How long the target must be seen at rest without a break before
      a null is confirmed.
    max_stale_s: How long a camera that shimmers may show stale images in the
      final rest; 0, as in the paper, asks for no life.
    bridges: Whether a rest goes on after a loss of sight in which, by the
      agreed clock, no gesture can hide; else, as in the paper, it begins anew.
  """

  anchor_px: float = 15.0
  max_px_s: float = 2.5
  hold_s: float = 3.0
  null_quality: float = group.number(0.2, 0, 1)
  max_widths_s: float = 0.0
  jump_widths: float = 0.0
  jump_s: float = 0.6
  in_sight_s: float = 0.4
  max_stale_s: float = 0.0
  bridges: bool = False

  def slow_px_s(self, width_px: float | None) -> float:
    """The largest speed of a target of this apparent width, or of unknown."""
    return max(self.max_px_s, self.max_widths_s * (width_px or 0.0))

  def jump_px(self, width_px: float | None) -> float:
    """How far a target of this apparent width, or of unknown, may jump."""
    return self.jump_widths * (width_px or 0.0)


@dataclasses.dataclass(frozen=True)
class Config:
  """A receiver; the defaults are the paper's with its frozen thresholds.

  Attributes:
    tracking: How the target is followed; the type picks the tracker...
    motion: ...and how its track is cut, which goes with it.
    wandering: What a rest of a target that wanders may be, for an Excursion.
    recognition: When a path is a symbol.
    stillness: When stillness is a null.
    framing: Which nulls a message must have.
    views: Where gestures may be seen from; None for the front alone.
  """

  tracking: Tracking | Differencing = Tracking()
  motion: Motion | Excursion = Motion()
  wandering: wandering_lib.Wandering = wandering_lib.Wandering()
  recognition: RecognitionLimits = RecognitionLimits()
  stillness: Stillness = Stillness()
  framing: frame.Rules = frame.Rules()
  views: viewpoints.Views | None = None

  def __post_init__(self) -> None:
    group.check_kinds(self)


KLT = Config()
KLT_BANK = Config(views=viewpoints.Views())
ABSOLUTE = Config(
  Differencing(),
  Excursion(),
  stillness=Stillness(
    max_widths_s=0.15, jump_widths=0.1, max_stale_s=0.4, bridges=True
  ),
)
VIEW_BANK = dataclasses.replace(ABSOLUTE, views=viewpoints.Views())
