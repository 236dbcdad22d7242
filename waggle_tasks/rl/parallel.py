"""All observers of a broadcast at once, as a PettingZoo environment."""

from collections.abc import Mapping, Sequence
import dataclasses
from typing import Any, ClassVar

from gymnasium import spaces
import numpy as np
import pettingzoo

from waggle_tasks import registry, scenario, scenarios
from waggle_tasks.arenas import bounds, layouts
from waggle_tasks.protocol import checks, flight, payload
from waggle_tasks.rl import commands, draws, needs
from waggle_tasks.tasks import broadcast

_SIZE_PX = 480, 640  # Height and width of `render`.
_LATE = 'time', 'stopped'  # Reasons that are nothing of the agent's own.
_LONGEST_S = 86_400.0
_Observation = dict[str, np.ndarray]


class ParallelBroadcast(pettingzoo.ParallelEnv):
  """Observers see a dance and fly where it says, each by its own action.

  Observations are dicts: `camera` (H, W, 3) uint8, `time_s` (1,) and
  `position_m` (3,) float64, of which `observe` picks some. Actions are those of
  `commands.space`.

  An agent's reward is 1 when it has arrived where the message says and -1 when
  it moves before the message is complete, flies elsewhere, or touches
  something. It leaves the episode then, after it has held its place for 2 s
  where it is right; `infos` of that step have its `reason`: 'arrived',
  'premature', 'wrong', 'contact', or 'refused' by the safety checks. 'time' and
  'stopped' by a contact of others, are truncations.
  """

  metadata: ClassVar[dict[str, Any]] = {
    'name': 'waggle_broadcast_v0',
    'render_modes': ['rgb_array'],
    'render_fps': 25,
  }

  def __init__(
    self,
    name: str = 'broadcast',
    *,
    action: str = commands.MESSAGE,
    observe: Sequence[str] = broadcast.OBSERVATIONS,
    draw: str | draws.Draw = 'payload',
    render_mode: str | None = None,
    **changes: object,
  ) -> None:
    """Makes the environment; nothing is compiled before the first reset.

    Args:
      name: A scenario's name, see `scenarios.SCENARIOS`.
      action: What an action means, one of `commands.ACTIONS`.
      observe: Which observations there are; pictures are drawn only if asked
        for.
      draw: What is drawn anew at each reset, of `draws.DRAWS` or a function.
      render_mode: 'rgb_array' or None.
      **changes: Fields of `Scenario` and their new values.

    Raises:
      LearningError: if a choice does not exist, or nobody is commanded.
      ScenarioError: see `scenarios.find`.
    """
    error = needs.LearningError
    checks.choice('action', action, commands.ACTIONS, error)
    for each in observe:
      checks.choice('observe', each, broadcast.OBSERVATIONS, error)
    if not callable(draw):
      checks.choice('draw', draw, [*draws.DRAWS], error)
    modes = [None, *self.metadata['render_modes']]
    if render_mode not in modes:
      raise error(f'`render_mode` must be one of {modes}: got {render_mode!r}')
    self._asked = scenarios.find(name, **changes)
    if self._asked.bits:
      raise error(
        f'`bits` must be empty: data command nothing: got {self._asked.bits!r}'
      )
    self._action, self._observe = action, tuple(observe)
    self._draw = draw if callable(draw) else draws.DRAWS[draw]
    self.render_mode = render_mode
    self.possible_agents = layouts.names(self._asked.observers)
    self.agents: list[str] = []
    agreement = self._asked.agreement
    self._actions = {
      agent: commands.space(action, agreement) for agent in self.possible_agents
    }
    self._observations = {
      agent: _seen(self._asked, self._observe) for agent in self.possible_agents
    }
    self._rng = np.random.default_rng()
    self._environment: registry.Environment | None = None
    self._scene = self._asked
    self._pilots: dict[str, commands.Pilot] = {}

  def observation_space(self, agent: str) -> spaces.Space:
    """The observations of an agent."""
    return self._observations[agent]

  def action_space(self, agent: str) -> spaces.Space:
    """The actions of an agent."""
    return self._actions[agent]

  def reset(
    self, seed: int | None = None, options: dict[str, Any] | None = None
  ) -> tuple[dict[str, _Observation], dict[str, dict[str, Any]]]:
    """Begins an episode, of which `draw` and the seed are drawn.

    Args:
      seed: Begins the generator anew; None goes on with it.
      options: Takes none.

    Raises:
      LearningError: if what is drawn makes other spaces or agents.
    """
    del options
    if seed is not None:
      self._rng = np.random.default_rng(seed)
    drawn: dict[str, Any] = dict(self._draw(self._rng, self._asked))
    number = int(self._rng.integers(2**31))
    scene = dataclasses.replace(self._asked, seed=number, **drawn)
    self._check(scene)
    environment = self._begin(scene)
    self._pilots = {
      agent: commands.Pilot(self._action, self._scene.agreement)
      for agent in self.possible_agents
    }
    self.agents = [*self.possible_agents]
    self._timestep = environment.reset()
    return self._look(), {agent: {} for agent in self.agents}

  def _check(self, scene: scenario.Scenario) -> None:
    """Refuses a scenario in which agents or spaces would be others."""
    asked, drawn = (
      (each.observers, each.agreement.camera, each.units.num_bits, each.bits)
      for each in (self._asked, scene)
    )
    if asked != drawn:
      raise needs.LearningError(
        '`draw` must leave observers, camera, and bits as they are: got'
        f' {drawn} for {asked}'
      )

  def _begin(self, scene: scenario.Scenario) -> registry.Environment:
    """The environment of a scenario; that in use, where only words differ."""
    made = self._environment
    if made is not None and scene == dataclasses.replace(
      self._scene, payload=scene.payload, seed=scene.seed
    ):
      made.task.say(scene.performance, scene.episode_s)
      made.random_state.seed(scene.seed)
    else:
      self.close()
      made = registry.environment(scene)
      for visible in made.task.observables:
        visible['camera'].enabled = 'camera' in self._observe
    self._environment, self._scene = made, scene
    return made

  def step(
    self, actions: Mapping[str, object]
  ) -> tuple[
    dict[str, _Observation], dict[str, float], dict[str, bool],
    dict[str, bool], dict[str, dict[str, Any]],
  ]:  # fmt: skip
    """Flies one frame.

    Args:
      actions: One of each agent that is left.

    Raises:
      LearningError: if there is none of one, or one that is not of its space,
        or before a reset.
    """
    environment = self._environment
    if environment is None or not self.agents:
      raise needs.LearningError('`reset` must come before `step`')
    if missing := [each for each in self.agents if each not in actions]:
      raise needs.LearningError(
        f'`actions` must hold one of {missing[0]}: got those of {[*actions]}'
      )
    for agent in self.agents:
      self._check_action(agent, actions[agent])
    references = []
    seen = zip(self.possible_agents, self._timestep.observation, strict=True)
    for agent, each in seen:
      own = actions[agent] if agent in self.agents else None
      time_s = float(each['time_s'])
      references.append(
        self._pilots[agent].step(own, each['position_m'], time_s)
      )
    self._timestep = timestep = environment.step(references)
    rewards = dict(zip(self.possible_agents, timestep.reward, strict=True))
    rewards = {agent: float(rewards[agent]) for agent in self.agents}
    task = environment.task
    reasons = {agent: self._reason(agent, task) for agent in self.agents}
    for agent, reason in reasons.items():
      if reason in ('wrong', 'contact'):
        rewards[agent] -= 1.0
    observations = self._look()
    infos = {
      agent: {'reason': reason} if reason else {}
      for agent, reason in reasons.items()
    }
    late = {agent: reason in _LATE for agent, reason in reasons.items()}
    ended = {
      agent: bool(reason) and not late[agent]
      for agent, reason in reasons.items()
    }
    self.agents = [agent for agent in self.agents if not reasons[agent]]
    return observations, rewards, ended, late, infos

  def _check_action(self, agent: str, action: object) -> None:
    space = self._actions[agent]
    taken = action
    if isinstance(space, spaces.Box):  # Whatever kind of numbers they are.
      taken = np.asarray(action, space.dtype)
    if not space.contains(taken):
      raise needs.LearningError(
        f'`actions` of {agent} must be in {space}: got {action!r}'
      )

  def _reason(self, agent: str, task: broadcast.Broadcast) -> str:
    """Why an agent leaves the episode now; empty while it stays."""
    done = task.achieved[self.possible_agents.index(agent)]
    if task.contacts:
      touched = any(agent in pair for pair in task.contacts)
      return 'contact' if touched else 'stopped'
    if done.trespassed:
      return 'premature'
    if any(each.vehicle == agent for each in task.refusals):
      return 'refused'
    if self._wrong(self._pilots[agent]):
      return 'wrong'
    if done.done:
      return 'arrived'
    return 'time' if self._timestep.last() else ''

  def _wrong(self, pilot: commands.Pilot) -> bool:
    """Whether a command leads elsewhere than the message that was danced."""
    message = self._scene.performance.message
    if not isinstance(message, payload.Payload) or pilot.begin_m is None:
      return False
    agreement = self._scene.agreement
    way_m = message.displacement_m(agreement.units)
    goal_m = flight.goal_m(pilot.begin_m, way_m, agreement)
    said = float(self._timestep.observation[0]['time_s']) >= (
      self._scene.performance.said_s
    )
    apart_m = float(np.linalg.norm(goal_m - pilot.goal_m))
    return said and apart_m > flight.ARRIVAL_ERROR_M

  def _look(self) -> dict[str, _Observation]:
    """What the agents that are left see."""
    seen = dict(
      zip(self.possible_agents, self._timestep.observation, strict=True)
    )
    return {
      agent: {
        name: np.atleast_1d(seen[agent][name]).copy() for name in self._observe
      }
      for agent in self.agents
    }

  def render(self) -> np.ndarray | None:
    """The room from the side, (480, 640, 3) uint8; None without a mode."""
    if self.render_mode is None or self._environment is None:
      return None
    return self._environment.physics.render(*_SIZE_PX, camera_id='overview')

  def close(self) -> None:
    """Ends rendering; a reset begins anew."""
    if self._environment is not None:
      self._environment.close()
    self._environment = None


parallel_env = ParallelBroadcast


def _seen(scene: scenario.Scenario, names: Sequence[str]) -> spaces.Dict:
  """The space of what an observer sees."""
  width, height = scene.agreement.camera.size
  room_m = np.array([bounds.HALF_WIDTH_M, bounds.HALF_DEPTH_M])
  low_m, high_m = np.append(-room_m, 0.0), np.append(room_m, bounds.HEIGHT_M)
  every: dict[str, spaces.Space] = {
    'camera': spaces.Box(0, 255, (height, width, 3), np.uint8),
    'time_s': spaces.Box(0.0, _LONGEST_S, (1,), np.float64),
    'position_m': spaces.Box(low_m, high_m, (3,), np.float64),
  }
  return spaces.Dict({name: every[name] for name in names})
