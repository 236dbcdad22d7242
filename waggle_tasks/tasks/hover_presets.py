"""Hovers that were measured, by name, with what their sources say.

Place, speed and attitude are root mean squares of windows of 4 s whose mean was
removed, the median of all windows. Where a source gives a range, its middle is
taken.

`mocap`: 46 windows of 30 flights of Crazyflies under motion capture, 2024-25,
whose logs are in the repository air_garage_cflib. Place and speed along x and
y, and both place and attitude by band, are theirs; so are roll, pitch and yaw,
there without their trend. They flew under a ceiling, so their z is not taken.
NanoBench (Crazyflie 2.1, Vicon, its own PID) has 10.8 mm and 19 mm/s along z,
in slow flights and not in hover; z is as strong as x here.

`lighthouse`: the Bitcraze positioning data set, Lighthouse with the Kalman
estimator: place 4.2-5.1 mm, speed 12-17 mm/s, roll and pitch 0.5-1.0 degrees,
yaw 0.22-0.25 degrees in the calmest flights, for every axis alike. It has no
bands; their shape is one with which place and speed fit, and the fastest is
that of `mocap`.

`flow_deck`: the same data set: place 3.3-6.8 mm, speed 14-37 mm/s. It has
attitude of flights only (2-4 degrees at 0.5 m/s). Roll and pitch are the upper
end of those of `lighthouse`, as so much speed takes so much tilt; yaw is as
there, and bands are made in the same way.

The slowest band of each is no figure of a source. Windows hardly show it; it is
as strong as makes them as large as they are.
"""

from collections.abc import Mapping
import dataclasses

from waggle_tasks.tasks import hover

# What one axis is said to do: its root mean square ('rms', mm or degrees), its
# rate ('speed', mm/s), and that of each band between two of `hover.EDGES_HZ`.
Figures = Mapping[str, float]
BANDS = ('0.2-0.55', '0.55-1', '1-2', '2-4', '4-10')


@dataclasses.dataclass(frozen=True, eq=False)
class Preset:
  """A hover that can be flown.

  Attributes:
    spectrum: What is flown.
    source: Where its figures come from.
    published: By axis, what the source says.
  """

  spectrum: hover.Spectrum
  source: str
  published: Mapping[str, Figures]


def _figures(rms: float, speed: float | None, *bands: float) -> Figures:
  moving = {} if speed is None else {'speed': speed}
  return {'rms': rms, **moving, **dict(zip(BANDS, bands, strict=False))}


def _alike(
  place_mm: tuple[float, ...],
  tilt_deg: tuple[float, ...],
  yaw_deg: tuple[float, ...],
) -> hover.Spectrum:
  """A hover that is as strong along every axis, and in roll as in pitch."""
  return hover.Spectrum(
    place_mm, place_mm, place_mm, tilt_deg, tilt_deg, yaw_deg
  )


_YAW_DEG = (0.34, 0.12, 0.06, 0.06, 0.06, 0.06)  # Of Lighthouse.

PRESETS: Mapping[str, Preset] = {
  'mocap': Preset(
    hover.Spectrum(
      x_mm=(10.8, 1.6, 1.65, 0.33, 0.15, 0.16),
      y_mm=(14.2, 1.3, 1.5, 0.28, 0.13, 0.12),
      z_mm=(10.8, 1.6, 1.65, 0.33, 0.15, 0.16),
      roll_deg=(0.76, 0.20, 0.29, 0.31, 0.41, 0.42),
      pitch_deg=(1.30, 0.40, 0.30, 0.46, 0.50, 0.40),
      yaw_deg=(1.75, 0.66, 0.27, 0.30, 0.31, 0.30),
    ),
    'motion capture of 30 flights, repository air_garage_cflib, 2024-25',
    {
      'x': _figures(5.6, 12.0, 3.3, 1.15, 0.30, 0.14, 0.15),
      'y': _figures(7.4, 11.0, 3.8, 1.0, 0.25, 0.12, 0.11),
      'roll': _figures(0.84, None, 0.29, 0.27, 0.30, 0.39, 0.41),
      'pitch': _figures(1.16, None, 0.42, 0.29, 0.42, 0.46, 0.38),
      'yaw': _figures(1.20, None, 0.81, 0.29, 0.28, 0.30, 0.29),
    },
  ),
  'lighthouse': Preset(
    _alike(
      (7.0, 2.2, 2.2, 0.60, 0.20, 0.16),
      (0.66, 0.20, 0.26, 0.30, 0.34, 0.34),
      _YAW_DEG,
    ),
    'Bitcraze positioning data set, Lighthouse with the Kalman estimator',
    {
      **dict.fromkeys('xyz', _figures(4.65, 14.5)),
      **dict.fromkeys(('roll', 'pitch'), _figures(0.75, None)),
      'yaw': _figures(0.235, None),
    },
  ),
  'flow_deck': Preset(
    _alike(
      (4.8, 2.5, 3.2, 1.75, 0.45, 0.20),
      (0.60, 0.22, 0.40, 0.65, 0.40, 0.30),
      _YAW_DEG,
    ),
    'Bitcraze positioning data set, flow deck',
    dict.fromkeys('xyz', _figures(5.05, 25.5)),
  ),
}
