"""Hover drift: vehicles that are never quite where they want to be.

A drift is a sum of cosines of random phases, so it is smooth, of zero mean and
known at any time, with its velocity and acceleration. Their frequencies lie
evenly in a band, so that it wanders as randomly as the band allows. It is
added to the reference, and the controller flies it. A `hover` that was measured
comes on top: it has all frequencies, and leans.
"""

import dataclasses
import math

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import agreement, checks, minimum_jerk
from waggle_tasks.tasks import hover as hover_lib
from waggle_tasks.tasks import hover_presets, slide

HOVERS = ('none', *hover_presets.PRESETS, 'log')

# Frequencies, times the drift's time: a correlation that is gone after about
# one time, and waves short enough for half a minute to show their rms.
_BAND = (0.3, 1.8)
_WAVES = 10
# A vehicle begins at its place, and its drift grows from nothing.
_GROWTH_S = 2.0


class DriftError(errors.WaggleError):
  """A drift that cannot be flown."""


@dataclasses.dataclass(frozen=True)
class Drift:
  """How far vehicles wander from where they should be.

  Attributes:
    performer_drift_m: Root mean square of the performer's drift along each
      axis, 0 to 0.03 m.
    observer_drift_m: Root mean square of each observer's drift along each axis,
      0 to 0.03 m.
    observer_yaw_drift_deg: Root mean square of each observer's drift in
      heading, 0 to 5 degrees.
    drift_time_s: Time in which a drift becomes another, 0.3 to 10 s; the
      attitude loop of a small vehicle corrects faster, and its position loop
      not much slower, than 1 s.
    observer_slide_mps: Largest speed of each observer's slow way to and fro in
      20 s, along a line that is drawn, 0 to 0.02 m/s.
    observer_turn_dps: Largest rate of its heading on such a way, 0 to 1 degrees
      a second.
    performer_hover: How the performer hovers beside that, as it was measured:
      one of `HOVERS`.
    observer_hover: How each observer hovers beside that: one of `HOVERS`.
    hover_amplitude: By how much the measured hovers are multiplied, 0 to 2.
    hover_log: The hover of a log of one's own, where one of them is 'log': a
      `hover.Spectrum`. As a flag, the file of the log.
  """

  performer_drift_m: float = 0.0
  observer_drift_m: float = 0.0
  observer_yaw_drift_deg: float = 0.0
  drift_time_s: float = 1.0
  observer_slide_mps: float = 0.0
  observer_turn_dps: float = 0.0
  performer_hover: str = 'none'
  observer_hover: str = 'none'
  hover_amplitude: float = 1.0
  hover_log: hover_lib.Spectrum | None = None

  def __post_init__(self) -> None:
    limits = {
      'performer_drift_m': (0.0, 0.03),
      'observer_drift_m': (0.0, 0.03),
      'observer_yaw_drift_deg': (0.0, 5.0),
      'drift_time_s': (0.3, 10.0),
      'observer_slide_mps': (0.0, 0.02),
      'observer_turn_dps': (0.0, 1.0),
      'hover_amplitude': (0.0, 2.0),
    }
    checks.settle_numbers(self, limits, DriftError)
    self._check_hover()

  def _check_hover(self) -> None:
    for field in ('performer_hover', 'observer_hover'):
      checks.choice(field, getattr(self, field), HOVERS, DriftError)
    names = self.performer_hover, self.observer_hover
    log = self.hover_log
    if not isinstance(log, hover_lib.Spectrum | None):
      raise DriftError(f'`hover_log` must be a hover.Spectrum: got {log!r}')
    if ('log' in names) != (log is not None):
      raise DriftError(
        '`hover_log` must be given where `performer_hover` or `observer_hover`'
        f" is 'log', and only there: got {'one' if log else 'none'} for {names}"
      )

  @property
  def near_m(self) -> float:
    """How much nearer it brings two vehicles, all but surely.

    Four times the root mean square for each of them, and all of a slow way.
    """
    performer_m = math.hypot(self.performer_drift_m, self._rms_m('performer'))
    observer_m = math.hypot(self.observer_drift_m, self._rms_m('observer'))
    slide_m = 2 * slide.reach(self.observer_slide_mps)
    return 4 * (observer_m + max(performer_m, observer_m)) + 2 * slide_m

  def performer(
    self,
    random_state: np.random.RandomState,
    yaw_rad: float = 0.0,
    rate_hz: float = agreement.Agreement.rate_hz,
  ) -> 'Sway':
    """A performer's drift in one episode.

    Args:
      random_state: Of the episode.
      yaw_rad: Its heading.
      rate_hz: How many references there are in a second.
    """
    return self._sway('performer', 0.0, random_state, yaw_rad, rate_hz)

  def observer(
    self,
    random_state: np.random.RandomState,
    yaw_rad: float = 0.0,
    rate_hz: float = agreement.Agreement.rate_hz,
  ) -> 'Sway':
    """An observer's drift in one episode; see `performer`."""
    turn_rad = math.radians(self.observer_yaw_drift_deg)
    sway = self._sway('observer', turn_rad, random_state, yaw_rad, rate_hz)
    rates = self.observer_slide_mps, math.radians(self.observer_turn_dps)
    if not any(rates):
      return sway
    return dataclasses.replace(sway, way=slide.Slide(*rates, random_state))

  def _sway(
    self,
    role: str,
    turn_rad: float,
    random_state: np.random.RandomState,
    yaw_rad: float,
    rate_hz: float,
  ) -> 'Sway':
    rms_m = getattr(self, f'{role}_drift_m')
    rms = np.array([rms_m, rms_m, rms_m, turn_rad])
    wander = Wander(rms, self.drift_time_s, random_state)
    spectrum = self._spectrum(role)
    if spectrum is None:
      return Sway(wander)
    drawn = hover_lib.Hover(
      spectrum, self.hover_amplitude, random_state, yaw_rad, rate_hz
    )
    return Sway(wander, drawn)

  def _spectrum(self, role: str) -> hover_lib.Spectrum | None:
    """What the hover of a role is drawn from."""
    name = getattr(self, f'{role}_hover')
    if not self.hover_amplitude:
      return None
    if name == 'log':
      return self.hover_log
    preset = hover_presets.PRESETS.get(name)
    return None if preset is None else preset.spectrum

  def _rms_m(self, role: str) -> float:
    spectrum = self._spectrum(role)
    return self.hover_amplitude * spectrum.rms_m if spectrum else 0.0


