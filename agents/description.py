"""What a receiver asks of what it sees, as it is told to people.

Pages draw it beside what was seen, and launchers refuse a dance whose pauses
are too short. Whatever a receiver does not tell is left out there.
"""

from collections.abc import Callable
import dataclasses

from waggle_tasks.agents import config as config_lib
from waggle_tasks.agents import views


@dataclasses.dataclass(frozen=True)
class Measure:
  """A number that a receiver's track has for each image.

  Attributes:
    name: What it is.
    unit: Its unit.
    limits: Where lines are drawn.
    rule: What the lines mean.
  """

  name: str
  unit: str
  limits: tuple[float, ...] = ()
  rule: str = ''


@dataclasses.dataclass(frozen=True)
class Null:
  """What a receiver takes for a null.

  Attributes:
    hold_s: How long stillness must last.
    end_s: How much stillness it needs before, to see that a motion is over.
    separators: Whether it asks for nulls between motions.
  """

  hold_s: float
  end_s: float = 0.0
  separators: bool = True


@dataclasses.dataclass(frozen=True)
class Description:
  """The limits of a receiver.

  Attributes:
    null: What it takes for a null.
    max_gap_s: Longest time between two images of one track.
    reach_px: How far a target may go from one image to the next.
    place: How far the target is from where it rests.
    speed: How fast it is.
    support: How much of the picture a track stands on.
    quality: How good a track is, 0 to 1.
    recognition: What scores of a motion are held against.
    templates: Makes what motions are compared with.
    frames: What a frame that is read as a whole must keep, a line each.
  """

  null: Null | None = None
  max_gap_s: float | None = None
  reach_px: float | None = None
  place: Measure = Measure('position', 'px from anchor')
  speed: Measure = Measure('speed', 'px/s, log')
  support: Measure = Measure('support', '')
  quality: Measure = Measure('quality', '0 to 1')
  recognition: config_lib.RecognitionLimits | None = None
  templates: Callable[[], views.Templates] | None = None
  frames: tuple[str, ...] = ()


def of(config: config_lib.Config, width_px: float | None) -> Description:
  """The limits of a tracker, a segmenter and a recogniser; no templates.

  Args:
    config: Their numbers.
    width_px: How wide the target is, where that is known.
  """
  tracking, motion, rest = config.tracking, config.motion, config.stillness
  reach_px = None
  if isinstance(tracking, config_lib.Tracking):
    reach_px = tracking.window_px
    support = Measure(
      'support', 'features', (tracking.min_support,),
      f'at least {tracking.min_support}',
    )  # fmt: skip
    words = 'kept ratio', 'no f-b check'
    if tracking.forward_backward:
      words = 'f-b ratio', '0 to 1'
    least = tracking.min_quality
  else:
    support = Measure('support', 'pixels')
    words, least = ('share seen', 'of the target'), tracking.lost_share
  place, speed, end_s = _motion(motion, rest.anchor_px, width_px)
  return Description(
    Null(rest.hold_s, end_s, config.framing.separators),
    tracking.max_gap_s,
    reach_px,
    place,
    speed,
    support,
    Measure(
      *words,
      (rest.null_quality, least),
      f'a null needs {rest.null_quality:g}, the track {least:g}',
    ),
    config.recognition,
  )


def _motion(
  motion: config_lib.Motion | config_lib.Excursion,
  rest_px: float,
  width_px: float | None,
) -> tuple[Measure, Measure, float]:
  """Where motions begin and end, by place and speed, and for how long."""
  places: tuple[float, ...] = -rest_px, rest_px
  place = f'a null stays within {rest_px:g} px'
  if isinstance(motion, config_lib.Motion):
    speeds: tuple[float, ...] = motion.off_px_s, motion.on_px_s
    speed = (
      f'motion begins over {motion.on_px_s:g} px/s and ends under'
      f' {motion.off_px_s:g} px/s'
    )
    end_s = motion.off_s
  else:
    away = f'{motion.radius_widths:g} widths, at least {motion.radius_px:g} px'
    slow_px_s, end_s = motion.off_px_s, 0.0  # A rest counts from its begin.
    slow = f'{motion.off_widths_s:g} widths/s, at least {slow_px_s:g} px/s'
    if width_px is not None:
      away_px, slow_px_s = motion.away_px(width_px), motion.slow_px_s(width_px)
      places += -away_px, away_px
      away = f'{away_px:.1f} px ({away})'
      slow = f'{slow_px_s:.1f} px/s ({slow})'
    place += f', a motion leaves its rest by {away}; more where a hover wanders'
    speeds, speed = (slow_px_s,), f'motion ends under {slow}'
  return (
    Measure('position', 'px from anchor', places, place),
    Measure('speed', 'px/s, log', speeds, speed),
    end_s,
  )
