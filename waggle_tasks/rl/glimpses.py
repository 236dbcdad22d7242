"""Dances of a language as a tracker sees them from somewhere, many at once.

No simulator takes part: what is danced, the projection of a pinhole camera that
looks at the dancer, and the tracker's error.
"""

import dataclasses
import functools

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks, controls, payload
from waggle_tasks.rl import needs

RATE_HZ = 25.0
LOW = np.array([-2, -2, 0, 0], np.float32)  # What is farther out is clipped.
HIGH = np.array([2, 2, 1, 1], np.float32)
_DISTANCES_M, _MOST_ANGLE_DEG = (0.6, 3.0), 75.0
_MOST_WAIT_S = 3.0  # Before the dance, besides its own first hover.
_AFTER_S = 1.0  # In which there is nothing more to see.


@dataclasses.dataclass(frozen=True)
class Glimpses:
  """How dances are seen.

  Attributes:
    language: What is spoken, see `Scenario.language`.
    error_m: Root mean square of a place's error along each axis, in metres at
      the dancer, 0 to 0.1; by default what trackers have at every distance.
    lost_share: Share of images in which the target is not seen, 0 to 1.
  """

  language: str = 'swift'
  error_m: float = 0.002
  lost_share: float = 0.02

  def __post_init__(self) -> None:
    limits = {'error_m': (0, 0.1), 'lost_share': (0, 1)}
    checks.settle_numbers(self, limits, needs.LearningError)

  @functools.cached_property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides know."""
    return scenario.Scenario(language=self.language).agreement

  @property
  def num_bits(self) -> int:
    """How many bits a payload has."""
    return self.agreement.units.num_bits

  def bits(self, values: np.ndarray) -> np.ndarray:
    """The bits of payloads as numbers (B,), the first one first, (B, bits)."""
    return values[:, None] >> np.arange(self.num_bits)[::-1] & 1

  @property
  def frames(self) -> int:
    """How many images there are, however late the dance begins."""
    return round(_MOST_WAIT_S * RATE_HZ) + paths_m(self.agreement).shape[1]

  def draw(self, values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """What is seen of dances of payloads.

    Args:
      values: (B,) the payloads as numbers.
      rng: Draws from where each is seen, since when, errors and losses.

    Returns:
      (B, frames, 4) float32: the place right of and above the middle of the
      picture, in its half width, 0 where it is not seen; whether it is seen, 1
      or 0; and the time since the image before, in s.
    """
    count, frames = len(values), self.frames
    angle = np.radians(
      rng.uniform(-_MOST_ANGLE_DEG, _MOST_ANGLE_DEG, (count, 1))
    )
    distance_m = rng.uniform(*_DISTANCES_M, (count, 1))
    waits = rng.integers(round(_MOST_WAIT_S * RATE_HZ) + 1, size=(count, 1))
    told_m = paths_m(self.agreement)
    at = np.clip(np.arange(frames) - waits, 0, told_m.shape[1] - 1)
    flown_m = told_m[values[:, None], at]
    flown_m = flown_m + rng.normal(0.0, self.error_m, flown_m.shape)
    right_m, up_m = np.moveaxis(flown_m, -1, 0)
    away_m = distance_m + right_m * np.sin(angle)
    camera = self.agreement.camera
    half_width = camera.size[0] / 2 / camera.focal_px
    places = np.stack([right_m * np.cos(angle), up_m], -1)
    rows = np.zeros((count, frames, 4), np.float32)
    rows[..., 2] = rng.random((count, frames)) >= self.lost_share
    rows[..., :2] = places / (away_m * half_width)[..., None]
    rows[..., :2] *= rows[..., 2:3]
    rows[:, 1:, 3] = 1 / RATE_HZ
    return np.clip(rows, LOW, HIGH)


@functools.lru_cache(maxsize=8)
def paths_m(agreement: agreement_lib.Agreement) -> np.ndarray:
  """Every dance and what comes after it, (payloads, T, 2): right and up."""
  told = [
    controls.perform(
      'none', payload.Payload.from_int(value, agreement.units), 0, agreement,
      0.0,
    ).schedule
    for value in range(2**agreement.units.num_bits)
  ]  # fmt: skip
  last_s = max(each.end_s for each in told) + _AFTER_S
  times_s = np.arange(0.0, last_s, 1 / RATE_HZ)
  return np.array([[t.motion(s)[0][:2] for s in times_s] for t in told])