@dataclasses.dataclass(frozen=True, eq=False)
class Sway:
  """One vehicle's drift in one episode, and its hover if it has one.

  Attributes:
    wander: The drift.
    hover: The hover that comes on top.
    way: The slow way that comes on top, if there is one.
  """

  wander: 'Wander'
  hover: hover_lib.Hover | None = None
  way: slide.Slide | None = None

  def at(self, time_s: float) -> tuple[np.ndarray, ...]:
    """Both, their velocity and their acceleration, (4,) each, at a time.

    The heading is the drift's; that of a hover is part of its `attitude`.
    """
    drift = self.wander.at(time_s)
    if self.way is not None:
      drift = tuple(np.array(drift) + self.way.at(time_s))
    if self.hover is None:
      return drift
    both = np.array(drift)
    both[:, :3] += self.hover.place(time_s)
    return tuple(both)

  def attitude(self, time_s: float) -> np.ndarray | None:
    """The hover's roll, pitch and yaw, see `hover_lib.Hover.attitude`."""
    return None if self.hover is None else self.hover.attitude(time_s)


class Wander:
  """One vehicle's drift in one episode: x, y, z in m and heading in rad."""

  def __init__(
    self,
    rms: np.ndarray,  # (4,)
    time_s: float,
    random_state: np.random.RandomState,
  ) -> None:
    """Draws the drift; without any nothing is drawn.

    Args:
      rms: Root mean squares of x, y, z and heading.
      time_s: Time in which a drift becomes another.
      random_state: Of the episode.
    """
    self._amplitude = rms[:, None] * math.sqrt(2 / _WAVES)  # (4, 1)
    self._still = not rms.any()
    if self._still:
      return
    share = random_state.uniform(0.25, 0.75, (4, _WAVES))
    low, high = _BAND
    place = (np.arange(_WAVES) + share) / _WAVES  # One in each part, apart.
    self._rate = (low + (high - low) * place) / time_s  # (4, W) rad/s
    self._phase = random_state.uniform(0, 2 * math.pi, (4, _WAVES))

  def at(self, time_s: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The drift, its velocity and its acceleration, (4,) each, at a time."""
    if self._still:
      return np.zeros(4), np.zeros(4), np.zeros(4)
    angle = self._rate * time_s + self._phase
    wave = self._amplitude * np.cos(angle)
    slope = -self._amplitude * np.sin(angle)
    place = wave.sum(axis=1)
    rate = (slope * self._rate).sum(axis=1)
    second_rate = -(wave * self._rate**2).sum(axis=1)
    grown, growth, second = minimum_jerk.progress(time_s, _GROWTH_S)
    return (
      grown * place,
      grown * rate + growth * place,
      grown * second_rate + 2 * growth * rate + second * place,
    )
