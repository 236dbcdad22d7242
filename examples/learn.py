"""Learning libraries: who says what was danced, and who says something else."""

import gymnasium

from waggle_tasks import rl

WAIT, OVER_S = 0, 6.8  # A message in this language is over by then.
SAYS = {'observer_1': 0b000010 + 1, 'observer_2': 0b000101 + 1}


def follow() -> dict[str, str]:
  """Two observers fly what they say; why the episode of each has ended."""
  env = rl.parallel_env(
    'broadcast', language='swift', observers=2, payload='000010',
    draw='nothing', observe=('time_s', 'position_m'),
  )  # fmt: skip
  seen, _ = env.reset(seed=0)
  reasons = {}
  while env.agents:
    over = {agent: seen[agent]['time_s'][0] > OVER_S for agent in env.agents}
    said = {agent: SAYS[agent] if over[agent] else WAIT for agent in over}
    seen, _, _, _, infos = env.step(said)
    reasons |= {agent: info['reason'] for agent, info in infos.items() if info}
  env.close()
  return reasons


def guess() -> float:
  """What it earns to say anything at all of a track that was not watched."""
  env = gymnasium.make('waggle/Read-v0', reward='dense')
  env.reset(seed=0)
  return float(env.step(1)[1])


if __name__ == '__main__':
  print(follow(), f'a guess earned {guess():.2f}')
