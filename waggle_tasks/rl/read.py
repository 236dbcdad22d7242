"""Learning to read: from the track of a dance to its bits, without pictures.

An episode is one dance as a tracker would see it from somewhere: places in the
picture, noisy, and now and then none. Where the observer stands, when the dance
begins and what it says are drawn at each reset, so that a clock cannot be
learned by heart. No simulator takes part.
"""

from typing import Any

import gymnasium
from gymnasium import spaces
import numpy as np

from waggle_tasks.protocol import checks
from waggle_tasks.rl import glimpses, needs

_REWARDS = 'sparse', 'dense'


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
    error_m: float = glimpses.Glimpses.error_m,
    lost_share: float = glimpses.Glimpses.lost_share,
  ) -> None:
    """Makes the environment.

    Args:
      language: What is spoken, see `Scenario.language`.
      reward: 'sparse' or 'dense'.
      error_m: See `glimpses.Glimpses`.
      lost_share: See `glimpses.Glimpses`.

    Raises:
      LearningError: naming the choice that breaks a rule.
      LanguageError: if there is no such language.
    """
    checks.choice('reward', reward, _REWARDS, needs.LearningError)
    self._glimpses = glimpses.Glimpses(language, error_m, lost_share)
    self._dense, self._bits = reward == 'dense', self._glimpses.num_bits
    self.action_space = spaces.Discrete(2**self._bits + 1)
    self.observation_space = spaces.Box(
      glimpses.LOW, glimpses.HIGH, (4,), np.float32
    )
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
    self._value = int(self.np_random.integers(2**self._bits))
    values = np.array([self._value])
    self._rows, self._frame = self._glimpses.draw(values, self.np_random)[0], 0
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
