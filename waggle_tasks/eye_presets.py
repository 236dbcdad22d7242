"""Cameras by name, with the source of every number.

What is 'assumed' has no published source that we know of. Rates are the
nearest that are 250 over a whole number: 31.25 Hz stands for 30 Hz.
"""

from collections.abc import Mapping
import dataclasses
import types
from typing import Any, NoReturn

from waggle_tasks import eyes
from waggle_tasks.protocol import checks

# Assumed: about what cameras need to settle in other light.
_EXPOSURE_LAG_S, _BALANCE_LAG_S = 0.3, 1.0
# Lamps on mains of 50 Hz flicker at 100 Hz, which whole periods do not show.
_MAINS_S = 0.01


@dataclasses.dataclass(frozen=True)
class Preset:
  """A camera.

  Attributes:
    eye: Its value.
    camera_width_px: Width of its pictures...
    camera_height_px: ...and their height.
    camera_fovy_deg: Its vertical field of view.
    rate_hz: How many pictures it takes in a second.
  """

  eye: eyes.Eye
  camera_width_px: int
  camera_height_px: int
  camera_fovy_deg: float
  rate_hz: float

  @property
  def frame(self) -> dict[str, float]:
    """What it sets beside the eye, by the names of a scenario's fields."""
    return {
      field.name: getattr(self, field.name)
      for field in dataclasses.fields(self)
      if field.name != 'eye'
    }


# The Himax HM01B0 of Bitcraze's AI-deck. 324 x 244 pixels, grey, a rolling
# shutter, exposure control, and at most 60 pictures of that height a second,
# so that it is read in a sixtieth (Himax, HM01B0 datasheet). The module is
# HM01B0-...-00FT870, which we take for 87 degrees across the diagonal. Its
# lens, its noise and its exposure are assumed.
_AI_DECK = Preset(
  eyes.Eye(
    'ai_deck',
    readout_s=1 / 60,
    shutter_s=_MAINS_S,
    exposure_lag_s=_EXPOSURE_LAG_S,
    vignette=1.0,
    defocus_px=0.5,
    grey=True,
    read_noise=1.5,
    well_electrons=4000.0,
    hot_share=2e-5,
  ),
  324, 244, 59.45, 31.25,
)  # fmt: skip

# A camera as small racing vehicles carry it: a sensor of 1/3 inch, 4.8 x 3.6
# mm, behind a lens of 2.5 mm whose picture grows with the angle, which is 82.5
# degrees high and 110 wide. PAL: 25 pictures a second, 287.5 lines of 64 us in
# a field, 5 MHz of luminance in the 52 us of a line, which 640 pixels show
# (ITU-R BT.470, system B). The two fields of a picture are taken as one. A
# signal of 40 dB over its noise is assumed, as is how dark its corners are.
_FPV = Preset(
  eyes.Eye(
    'fpv',
    lens='fisheye',
    readout_s=287.5 * 64e-6,
    shutter_s=_MAINS_S,
    exposure_lag_s=_EXPOSURE_LAG_S,
    balance_lag_s=_BALANCE_LAG_S,
    vignette=0.3,
    defocus_px=0.6,
    mosaic=True,
    read_noise=2.55,
    line_px=0.33,
  ),
  640, 480, 82.5, 25.0,
)  # fmt: skip

# A phone that films 1280 x 720. Read in 31.98 ms, as was measured of an
# iPhone 4 (Forssen and Ringaby, Rectifying rolling shutter video from hand-held
# devices, 2010, and the table in the documentation of Kalibr). Its field is
# that of 26 mm before 36 x 24 mm, as makers print it, cut to 16:9. x264's
# default rate factor. Its full wells, of 5000 electrons, and the rest of its
# noise are assumed.
_PHONE = Preset(
  eyes.Eye(
    'phone',
    readout_s=31.98e-3,
    shutter_s=_MAINS_S,
    exposure_lag_s=_EXPOSURE_LAG_S,
    balance_lag_s=_BALANCE_LAG_S,
    vignette=0.5,
    defocus_px=0.6,
    mosaic=True,
    read_noise=1.0,
    well_electrons=5000.0,
    codec='h264',
    h264_crf=23,
  ),
  1280, 720, 42.55, 31.25,
)  # fmt: skip

# A Logitech C920 at 640 x 480. A focal length of 622.0 pixels and the lens are
# those that the SDK of the FIRST Tech Challenge has built in for it; its
# principal point is taken for the middle. Motion JPEG over USB. Its quality,
# its readout, noise and shading are assumed.
_WEBCAM = Preset(
  eyes.Eye(
    'webcam',
    lens='brown',
    k1=0.1208,
    k2=-0.261599,
    k3=0.10308,
    readout_s=0.03,
    shutter_s=_MAINS_S,
    exposure_lag_s=_EXPOSURE_LAG_S,
    balance_lag_s=_BALANCE_LAG_S,
    vignette=0.5,
    defocus_px=0.6,
    mosaic=True,
    read_noise=1.5,
    well_electrons=5000.0,
    codec='jpeg',
    jpeg_quality=85,
  ),
  640, 480, 41.728, 31.25,
)  # fmt: skip

# The paper's sets nothing else: its size and its rate are defaults.
PRESETS: Mapping[str, Preset] = types.MappingProxyType(
  {each.eye.eye: each for each in (_AI_DECK, _FPV, _PHONE, _WEBCAM)}
)


def fields(name: str) -> dict[str, Any]:
  """Fields of a scenario with a camera: `load('broadcast', **fields('phone'))`.

  Args:
    name: One of `eyes.NAMES`.

  Raises:
    EyeError: if it is none.
  """
  checks.choice('eye', name, eyes.NAMES, eyes.EyeError)
  if name == eyes.IDEAL:
    return {'eye': eyes.Eye()}
  preset = PRESETS[name]
  return {'eye': preset.eye, **preset.frame}


def settle(scene: Any, name: str) -> None:  # noqa: ANN401
  """Puts a camera into a frozen scenario that was made with its name.

  What is as by default becomes the camera's.

  Args:
    scene: The scenario, in its `__post_init__`.
    name: One of `eyes.NAMES`.

  Raises:
    EyeError: if it is none, or another size, field of view or rate was given.
  """
  usual = {each.name: each.default for each in dataclasses.fields(scene)}
  for field, value in fields(name).items():
    given = getattr(scene, field)
    if field != 'eye' and given not in (usual[field], value):
      refuse(field, name, value, given)
    checks.settle(scene, field, value)


def refuse(field: str, name: str, value: float, given: float) -> NoReturn:
  """Says that a camera has another size, field of view or rate."""
  raise eyes.EyeError(
    f'`{field}` must be {value:g} or left out with the `eye` {name!r}, which'
    f' sets it: got {given!r}'
  )
