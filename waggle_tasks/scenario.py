"""A scenario: every choice of one episode, frozen and checked."""

import dataclasses
import math

import numpy as np

from waggle_tasks import appearance as appearance_lib
from waggle_tasks import errors
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.arenas import bounds, layouts
from waggle_tasks.entities import optics
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import (
  alphabets,
  checks,
  clock,
  controls,
  flight,
  gestures,
  language_names,
  languages,
  packets,
  timing,
)
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import limits as limits_lib
from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import drift as drift_lib
from waggle_tasks.tasks import estimators
from waggle_tasks.tasks import safety as safety_lib
from waggle_tasks.tasks import surroundings as surroundings_lib

CONTROLS = controls.CONTROLS
LAYOUTS = ('arc', 'line')
# After the last gesture: the 3 s null, the flight, the hold, and time to spare.
AFTERMATH_S = 12.0
# What more those who avoid each other may take.
AVOIDING_S = 18.0
_DETOUR_M = 0.3  # How far those who avoid come from their ways, about.
NO_SEND_S = 10.0  # Paper, section 'Controls and supplemental suite'.
INTERRUPTED_S = 60.0  # The same.
MAX_OBSERVERS = 64
PAPER = 'paper'
_READ_S = 3.0  # After data, which nobody flies.
_SIDE_PX = (64, 2048)  # Of an image.
_CLEAR_M = 0.1  # From the highest point of a gesture to the ceiling.


class ScenarioError(errors.WaggleError):
  """A field of a scenario that breaks a rule."""


