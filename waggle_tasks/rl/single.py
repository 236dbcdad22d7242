"""One observer of a broadcast, as a Gymnasium environment."""

from typing import Any

import gymnasium
import numpy as np

from waggle_tasks.rl import needs, parallel


class Broadcast(gymnasium.Env):
  """One agent: what it sees, does and earns is as in `ParallelBroadcast`."""

  metadata = parallel.ParallelBroadcast.metadata

  def __init__(self, name: str = 'broadcast', **choices: object) -> None:
    """Makes the environment.

    Args:
      name: A scenario's name.
      **choices: As those of `ParallelBroadcast`; `observers` must be 1.

    Raises:
      LearningError: if there are more observers than one.
    """
    if choices.setdefault('observers', 1) != 1:
      raise needs.LearningError(
        '`observers` must be 1, who is the agent: got'
        f' {choices["observers"]!r}; `parallel_env` takes more'
      )
    asked: dict[str, Any] = choices
    self._all = parallel.ParallelBroadcast(name, **asked)
    (self._agent,) = self._all.possible_agents
    self.observation_space = self._all.observation_space(self._agent)
    self.action_space = self._all.action_space(self._agent)
    self.render_mode = self._all.render_mode

  def reset(
    self, *, seed: int | None = None, options: dict[str, Any] | None = None
  ) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Begins an episode, see `ParallelBroadcast.reset`."""
    super().reset(seed=seed)
    observations, infos = self._all.reset(seed, options)
    return observations[self._agent], infos[self._agent]

  def step(
    self, action: object
  ) -> tuple[dict[str, np.ndarray], float, bool, bool, dict[str, Any]]:
    """Flies one frame, see `ParallelBroadcast.step`."""
    agent = self._agent
    seen, rewards, ended, late, infos = self._all.step({agent: action})
    return (
      seen[agent], rewards[agent], ended[agent], late[agent], infos[agent]
    )  # fmt: skip

  def render(self) -> np.ndarray | None:
    """See `ParallelBroadcast.render`."""
    return self._all.render()

  def close(self) -> None:
    """Ends rendering."""
    self._all.close()


gym_env = Broadcast
