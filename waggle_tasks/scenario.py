"""A scenario: every choice of one episode, frozen and checked."""

import dataclasses

from waggle_tasks import appearance as appearance_lib
from waggle_tasks import errors, eye_presets, placement, scenario_rules, spoken
from waggle_tasks import eyes as eyes_lib
from waggle_tasks import fidelity as fidelity_lib
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.arenas import layouts
from waggle_tasks.entities import optics
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import (
  alphabets,
  clock,
  controls,
  gestures,
  languages,
  limits,
  packets,
  timing,
)
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.protocol import performance as performance_lib
from waggle_tasks.tasks import air as air_lib
from waggle_tasks.tasks import drift as drift_lib
from waggle_tasks.tasks import estimators
from waggle_tasks.tasks import safety as safety_lib
from waggle_tasks.tasks import surroundings as surroundings_lib

CONTROLS, DYNAMICS = controls.CONTROLS, limits.DYNAMICS
LAYOUTS, PAPER = placement.LAYOUTS, spoken.PAPER
ScenarioError = errors.ScenarioError
# After the last gesture: the 3 s null, the flight, the hold, and time to spare.
AFTERMATH_S = 12.0
# What more those who avoid each other may take.
AVOIDING_S = 18.0
NO_SEND_S = 10.0  # Paper, section 'Controls and supplemental suite'.
INTERRUPTED_S = 60.0  # The same.
_READ_S = 3.0  # After data, which nobody flies.


@dataclasses.dataclass(frozen=True)
class Scenario:
  """One episode's configuration; the defaults are the paper's (Table 2).

  Attributes:
    control: What is sent, and to whom: 'none' is a nominal broadcast; from
      'circles' on the performer flies what is no message. One of `CONTROLS`.
    observers: How many observers, 1 to 64.
    layout: Where observers stand: one of `LAYOUTS`, one that an installed
      package offers, or in Python a `layouts.Layout` of your own.
    distance_m: Radius of the arc, or distance of the line, 0.2 to 4 m.
    half_span_deg: Angle from the middle of the arc to its end, 0 to 180
      degrees.
    bearing_deg: Angle by which the middle of the arc is turned about the
      performer, -180 to 180 degrees; one observer is there.
    spacing_m: Distance between neighbours in a line, in m; the paper gives
      none.
    aside_deg: How far to the left of the performer every observer faces, -30 to
      30 degrees; the receiver 'seeker' finds it there.
    above_m: How much higher than agreed every observer hovers, -1 to 1 m, until
      a message leads it away.
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
    dynamics: How vehicles fly, one of `DYNAMICS`: by ideal forces,
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
    eye: What the observers' cameras are; in Python a name stands for all that
      it sets, see `eye_presets.fields`.
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
    fidelity: How much of an episode is made, one of
      `fidelity_lib.FIDELITIES`: all of it with its pictures, or tracks, or
      words, with the errors that were measured on pictures.
  """

  control: str = 'none'
  observers: int = 3
  layout: str | layouts.Layout = 'arc'
  distance_m: float = 1.3
  half_span_deg: float = 30.0
  bearing_deg: float = 0.0
  spacing_m: float = 0.6
  aside_deg: float = 0.0
  above_m: float = 0.0
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
  eye: eyes_lib.Eye = eyes_lib.Eye()
  sensor: sensor_lib.Sensor = sensor_lib.Sensor()
  rate_hz: float = agreement_lib.Agreement.rate_hz
  hover_height_m: float = agreement_lib.Agreement.hover_height_m
  camera: str = 'incremental'
  camera_width_px: int = camera_lib.Camera.columns
  camera_height_px: int = camera_lib.Camera.rows
  camera_fovy_deg: float = camera_lib.FOVY_DEG
  eye_offset_m: float = optics.OFFSET_M
  fidelity: str = fidelity_lib.PIXELS

  def __post_init__(self) -> None:
    if isinstance(self.eye, str):
      eye_presets.settle(self, self.eye)
    scenario_rules.check(self)

  @property
  def message(self) -> payload_lib.Payload:
    """The payload."""
    return payload_lib.Payload.from_bits(self.payload, self.units)

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides know."""
    seen_with = self.eye.camera(
      self.camera_width_px, self.camera_height_px, self.camera_fovy_deg
    )
    language = spoken.find(self.language)
    agreed = agreement_lib.Agreement(
      self.codebook,
      self.pauses,
      self.tolerance,
      self.units,
      seen_with,
      self.rate_hz,
      self.hover_height_m,
      language,
      packets.Packets.of(len(self.bits)) if self.bits else None,
    )
    if language and isinstance(language.alphabet, alphabets.Gestures):
      return dataclasses.replace(
        agreed, codebook=language.alphabet.codebook, pauses=language.pauses
      )
    return agreed

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
    """Where each vehicle starts, before jitter, by its name; see `placement`.

    Raises:
      ScenarioError: if the layout is not known.
      layouts.LayoutError: if two vehicles would be too close, or one outside
        of the room.
    """
    return placement.poses(self)

  @property
  def wander_m(self) -> float:
    """How much nearer hover and errors bring two vehicles."""
    return self.drift.near_m + estimators.near_m(self.estimator)

  @property
  def kept_m(self) -> float:
    """How far apart vehicles that avoid are kept."""
    return safety_lib.kept_m(self.wander_m)
