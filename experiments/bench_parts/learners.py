"""How many steps of learning environments there are in a second."""

from collections.abc import Callable
import dataclasses
import importlib.util
from typing import Any

from waggle_tasks.experiments.bench_parts import processes

NEEDS = 'gymnasium', 'pettingzoo'
_STEPS = {'reading tracks': 20_000, 'no pictures': 600, 'pictures': 300}


@dataclasses.dataclass(frozen=True)
class Learning:
  """Steps of one agent, in turns.

  Attributes:
    step_s: Seconds of a step with the resets among them, by what is seen.
  """

  step_s: dict[str, list[float]]


def installed() -> bool:
  """Whether what learners need is there: the extra `rl`."""
  return all(importlib.util.find_spec(name) for name in NEEDS)


def measure(_: object, repeats: int, clock: processes.Clock) -> Learning:
  """Steps environments of one agent that waits."""
  from waggle_tasks import rl

  makers: dict[str, Callable[[], Any]] = {
    'reading tracks': rl.Read,
    'no pictures': lambda: rl.gym_env(
      language='swift', observe=('time_s', 'position_m')
    ),
    'pictures': lambda: rl.gym_env(language='swift'),
  }
  made = {name: make() for name, make in makers.items()}
  for env in made.values():
    env.reset(seed=0)  # Which compiles what there is to compile.
  found: dict[str, list[float]] = {name: [] for name in made}
  for _ in range(repeats):
    for name, env in made.items():
      found[name].append(_step_s(env, _STEPS[name], clock))
  for env in made.values():
    env.close()
  return Learning(found)


def _step_s(env: Any, steps: int, clock: processes.Clock) -> float:  # noqa: ANN401
  begin_s = clock()
  env.reset(seed=0)
  for _ in range(steps):
    _, _, ended, late, _ = env.step(0)
    if ended or late:
      env.reset()
  return (clock() - begin_s) / steps
