"""The loop that the examples share, and a language in which they are short."""

from dm_control import composer

import waggle_tasks
from waggle_tasks.protocol import gestures, timing

FAST = {
  'codebook': gestures.v_codebook(0.12, 0.25, duration_s=2.0),
  'pauses': timing.Timing(3.2, 0.6, 2.0, 1.8),
}


def fly(environment: composer.Environment, receiver: str = 'view_bank') -> None:
  """Flies an episode and prints what each observer read, and its reward."""
  task = environment.task
  team = waggle_tasks.Team(len(task.observers), receiver, task.agreement)
  timestep = environment.reset()
  rewards = [0.0] * len(team.agents)
  while not timestep.last():
    timestep = environment.step(team.step(timestep.observation))
    rewards = [a + b for a, b in zip(rewards, timestep.reward, strict=True)]
  environment.close()
  for number, agent in enumerate(team.agents, 1):
    read = [e.message.bits for e in agent.events if getattr(e, 'message', None)]
    print(f'observer_{number} read {read}, reward {rewards[number - 1]:g}')
