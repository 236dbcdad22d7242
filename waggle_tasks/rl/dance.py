"""Learning a language: one dances, others say what it meant; no code is given.

A referential game (Lewis, Convention, 1969; Lazaridou et al., 2017,
arXiv:1612.07182) on the motion channel: the speaker gets a payload and chooses
the heights of a dance, which a Crazyflie can fly; each listener gets the track
of that dance from a place of its own and says which payload it was.
"""

from collections.abc import Mapping
from typing import Any, ClassVar

from gymnasium import spaces
import numpy as np
import pettingzoo

from waggle_tasks.protocol import checks
from waggle_tasks.rl import needs, signals

SPEAKER = 'speaker'


class Dance(pettingzoo.ParallelEnv):
  """A speaker and listeners; an episode has two steps.

  In the first one the speaker sees its payload, (payloads,) float32 with a 1
  at it, and its action, (strokes,) float32 from -1 to 1, says how high each
  stroke ends, in 0.14 m; what listeners do does not count. In the second one
  each listener sees a track, (frames, 2) float32 (see `signals.Channel`), and
  says k + 1 for payload k, or 0 for nothing; what the speaker does does not
  count. A listener earns 1 for the right payload, `wrong` for another one and 0
  for nothing; the speaker earns what listeners earn in the mean.
  """

  metadata: ClassVar[dict[str, Any]] = {
    'name': 'waggle_dance_v0',
    'render_modes': [],
  }

  def __init__(
    self,
    payloads: int = 8,
    listeners: int = 1,
    *,
    channel: signals.Channel = signals.Channel(),
    wrong: float = 0.0,
  ) -> None:
    """Makes the environment.

    Args:
      payloads: How many there are, 2 to 1024.
      listeners: How many, 1 to 64.
      channel: What is between them.
      wrong: What a wrong payload earns, -1 to 0.

    Raises:
      LearningError: naming the choice that breaks a rule.
    """
    error = needs.LearningError
    self.payloads = checks.integer('payloads', payloads, 2, 1024, error)
    count = checks.integer('listeners', listeners, 1, 64, error)
    self.channel = channel
    self._wrong = checks.number('wrong', wrong, -1.0, 0.0, error)
    self._listeners = [f'listener_{n}' for n in range(1, count + 1)]
    self.possible_agents = [SPEAKER, *self._listeners]
    self.agents: list[str] = []
    self._meant = 0
    self._random = np.random.default_rng()
    self._speaker_space = spaces.Box(0, 1, (self.payloads,), np.float32)
    self._track_space = spaces.Box(-2, 2, (channel.frames, 2), np.float32)
    self._actions = {
      SPEAKER: spaces.Box(-1, 1, (channel.strokes,), np.float32),
      **{name: spaces.Discrete(payloads + 1) for name in self._listeners},
    }
    self.render_mode = None

  def observation_space(self, agent: str) -> spaces.Space:
    """What an agent sees."""
    return self._speaker_space if agent == SPEAKER else self._track_space

  def action_space(self, agent: str) -> spaces.Space:
    """What an agent may do."""
    return self._actions[agent]

  def reset(
    self, seed: int | None = None, options: dict[str, Any] | None = None
  ) -> tuple[dict[str, np.ndarray], dict[str, dict[str, Any]]]:
    """Draws a payload.

    Args:
      seed: Begins the generator anew.
      options: Takes none.
    """
    if seed is not None:
      self._random = np.random.default_rng(seed)
    self.agents = [*self.possible_agents]
    self._meant = int(self._random.integers(self.payloads))
    self._danced = False
    blank = np.zeros((self.channel.frames, 2), np.float32)
    seen = {name: blank.copy() for name in self._listeners}
    return {SPEAKER: self._word(), **seen}, {name: {} for name in self.agents}

  def _word(self) -> np.ndarray:
    word = np.zeros(self.payloads, np.float32)
    word[self._meant] = 1
    return word

  def step(
    self, actions: Mapping[str, Any]
  ) -> tuple[
    dict[str, np.ndarray],
    dict[str, float],
    dict[str, bool],
    dict[str, bool],
    dict[str, dict[str, Any]],
  ]:
    """Dances what the speaker chose, or hears what listeners say.

    Raises:
      LearningError: before a reset.
    """
    if not self.agents:
      raise needs.LearningError('`reset` must come before `step`')
    names = self.agents
    if not self._danced:
      self._danced = True
      told = np.asarray(actions[SPEAKER], float)
      copies = np.repeat(told[None], len(self._listeners), axis=0)
      tracks = self.channel.tracks(copies, self._random)
      self._seen = dict(zip(self._listeners, tracks, strict=True))
      rewards, over = dict.fromkeys(names, 0.0), False
    else:
      said = {name: int(actions[name]) for name in self._listeners}
      rewards = {name: self._earned(k) for name, k in said.items()}
      rewards[SPEAKER] = float(np.mean([*rewards.values()]))
      over, self.agents = True, []
    seen = {name: track.copy() for name, track in self._seen.items()}
    return (
      {SPEAKER: self._word(), **seen},
      rewards,
      dict.fromkeys(names, over),
      dict.fromkeys(names, False),
      {name: {'payload': self._meant} if over else {} for name in names},
    )

  def _earned(self, said: int) -> float:
    """What a listener earns for what it says."""
    if said == 0:
      return 0.0
    return 1.0 if said - 1 == self._meant else self._wrong