@dataclasses.dataclass(frozen=True)
class Scenario:
  """One episode's configuration; the defaults are the paper's (Table 2).

  Attributes:
    control: What is sent, and to whom: 'none' is a nominal broadcast; from
      'circles' on the performer flies what is no message. One of `CONTROLS`.
    observers: How many observers, 1 to 64.
    layout: Where observers stand: one of `LAYOUTS`, or in Python a
      `layouts.Layout` of your own.
    distance_m: Radius of the arc, or distance of the line, 0.2 to 4 m.
    half_span_deg: Angle from the middle of the arc to its end, 0 to 180
      degrees.
    bearing_deg: Angle by which the middle of the arc is turned about the
      performer, -180 to 180 degrees; one observer is there.
    spacing_m: Distance between neighbours in a line, in m; the paper gives
      none.
    payload: Its bits: one of direction, then as many of heading and of distance
      as `units` say, three and two in the paper.
    jitter_m: Bound of the initial x and y offset of every vehicle, in m.
    seed: Seed of the environment: of all that is drawn.
    black_observer: Which observer sees black images if `control` is
      'black_input'.
    stop_s: When transmission stops, in s, if `control` is 'interrupted'.
    duration_s: How long the episode lasts at most, in s; unset, 10 s without
      sending, 60 s when interrupted, else 12 s after the dance, 30 s where
      vehicles avoid each other, 3 s after data.
    language: What is spoken, 'paper' or one of `languages.LANGUAGES`, whose
      code may be changed, such as 'swift:check=crc4,parity=0'; or a
      `languages.Language` of your own, as a flag a JSON file of one, FILE.json.
      A language brings its own gestures and pauses.
    bits: Bits that are sent in place of the payload, in numbered packets with
      a check, in any language but the paper's; empty for the payload.
    repeat: How often all of it is said, 1 to 100; once in the paper.
    codebook: The agreed gestures.
    pauses: The agreed pauses.
    tolerance: How far from its time a motion may be seen.
    units: The agreed fields of the payload.
    appearance: How the room looks.
    surroundings: What else moves in it.
    dynamics: How vehicles fly, one of `limits_lib.DYNAMICS`: by ideal forces,
      as in the paper, which never tilt a vehicle, or by four rotors with lag
      and drag, under a cascade of laws.
    air: What the air does; only rotors feel it.
    estimator: How vehicles with rotors know where they are, one of
      `estimators.ESTIMATORS`: with none of them they know the truth, with
      another they wander by its errors.
    drift: How far vehicles wander from where they should be.
    safety: What is done about flights that would meet, one of
      `safety_lib.SAFETIES`: they are refused, as in the paper, or vehicles
      avoid each other.
    sensor: What spoils the observers' images.
    rate_hz: How many images and references there are in a second: 250 over a
      whole number, 10 to 125.
    hover_height_m: Where everybody hovers and where a message leads to, 0.5 to
      5.5 m above the floor.
    camera: How images are rendered, one of `optics.CAMERAS`; both give the same
      picture.
    camera_width_px: Width of the observers' images in pixels, 64 to 2048.
    camera_height_px: Height of the observers' images in pixels, 64 to 2048.
    camera_fovy_deg: Vertical field of view of the observers' images, 10 to 120
      degrees.
    eye_offset_m: How far an observer's eye is ahead of its centre of mass, in
      m.
  """

  control: str = 'none'
  observers: int = 3
  layout: str | layouts.Layout = 'arc'
  distance_m: float = 1.3
  half_span_deg: float = 30.0
  bearing_deg: float = 0.0
  spacing_m: float = 0.6
  payload: str = '000010'
  jitter_m: float = 0.0
  seed: int = 0
  black_observer: int = 2
  stop_s: float = 26.0
  duration_s: float | None = None
  language: str | languages.Language = PAPER
  bits: str = ''
  repeat: int = 1
  codebook: gestures.Codebook = gestures.v_codebook()
  pauses: timing.Timing = timing.Timing()
  tolerance: clock.Tolerance = clock.Tolerance()
  units: payload_lib.Units = payload_lib.Units()
  appearance: appearance_lib.Appearance = appearance_lib.Appearance()
  surroundings: surroundings_lib.Surroundings = surroundings_lib.Surroundings()
  dynamics: str = 'ideal'
  air: air_lib.Air = air_lib.Air()
  estimator: str = 'none'
  drift: drift_lib.Drift = drift_lib.Drift()
  safety: str = 'refuse'
  sensor: sensor_lib.Sensor = sensor_lib.Sensor()
  rate_hz: float = agreement_lib.Agreement.rate_hz
  hover_height_m: float = agreement_lib.Agreement.hover_height_m
  camera: str = 'incremental'
  camera_width_px: int = camera_lib.Camera.columns
  camera_height_px: int = camera_lib.Camera.rows
  camera_fovy_deg: float = camera_lib.FOVY_DEG
  eye_offset_m: float = optics.OFFSET_M

  def __post_init__(self) -> None:
    for field in dataclasses.fields(self):
      value, usual = getattr(self, field.name), field.default
      if dataclasses.is_dataclass(usual) and type(value) is not type(usual):
        raise ScenarioError(
          f'`{field.name}` must be a {type(field.default).__name__}:'
          f' got {value!r}'
        )
    checks.choice('control', self.control, CONTROLS, ScenarioError)
    checks.choice('dynamics', self.dynamics, limits_lib.DYNAMICS, ScenarioError)
    checks.choice(
      'estimator', self.estimator, estimators.ESTIMATORS, ScenarioError
    )
    checks.choice('safety', self.safety, safety_lib.SAFETIES, ScenarioError)
    self._check_dynamics()
    checks.choice('camera', self.camera, optics.CAMERAS, ScenarioError)
    counts = {
      'observers': (1, MAX_OBSERVERS),
      'seed': (0, 2**32 - 1),
      'camera_width_px': _SIDE_PX,
      'camera_height_px': _SIDE_PX,
      'camera_fovy_deg': (10.0, 120.0),
      'repeat': (1, 100),
    }
    checks.settle_numbers(self, counts, ScenarioError)
    self._check_language()
    agreed = self.agreement  # Which checks itself.
    for name in ('rate_hz', 'hover_height_m'):
      checks.settle(self, name, getattr(agreed, name))
    self._check_exposure(agreed.frame_s)
    limits = {
      'black_observer': (1, self.observers),
      'distance_m': (0.2, 4.0),
      'half_span_deg': (0.0, 180.0),
      'bearing_deg': (-180.0, 180.0),
      'spacing_m': (0.0, 4.0),
      'jitter_m': (0.0, 0.1),
      'stop_s': (0.0, 600.0),
      'eye_offset_m': (-0.1, 0.1),
      'duration_s': (agreed.frame_s, 600.0),
    }
    if self.control != 'black_input':
      del limits['black_observer']
    if self.duration_s is None:
      del limits['duration_s']
    checks.settle_numbers(self, limits, ScenarioError)
    limits_lib.check_motions(agreed.motions, limits_lib.LIMITS[self.dynamics])
    self._check_height()
    payload_lib.Payload.from_bits(self.payload, self.units)
    self.surroundings.check(self.poses(), self._reach_m())
    self._check_slots()

  @property
  def message(self) -> payload_lib.Payload:
    """The payload."""
    return payload_lib.Payload.from_bits(self.payload, self.units)

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides know."""
    seen_with = camera_lib.Camera.of(
      self.camera_width_px, self.camera_height_px, self.camera_fovy_deg
    )
    spoken = self._language()
    agreed = agreement_lib.Agreement(
      self.codebook,
      self.pauses,
      self.tolerance,
      self.units,
      seen_with,
      self.rate_hz,
      self.hover_height_m,
      spoken,
      packets.Packets.of(len(self.bits)) if self.bits else None,
    )
    if spoken is None or not isinstance(spoken.alphabet, alphabets.Gestures):
      return agreed
    return dataclasses.replace(
      agreed, codebook=spoken.alphabet.codebook, pauses=spoken.pauses
    )

  @property
  def performance(self) -> performance_lib.Performance:
    """What the performer flies: the message, or what comes in place of one."""
    return controls.perform(
      self.control, self.message, self.seed, self.agreement, self.stop_s,
      self.bits, self.repeat,
    )  # fmt: skip

  @property
  def sensors(self) -> tuple[sensor_lib.Sensor, ...]:
    """What spoils the images of each observer."""
    out = [self.sensor] * self.observers
    if self.control == 'black_input':
      out[self.black_observer - 1] = dataclasses.replace(
        self.sensor,
        blackout_s=0.0,
        blackout_length_s=sensor_lib.ALWAYS_S,
        blackout_every_s=0.0,
        blackout_share=1.0,
      )
    return tuple(out)

  @property
  def episode_s(self) -> float:
    """How long the episode lasts at most."""
    if self.duration_s is not None:
      return self.duration_s
    if self.control == 'no_send':
      return NO_SEND_S
    if self.control == 'interrupted':
      return INTERRUPTED_S
    after_s = _READ_S if self.bits else AFTERMATH_S
    if self.safety == 'avoid' and not self.bits:
      after_s += AVOIDING_S
    return self.performance.schedule.end_s + after_s

  def poses(self) -> dict[str, layouts.Pose]:
    """Where each vehicle starts, before jitter, by its name.

    Raises:
      ScenarioError: if the layout is not known.
      layouts.LayoutError: if two vehicles would be too close, or one outside
        of the room.
    """
    poses = {'performer': layouts.performer_pose()}
    places = self._layout().poses(self.observers)
    if len(places) != self.observers:
      raise ScenarioError(
        f'`layout` must give {self.observers} poses: got {len(places)}'
      )
    for index, pose in enumerate(places):
      poses[f'observer_{index + 1}'] = pose
    for name, pose in poses.items():
      poses[name] = pose = pose.settled(self.hover_height_m)
      bounds.check_inside(name, pose)
    # Two neighbours can come closer by the jitter of both, along x and y, and
    # by the drift and the errors of both.
    nearer_m = 2 * math.hypot(self.jitter_m, self.jitter_m)
    nearer_m += self.wander_m
    layouts.check_spacing(poses, safety_lib.MINIMUM_SPACING_M + nearer_m)
    return poses

  @property
  def wander_m(self) -> float:
    """How much nearer hover and errors bring two vehicles."""
    return self.drift.near_m + estimators.near_m(self.estimator)

  @property
  def kept_m(self) -> float:
    """How far apart vehicles that avoid are kept."""
    return safety_lib.kept_m(self.wander_m)

  def _reach_m(self) -> float:
    """How far from its place a message can lead an observer."""
    reach_m = self.units.reach_m
    if self.units.meaning == 'place':
      away_m = [math.hypot(*p.position_m[:2]) for p in self.poses().values()]
      reach_m += self.units.slot_m + max(away_m)
    return reach_m + (_DETOUR_M if self.safety == 'avoid' else 0.0)

  def _check_slots(self) -> None:
    """Refuses slots that are too near to each other."""
    if self.units.meaning != 'place':
      return
    slots = {
      name: layouts.Pose(
        tuple(
          flight.goal_m(
            np.array(pose.position_m),
            self.message.displacement_m(self.units),
            self.agreement,
          )
        ),
        pose.yaw_rad,
      )
      for name, pose in self.poses().items()
      if name != 'performer'
    }
    # A slot turns by twice the angle by which jitter moves its vehicle.
    try:
      layouts.check_spacing(slots, self.kept_m)
    except layouts.LayoutError as error:
      raise ScenarioError(
        f'`slot_m` must be such that slots are {self.kept_m:.3f} m apart, wider'
        f' or for fewer observers: got {self.units.slot_m!r} ({error})'
      ) from None
    for name, slot in slots.items():
      bounds.check_inside(name, slot)

  def _check_dynamics(self) -> None:
    """Refuses what ideal forces, which are told the truth, do not feel."""
    asked = {
      'estimator': self.estimator != 'none',
      'wind_mps': bool(self.air.wind_mps),
      'downwash': self.air.downwash,
    }
    for field, is_asked in asked.items():
      if is_asked and self.dynamics != 'rotors':
        raise ScenarioError(
          f'`{field}` must not be given with `dynamics` {self.dynamics!r}: no'
          " air is felt and the truth is known there; choose 'rotors'"
        )

  def _language(self) -> languages.Language | None:
    """What is spoken; None for the paper's."""
    if isinstance(self.language, languages.Language):
      return self.language
    if self.language == PAPER:
      return None
    choices = [PAPER, *languages.LANGUAGES]
    stem, _, changes = str(self.language).partition(':')
    checks.choice('language', stem, choices, ScenarioError)
    if stem == PAPER:
      raise ScenarioError(
        f'`language` {PAPER!r} must stand alone, as it has no code to change:'
        f' got {changes!r} after it'
      )
    return language_names.find(str(self.language))

  def _check_language(self) -> None:
    """Refuses what the language that is spoken does not take."""
    spoken = self._language()
    if spoken is None:
      for field, usual in (('bits', ''), ('repeat', 1)):
        if getattr(self, field) != usual:
          raise ScenarioError(
            f'`{field}` must not be given with `language` {PAPER!r}, which says'
            f' one payload once: choose one of {[*languages.LANGUAGES]}'
          )
      return
    if self.bits:
      payload_lib.Data(self.bits)
    for field in ('codebook', 'pauses'):
      if getattr(self, field) != getattr(Scenario, field):
        raise ScenarioError(
          f'`{field}` must not be given with `language`: {self.language!r} has'
          f' its own; give it with {PAPER!r}, or a `languages.Language` of your'
          ' own'
        )

  def _check_exposure(self, frame_s: float) -> None:
    """Refuses one that takes longer than from one image to the next."""
    if self.sensor.exposure_s > frame_s:
      raise ScenarioError(
        f'`exposure_s` must be at most {frame_s:g} s, the time from one image'
        f' to the next at {self.rate_hz:g} Hz: got {self.sensor.exposure_s!r}'
      )

  def _check_height(self) -> None:
    """Refuses gestures that leave the room."""
    most_m = bounds.HEIGHT_M - _CLEAR_M - self.agreement.highest_m
    if self.hover_height_m > most_m:
      raise ScenarioError(
        f'`hover_height_m` must be at most {most_m:g}, so that gestures stay'
        f' {_CLEAR_M:g} m under the ceiling: got {self.hover_height_m!r}'
      )

  def _layout(self) -> layouts.Layout:
    if not isinstance(self.layout, str) and callable(
      getattr(self.layout, 'poses', None)
    ):
      return self.layout
    checks.choice('layout', self.layout, LAYOUTS, ScenarioError)
    if self.layout == 'arc':
      return layouts.Arc(
        self.distance_m,
        math.radians(self.half_span_deg),
        math.radians(self.bearing_deg),
      )
    return layouts.Line(self.distance_m, self.spacing_m)
