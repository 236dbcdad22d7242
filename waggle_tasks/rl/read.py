"""Learning to read: from the track of a dance to its bits, without pictures.

An episode is one dance as a tracker would see it from somewhere: places in the
picture, noisy, and now and then none. Where the observer stands, when the dance
begins and what it says are drawn at each reset, so that a clock cannot be
learned by heart. No simulator takes part.
"""

import functools
from typing import Any

import gymnasium
from gymnasium import spaces
import numpy as np

from waggle_tasks import scenario
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import checks, controls, payload
from waggle_tasks.rl import needs

_RATE_HZ = 25.0
_DISTANCES_M, _MOST_ANGLE_DEG = (0.6, 3.0), 75.0
_MOST_WAIT_S = 3.0  # Before the dance, besides its own first hover.
_AFTER_S = 1.0  # In which there is nothing more to see.
# The tracker's error is 2 mm root mean square at every distance.
_ERROR_M = 0.002
_LOST_SHARE = 0.02
_REWARDS = 'sparse', 'dense'
_LOW = np.array([-2, -2, 0, 0], np.float32)  # What is farther out is clipped.
_HIGH = np.array([2, 2, 1, 1], np.float32)


class Read(gymnasium.Env):
  """A track comes in, frame by frame; the agent says a payload, once.

  An observation is (4,) float32: the place right of and above the middle of the
  picture, in its half width; whether the target is seen, 1 or 0; and the time
  since the last image, in s. An action is 0 to wait, or k to say the payload
  whose bits are k - 1, which ends the episode. The reward is 1 for the right
  one and -1 for a wrong one; with `reward` 'dense' a wrong one earns the share
  of its bits that are right, times two, less one. Who says nothing until the
  dance is long over earns 0, and the episode is truncated.
  """

  metadata = {'render_modes': []}  # noqa: RUF012

  def __init__(
    self,
    language: str = 'swift',
    *,
    reward: str = 'sparse',
    error_m: float = _ERROR_M,
    lost_share: float = _LOST_SHARE,
  ) -> None:
    """Makes the environment.

    Args:
      language: What is spoken, see `Scenario.language`.
      reward: 'sparse' or 'dense'.
      error_m: Root mean square of a place's error along each axis, in metres at
        the dancer, 0 to 0.1.
      lost_share: Share of images in which the target is not seen, 0 to 1.

    Raises:
      LearningError: naming the choice that breaks a rule.
      LanguageError: if there is no such language.
    """
    checks.choice('reward', reward, _REWARDS, needs.LearningError)
    for name, value, most in (
      ('error_m', error_m, 0.1), ('lost_share', lost_share, 1.0),
    ):  # fmt: skip
      if not 0 <= value <= most:
        raise needs.LearningError(
          f'`{name}` must be 0 to {most:g}: got {value!r}'
        )
    self._agreement = scenario.Scenario(language=language).agreement
    self._dense, self._error_m = reward == 'dense', error_m
    self._lost_share = lost_share
    self._bits = self._agreement.units.num_bits
    self.action_space = spaces.Discrete(2**self._bits + 1)
    self.observation_space = spaces.Box(_LOW, _HIGH, (4,), np.float32)
    self._rows = np.zeros((0, 4), np.float32)
    self._frame, self._value = 0, 0
    self.render_mode = None

  def reset(
    self, *, seed: int | None = None, options: dict[str, Any] | None = None
  ) -> tuple[np.ndarray, dict[str, Any]]:
    """Draws a dance and a view, and begins to look.

    Args:
      seed: Begins the generator anew.
      options: Takes none.
    """
    super().reset(seed=seed)
    rng = self.np_random
    self._value = int(rng.integers(2**self._bits))
    self._rows, self._frame = self._track(rng), 0
    return self._rows[0].copy(), {}

  def step(
    self, action: object
  ) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
    """Looks at the next image, or hears what the agent says.

    Raises:
      LearningError: before a reset.
    """
    if not len(self._rows):
      raise needs.LearningError('`reset` must come before `step`')
    if action:
      reward = self._reward(int(np.asarray(action)) - 1)
      info = {'payload': f'{self._value:0{self._bits}b}'}
      return self._rows[self._frame].copy(), reward, True, False, info
    self._frame += 1
    last = self._frame == len(self._rows) - 1
    return self._rows[self._frame].copy(), 0.0, False, last, {}

  def _reward(self, value: int) -> float:
    if value == self._value:
      return 1.0
    if not self._dense:
      return -1.0
    right = self._bits - (value ^ self._value).bit_count()
    return 2 * right / self._bits - 1

  def _track(self, rng: np.random.Generator) -> np.ndarray:
    """What is seen of a dance of the payload, (T, 4) float32."""
    angle = np.radians(rng.uniform(-_MOST_ANGLE_DEG, _MOST_ANGLE_DEG))
    distance_m = rng.uniform(*_DISTANCES_M)
    flown_m = _path(self._agreement, self._value)
    wait = int(rng.integers(round(_MOST_WAIT_S * _RATE_HZ) + 1))
    offsets_m = np.concatenate([np.repeat(flown_m[:1], wait, axis=0), flown_m])
    offsets_m += rng.normal(0.0, self._error_m, offsets_m.shape)
    right_m, up_m = offsets_m.T
    away_m = distance_m + right_m * np.sin(angle)
    camera = self._agreement.camera
    half_width = camera.size[0] / 2 / camera.focal_px
    places = np.stack([right_m * np.cos(angle), up_m]) / (away_m * half_width)
    seen = rng.random(len(offsets_m)) >= self._lost_share
    rows = np.zeros((len(offsets_m), 4), np.float32)
    rows[:, :2] = places.T * seen[:, None]
    rows[:, 2] = seen
    rows[1:, 3] = 1 / _RATE_HZ
    return np.clip(rows, _LOW, _HIGH)


@functools.lru_cache(maxsize=256)
def _path(agreement: agreement_lib.Agreement, value: int) -> np.ndarray:
  """A dance and what comes after it, (T, 2) m: to the right and up."""
  message = payload.Payload.from_int(value, agreement.units)
  told = controls.perform('none', message, 0, agreement, 0.0).schedule
  times_s = np.arange(0.0, told.end_s + _AFTER_S, 1 / _RATE_HZ)
  return np.stack([told.motion(each)[0][:2] for each in times_s])
