"""What an observer's camera is, beyond its size and its field of view."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import checks
from waggle_tasks.protocol import lens as lens_lib

CODECS = ('none', 'jpeg', 'h264')
IDEAL = 'ideal'
NAMES = (IDEAL, 'ai_deck', 'fpv', 'phone', 'webcam')
# Under it shot noise is far from Gaussian.
MIN_ELECTRONS = 10.0

_LIMITS = {
  'pitch_deg': camera_lib.PITCH_DEG,
  'roll_deg': camera_lib.ROLL_DEG,
  'readout_s': camera_lib.READOUT_S,
  'shutter_s': (0.0, 0.1),
  'exposure_lag_s': (0.0, 10.0),
  'balance_lag_s': (0.0, 10.0),
  'vignette': (0.0, 1.0),
  'defocus_px': (0.0, 20.0),
  'read_noise': (0.0, 64.0),
  'well_electrons': (0.0, 1e6),
  'hot_share': (0.0, 0.01),
  'line_px': (0.0, 10.0),
  'jpeg_quality': (1, 100),
  'h264_crf': (0, 51),
  'vibration_px': (0.0, 5.0),
  'vibration_hz': (3.0, 12.0),
  'rolling_deg': (0.0, 10.0),
  'rolling_s': (0.3, 10.0),
}


class EyeError(errors.WaggleError):
  """A camera that does not exist, or whose parts do not go together."""


@dataclasses.dataclass(frozen=True)
class Eye:
  """A camera; by default the paper's, which shows what is there.

  Its effects act in the order in which they stand here. `Scenario` holds its
  size, its field of view and its rate.

  Attributes:
    eye: The camera that it began as, one of `NAMES`, with its size, its field
      of view and its rate; other values change it.
    pitch_deg: How far it looks up from the level, -45 to 45 degrees.
    roll_deg: How far it is turned clockwise about its axis, as who looks along
      it sees it, -180 to 180 degrees.
    vibration_px: Root mean square of its shaking along each axis of the middle
      of the picture, 0 to 5 px: it turns about its centre...
    vibration_hz: ...at about this frequency, 3 to 12 Hz.
    rolling_deg: Root mean square of its slow rolling about its axis, 0 to 10
      degrees...
    rolling_s: ...which becomes another in this time, 0.3 to 10 s.
    lens: How its lens bends lines, one of `lens_lib.MODELS`.
    k1: First radial number of the lens, see `lens_lib.Lens`.
    k2: Second radial number of the lens.
    p1: First tangential number of the lens 'brown'.
    p2: Second tangential number of the lens 'brown'.
    k3: Third radial number of the lens.
    k4: Fourth radial number of the lens 'fisheye'.
    readout_s: How long after its first row its last one is taken, 0 to 0.1 s; 0
      takes all of them at once.
    shutter_s: How long each row is exposed, 0 to 0.1 s.
    exposure_lag_s: Time constant of its exposure control, 0 to 10 s; 0 for a
      fixed exposure.
    balance_lag_s: Time constant of its white balance, 0 to 10 s; 0 for a fixed
      one.
    vignette: How much of the natural fall of light towards the corners its lens
      has, which is the fourth power of the cosine, 0 to 1.
    defocus_px: Standard deviation of its blur, 0 to 20 px.
    grey: Whether it sees no colours.
    mosaic: Whether each pixel sees one colour alone, as behind a Bayer mosaic.
    read_noise: Standard deviation of its noise in the dark, 0 to 64 grey
      levels.
    well_electrons: How many electrons make full white, 10 to 1e6; 0 for no shot
      noise.
    hot_share: Share of its pixels that are always white, 0 to 0.01.
    line_px: Standard deviation of a blur along each line, as of an analogue
      signal, 0 to 10 px.
    codec: How its pictures are coded on the way, one of `CODECS`; 'h264' takes
      the extra `video`.
    jpeg_quality: Quality of 'jpeg', 1 to 100.
    h264_crf: Rate factor of 'h264', 0 to 51: the larger, the coarser.
  """

  eye: str = IDEAL
  pitch_deg: float = 0.0
  roll_deg: float = 0.0
  vibration_px: float = 0.0
  vibration_hz: float = 6.0
  rolling_deg: float = 0.0
  rolling_s: float = 2.0
  lens: str = 'pinhole'
  k1: float = 0.0
  k2: float = 0.0
  p1: float = 0.0
  p2: float = 0.0
  k3: float = 0.0
  k4: float = 0.0
  readout_s: float = 0.0
  shutter_s: float = 0.0
  exposure_lag_s: float = 0.0
  balance_lag_s: float = 0.0
  vignette: float = 0.0
  defocus_px: float = 0.0
  grey: bool = False
  mosaic: bool = False
  read_noise: float = 0.0
  well_electrons: float = 0.0
  hot_share: float = 0.0
  line_px: float = 0.0
  codec: str = 'none'
  jpeg_quality: int = 90
  h264_crf: int = 23

  def __post_init__(self) -> None:
    checks.settle_numbers(self, _LIMITS, EyeError)
    for name in ('grey', 'mosaic'):
      on = checks.switch(name, getattr(self, name), EyeError)
      checks.settle(self, name, on)
    checks.choice('codec', self.codec, CODECS, EyeError)
    lens = self.optics  # Which checks itself.
    for each in dataclasses.fields(lens):
      if each.name != 'model':
        checks.settle(self, each.name, getattr(lens, each.name))
    if 0 < self.well_electrons < MIN_ELECTRONS:
      raise EyeError(
        f'`well_electrons` must be 0 or at least {MIN_ELECTRONS:g}:'
        f' got {self.well_electrons!r}'
      )
    if self.grey and self.mosaic:
      raise EyeError(
        '`mosaic` must be False for a camera that sees no colours: got `grey`'
        ' and `mosaic`'
      )
    checks.choice('eye', self.eye, NAMES, EyeError)
    if self.eye != IDEAL and self.is_ideal:
      raise EyeError(
        f'`eye` {self.eye!r} must come with its values: take them from'
        f' eye_presets.fields({self.eye!r})'
      )

  @property
  def optics(self) -> lens_lib.Lens:
    """What its lens does."""
    return lens_lib.Lens(
      self.lens, self.k1, self.k2, self.p1, self.p2, self.k3, self.k4
    )

  def camera(
    self, columns: int, rows: int, fovy_deg: float
  ) -> camera_lib.Camera:
    """Its calibration, for pictures of a size and a vertical field of view."""
    return camera_lib.Camera.of(
      columns, rows, fovy_deg, self.optics, self.pitch_deg, self.roll_deg,
      self.readout_s,
    )  # fmt: skip

  @property
  def is_ideal(self) -> bool:
    """Whether its pictures are those of the paper's camera."""
    return dataclasses.replace(self, eye=IDEAL) == Eye()

  @property
  def shakes(self) -> bool:
    """Whether it turns beside the vehicle that carries it."""
    return bool(self.vibration_px or self.rolling_deg)

  @property
  def takes_s(self) -> float:
    """From the first light of its first row to the last of its last one."""
    return self.readout_s + self.shutter_s
