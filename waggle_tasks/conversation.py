"""A conversation: every choice of one, frozen and checked."""

import dataclasses
import functools
import math

import numpy as np

from waggle_tasks import appearance as appearance_lib
from waggle_tasks import errors, spoken, stages
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.arenas import bounds, layouts
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib
from waggle_tasks.protocol import checks, letters, limits, parts, payload, seats
from waggle_tasks.tasks import drift as drift_lib
from waggle_tasks.tasks import safety
from waggle_tasks.tasks import surroundings as surroundings_lib

MISSIONS = ('ack', 'relay', 'dancers')
LANGUAGES = ('swift', 'rapid')
_MOST_S = 600.0
_FLIGHT_S = 8.0
# Of the vertical field of view, by mission: several dancers have to see each
# other and their audience. No source; the paper's is 60.
_FOVY_DEG = {'dancers': 90.0}


@dataclasses.dataclass(frozen=True)
class Conversation:
  """One conversation's configuration.

  Attributes:
    mission: What it is, one of `MISSIONS`: 'ack', one says something and all
      who see it confirm it; 'relay', a chain passes a letter on; 'dancers',
      several have letters at once.
    listeners: How many read, 1 to 5, but for a relay.
    dancers: How many say something, 2 to 4, with the mission 'dancers'.
    hops: How often a letter is passed on in a relay, 1 to 6.
    distance_m: From who says something to who reads it, 0.5 to 3 m.
    half_span_deg: Angle from the middle of the audience to its end, 0 to 40
      degrees.
    payload: What is said: six bits. Several dancers draw theirs by the seed.
    bits: A longer message in its place, 1 to 64 bits, in parts of which those
      are repeated that are missing; with the mission 'ack'.
    tries: How often something is said at most, 1 to 20.
    blind: Whether nobody confirms anything and all tries are said, with the
      mission 'ack'.
    together: Whether dancers begin at once, without looking first.
    seed: Of all that is drawn.
    language: One of `LANGUAGES`.
    dynamics: How vehicles fly, one of `limits.DYNAMICS`.
    drift: How far vehicles wander: all of them as observers do.
    sensor: What spoils the images of every vehicle.
    surroundings: What else moves, with the mission 'ack'.
    appearance: How the room looks.
    rate_hz: How many images and references there are in a second.
    hover_height_m: Where everybody hovers.
    camera_width_px: Width of images in pixels, 64 to 2048.
    camera_height_px: Height of images in pixels, 64 to 2048.
    camera_fovy_deg: Vertical field of view, 10 to 120 degrees; unset, 60, and
      90 for several dancers, who have to see each other and their audience.
  """

  mission: str = 'ack'
  listeners: int = 3
  dancers: int = 2
  hops: int = 4
  distance_m: float = 1.3
  half_span_deg: float = 30.0
  payload: str = '000010'
  bits: str = ''
  tries: int = 3
  blind: bool = False
  together: bool = False
  seed: int = 0
  language: str = 'swift'
  dynamics: str = 'ideal'
  drift: drift_lib.Drift = drift_lib.Drift()
  sensor: sensor_lib.Sensor = sensor_lib.Sensor()
  surroundings: surroundings_lib.Surroundings = surroundings_lib.Surroundings()
  appearance: appearance_lib.Appearance = appearance_lib.Appearance()
  rate_hz: float = 25.0
  hover_height_m: float = 1.3
  camera_width_px: int = 640
  camera_height_px: int = 480
  camera_fovy_deg: float | None = None

  def __post_init__(self) -> None:
    error = errors.ScenarioError
    checks.choice('mission', self.mission, MISSIONS, error)
    checks.choice('language', self.language, LANGUAGES, error)
    checks.choice('dynamics', self.dynamics, limits.DYNAMICS, error)
    ranges = {
      'listeners': (1, letters.MOST_MEMBERS - 2),
      'dancers': (2, stages.MOST_DANCERS),
      'hops': (1, letters.MOST_MEMBERS - 1),
      'distance_m': (0.5, seats.FAR_M),
      'half_span_deg': (0.0, 40.0),
      'tries': (1, 20),
      'seed': (0, 2**32 - 1),
      'camera_width_px': (64, 2048),
      'camera_height_px': (64, 2048),
    }
    if self.camera_fovy_deg is not None:
      ranges['camera_fovy_deg'] = (10.0, 120.0)
    checks.settle_numbers(self, ranges, error)
    payload.Payload.from_bits(self.payload)
    self._check_mission()
    poses = self.poses()
    for name, pose in poses.items():
      bounds.check_inside(name, pose)
    nearer_m = self.drift.near_m
    layouts.check_spacing(poses, safety.MINIMUM_SPACING_M + nearer_m)
    self._check_views()

  def _check_mission(self) -> None:
    """Refuses what another mission is about."""
    usual = {f.name: f.default for f in dataclasses.fields(self)}
    others = {
      'bits': 'ack', 'blind': 'ack', 'surroundings': 'ack',
      'together': 'dancers', 'dancers': 'dancers', 'hops': 'relay',
    }  # fmt: skip
    for field, mission in others.items():
      value = getattr(self, field)
      if value != usual[field] and self.mission != mission:
        raise errors.ScenarioError(
          f'`{field}` must not be given with `mission` {self.mission!r}, only'
          f' with {mission!r}: got {value!r}'
        )
    members = len(self.poses())
    if members > letters.MOST_MEMBERS:
      raise errors.ScenarioError(
        f'`listeners` must be at most {letters.MOST_MEMBERS - self.dancers}'
        f' beside {self.dancers} dancers: got {self.listeners}'
      )
    if self.bits:
      parts.Parts(len(self.bits)).cut(self.bits)
    if self.mission == 'ack':
      self.surroundings.check(self.poses(), payload.Units().reach_m)

  def _check_views(self) -> None:
    """Refuses a mission in which somebody does not see whom it has to."""
    accord = self.accord
    names = [*self.poses()]
    for member, needed in enumerate(self.needed):
      seen = [view.member for view in accord.views(member)]
      for other in needed:
        if other not in seen:
          whom = ', '.join(names[each] for each in seen) or 'nobody'
          raise errors.ScenarioError(
            f'`distance_m` and `half_span_deg` must leave {names[other]} in the'
            f' picture of {names[member]}, alone in a strip of at least'
            f' {2 * seats.LEAST_PX * accord.agreement.camera.zoom:.0f} pixels'
            f' and at most {seats.FAR_M:g} m away: {names[member]} sees {whom}'
          )

  @property
  def needed(self) -> list[tuple[int, ...]]:
    """Whom each member has to see."""
    if self.mission == 'ack':
      audience = tuple(range(1, self.listeners + 1))
      return [audience, *((0,) for _ in audience)]
    if self.mission == 'relay':
      last = self.hops
      return [
        tuple(j for j in (k - 1, k + 1) if 0 <= j <= last)
        for k in range(last + 1)
      ]
    out = [tuple(r for r, _ in self.letters_of(k)) for k in range(self.dancers)]
    for listener in range(self.dancers, self.dancers + self.listeners):
      out.append(tuple(k for k in range(self.dancers) if listener in out[k]))
    return out

  def letters_of(self, dancer: int) -> list[tuple[int, str]]:
    """Of several dancers, to whom one says what: a recipient and a payload.

    Each in the audience is told something by one dancer, who stands on the
    other side. What, is drawn.
    """
    rng = np.random.RandomState(self.seed)
    out = []
    for place in range(self.listeners):
      told = payload.Payload.from_int(int(rng.randint(64))).bits
      if self.dancers - 1 - place * self.dancers // self.listeners == dancer:
        out.append((self.dancers + place, told))
    if not out:  # There are more dancers than listeners.
      nearest = (self.dancers - 1 - dancer) * self.listeners // self.dancers
      told = payload.Payload.from_int(int(rng.randint(64))).bits
      out.append((self.dancers + nearest, told))
    return out

  def poses(self) -> dict[str, layouts.Pose]:
    """Where each member starts, by its name."""
    span_rad = math.radians(self.half_span_deg)
    if self.mission == 'ack':
      arc = layouts.Arc(self.distance_m, span_rad)
      found = stages.audience(self.listeners, arc)
    elif self.mission == 'relay':
      found = stages.chain(self.hops, self.distance_m)
    else:
      found = stages.dancers(
        self.dancers, self.listeners, self.distance_m, span_rad
      )
    return {
      f'member_{number}': pose.settled(self.hover_height_m)
      for number, pose in enumerate(found)
    }

  @functools.cached_property
  def accord(self) -> accord_lib.Accord:
    """What all members know."""
    fovy_deg = self.camera_fovy_deg or _FOVY_DEG.get(
      self.mission, camera_lib.FOVY_DEG
    )
    agreed = agreement_lib.Agreement(
      camera=camera_lib.Camera.of(
        self.camera_width_px, self.camera_height_px, fovy_deg
      ),
      rate_hz=self.rate_hz,
      hover_height_m=self.hover_height_m,
      language=spoken.find(self.language),
    )
    cut = parts.Parts(len(self.bits)) if self.bits else None
    return accord_lib.Accord(
      agreed,
      tuple(
        seats.Seat(*pose.position_m[:2], pose.yaw_rad)
        for pose in self.poses().values()
      ),
      letters.Form(
        cut.chunk_bits if cut else payload.Units().num_bits,
        addressed=self.mission != 'ack',
        hopping=self.mission == 'relay',
        numbered=cut is not None,
      ),
      cut,
      self.tries,
    )

  @property
  def episode_s(self) -> float:
    """How long it lasts at most: all tries of all, and the flights."""
    accord, count = self.accord, 1
    round_s = accord.letter_s + accord.window_s + accord.quiet_s
    round_s += accord.spread_s
    if accord.parts:
      round_s += (accord.parts.count - 1) * (accord.letter_s + accord.gap_s)
    if self.mission == 'relay':
      count = self.hops + 1
    if self.mission == 'dancers':
      count = self.listeners + self.dancers
    begin_s = accord.agreement.spoken.initial_hover_s
    whole_s = begin_s + count * self.tries * round_s
    return min(whole_s + accord.over_s + _FLIGHT_S, _MOST_S)
