"""How vehicles with rotors flew: tilt, thrusts, air, estimate against truth."""

import dataclasses
import math

import numpy as np

from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import archive, flown
from waggle_tasks.protocol import limits

_TOP, _HEIGHT = 22.0, 60.0
_LOOKS = 'a', 'b', 'c'

tag = markup.tag


@dataclasses.dataclass(frozen=True, eq=False)
class _Signal:
  """A panel: (T, K) values over time, with a name for each column."""

  title: str
  unit: str
  values: np.ndarray
  names: tuple[str, ...] = ('',)
  limits: plot.Limits | None = None


def draw(run: archive.Run) -> markup.Markup | None:
  """A part for each vehicle; None for vehicles without rotors.

  Raises:
    FlownError: if the run's file of flights is damaged.
  """
  flights, parts = flown.load(run.folder / flown.NAME), []
  if not flights:
    return None
  for name, each in flights.items():
    *signals, last = _signals(each)
    panels = [_panel(signal, run, False) for signal in signals]
    panels.append(_panel(last, run, True))
    parts += [
      tag('h3', name),
      tag('p', _words(each), class_='faint'),
      tag('div', markup.join(panels), class_='scroll'),
    ]
  return tag('section', tag('h2', 'Rotors'), *parts, id='rotors')


def _words(each: flown.Flown) -> str:
  low, high = limits.THRUST_N
  thrusts_n = each.thrusts_n
  at_limit = (thrusts_n <= low * 1.01) | (thrusts_n >= high * 0.99)
  tilt_deg = math.degrees(each.tilt_rad.max())
  words = (
    f'tilted by {tilt_deg:.1f} degrees at most; thrust of a rotor'
    f' {1e3 * thrusts_n.min():.1f} to {1e3 * thrusts_n.max():.1f} mN of'
    f' {1e3 * low:.1f} to {1e3 * high:.1f} mN, at a limit'
    f' {at_limit.any(axis=1).mean():.1%} of the time'
  )
  if each.error_m.any():
    rms_mm = 1e3 * math.sqrt((each.error_m**2).sum(axis=1).mean())
    words += f'; it took itself to be {rms_mm:.1f} mm (rms) from where it was'
  return f'{words}.'


def _signals(each: flown.Flown) -> list[_Signal]:
  """What there is to see of a vehicle."""
  axes = 'x', 'y', 'z'
  most_deg, milli = math.degrees(limits.TILT_RAD), 1e3 * each.thrusts_n
  out = [
    _Signal(
      'tilt',
      'degrees',
      np.degrees(each.tilt_rad)[:, None],
      limits=plot.Limits([most_deg], 'the most that is asked for'),
    ),
    _Signal(
      'thrust',
      'mN',
      np.stack([milli.min(axis=1), milli.max(axis=1)], axis=1),
      ('least', 'most'),
      plot.Limits([1e3 * each for each in limits.THRUST_N], 'what a rotor can'),
    ),
  ]
  if each.error_m.any():
    out.append(_Signal('estimate', 'mm off', 1e3 * each.error_m, axes))
  if each.air_mps.any():
    out.append(_Signal('air', 'm/s', each.air_mps, axes))
  return out


def _panel(signal: _Signal, run: archive.Run, last: bool) -> markup.Markup:
  looks = zip(signal.values.T, _LOOKS, signal.names, strict=False)
  lines = [plot.Curve(*each) for each in looks]
  ends = signal.limits.values if signal.limits else ()
  reached = np.append(signal.values.ravel(), ends)
  low, high = min(reached.min(), 0.0), max(reached.max(), 1e-3)
  margin = 0.05 * (high - low)
  scale = plot.Scale(low - margin, high + margin, _TOP + _HEIGHT, _TOP)
  return plot.panel(
    signal.title, signal.unit, run.times_s, lines, scale, run.end_s,
    signal.limits, last,
  )  # fmt: skip
