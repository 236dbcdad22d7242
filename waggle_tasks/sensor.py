"""What spoils an observer's images: light, camera and the way they come."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks

# The longest that an episode can last: a length that outlasts every one.
ALWAYS_S = 600.0
# Under it shot noise is far from Gaussian, and wider than a fifth of white.
MIN_PHOTONS = 10.0

_LIMITS = {
  'noise_sigma': (0.0, 128.0),
  'photons': (0.0, 1e6),
  'exposure_s': (0.0, 0.1),
  'step_gain': (0.1, 10.0),
  'step_s': (0.0, ALWAYS_S),
  'flicker_share': (0.0, 1.0),
  'flicker_hz': (0.0, 1000.0),
  'blackout_s': (0.0, ALWAYS_S),
  'blackout_length_s': (0.0, ALWAYS_S),
  'blackout_every_s': (0.0, ALWAYS_S),
  'blackout_share': (0.0, 1.0),
  'repeated_share': (0.0, 1.0),
  'freeze_s': (0.0, ALWAYS_S),
  'freeze_length_s': (0.0, ALWAYS_S),
  'late_frames': (0, 25),  # A second of the paper's camera.
  'dropped_share': (0.0, 1.0),
}


class SensorError(errors.WaggleError):
  """A disturbance of images of no sensible size."""


@dataclasses.dataclass(frozen=True)
class Sensor:
  """The disturbances of one observer's images; by default there are none.

  They act in the order in which they stand here: on the light, in the camera,
  on its picture, and on the way to the observer. What is drawn, each observer
  draws for itself.

  Attributes:
    step_gain: Brightness from `step_s` on, 0.1 to 10; 1 is no step.
    step_s: When brightness changes by `step_gain`, in s.
    flicker_share: Amplitude of flicker as a share of brightness, 0 to 1: a sine
      of a phase that is drawn.
    flicker_hz: Frequency of flicker, 0 to 1000 Hz; images fold it, so that of
      25 a second 25, 50 and 100 Hz are a constant.
    exposure_s: How long an image is exposed, 0 to the time from one image to
      the next, in s. The motion between two images is blended from both: the
      share of the preceding one is exposure_s over twice that time, a half at
      most.
    noise_sigma: Standard deviation of Gaussian noise in grey levels, 0 to
      128.
    photons: How many photons make full white, 10 to 1e6; 0 for no shot noise.
      Its variance is proportional to the level: 255 level / photons.
    blackout_s: When the picture turns black, in s.
    blackout_length_s: For how long the picture is black, in s; 0 for never, 600
      for the rest.
    blackout_every_s: How long after its begin the picture turns black again, in
      s, and so on; 0 for once, else longer than it is black.
    blackout_share: Share of the width of the picture that turns black, from the
      left.
    repeated_share: Probability that the last picture comes again, with a new
      time.
    freeze_s: When the picture freezes, in s: later ones repeat it, with new
      times.
    freeze_length_s: For how long the picture is frozen, in s; 0 for never, 600
      for the rest.
    late_frames: How many frames after its time an image comes, 0 to 25. As
      nothing came before it, the first one also stands for those in between.
    dropped_share: Probability that nothing comes in a frame: the observation
      holds the last image, with its old time.
  """

  step_gain: float = 1.0
  step_s: float = 0.0
  flicker_share: float = 0.0
  flicker_hz: float = 1.0
  exposure_s: float = 0.0
  noise_sigma: float = 0.0
  photons: float = 0.0
  blackout_s: float = 0.0
  blackout_length_s: float = 0.0
  blackout_every_s: float = 0.0
  blackout_share: float = 1.0
  repeated_share: float = 0.0
  freeze_s: float = 0.0
  freeze_length_s: float = 0.0
  late_frames: int = 0
  dropped_share: float = 0.0

  def __post_init__(self) -> None:
    checks.settle_numbers(self, _LIMITS, SensorError)
    if 0 < self.photons < MIN_PHOTONS:
      raise SensorError(
        f'`photons` must be 0 or at least {MIN_PHOTONS:g}: got {self.photons!r}'
      )
    if 0 < self.blackout_every_s <= self.blackout_length_s:
      raise SensorError(
        '`blackout_every_s` must be 0, or more than the `blackout_length_s` of'
        f' {self.blackout_length_s:g}: got {self.blackout_every_s!r}'
      )

  @property
  def is_clean(self) -> bool:
    """Whether images come as they were rendered."""
    return self.step_gain == 1 and not (
      self.flicker_share
      or self.exposure_s
      or self.noise_sigma
      or self.photons
      or (self.blackout_length_s and self.blackout_share)
      or self.repeated_share
      or self.freeze_length_s
      or self.late_frames
      or self.dropped_share
    )
