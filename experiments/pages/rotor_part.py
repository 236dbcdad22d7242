"""How vehicles with rotors flew: tilt, thrusts, air, estimate against truth."""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.experiments.pages import markup, plot
from waggle_tasks.experiments.record import archive, flown
from waggle_tasks.protocol import limits

_TOP, _HEIGHT = 22.0, 60.0
_LOOKS = 'a', 'b', 'c'

tag = markup.tag


def draw(run: archive.Run) -> markup.Markup | None:
  """A part for each vehicle; None for vehicles without rotors."""
  if not run.flights:
    return None
  parts = []
  for name, each in run.flights.items():
    parts += [
      tag('h3', name),
      tag('p', _words(each), class_='faint'),
      tag('div', markup.join(_panels(run, each)), class_='scroll'),
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


def _panels(run: archive.Run, each: flown.Flown) -> list[markup.Markup]:
  """The panels of a vehicle, one below the other."""
  axes = 'x', 'y', 'z'
  milli = 1e3 * each.thrusts_n
  shown: list[tuple[str, str, np.ndarray, Sequence[str], plot.Limits | None]]
  shown = [
    (
      'tilt', 'degrees', np.degrees(each.tilt_rad)[:, None], ('',),
      plot.Limits([math.degrees(limits.TILT_RAD)], 'the most asked for'),
    ),
    (
      'thrust', 'mN', np.stack([milli.min(axis=1), milli.max(axis=1)], 1),
      ('least', 'most'),
      plot.Limits([1e3 * n for n in limits.THRUST_N], 'what a rotor can'),
    ),
  ]  # fmt: skip
  if each.error_m.any():
    shown.append(('estimate', 'mm off', 1e3 * each.error_m, axes, None))
  if each.air_mps.any():
    shown.append(('air', 'm/s', each.air_mps, axes, None))
  out = []
  for number, (title, unit, values, names, rule) in enumerate(shown):
    lines = [
      plot.Line(column, look, name)
      for column, look, name in zip(values.T, _LOOKS, names, strict=False)
    ]
    reached = np.append(values.ravel(), rule.values if rule else [])
    low, high = min(reached.min(), 0.0), max(reached.max(), 1e-3)
    margin = 0.05 * (high - low)
    scale = plot.Scale(low - margin, high + margin, _TOP + _HEIGHT, _TOP)
    out.append(
      plot.panel(
        title,
        unit,
        run.times_s,
        lines,
        scale,
        run.end_s,
        rule,
        last=number == len(shown) - 1,
      )  # fmt: skip
    )
  return out
