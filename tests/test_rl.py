"""Learning libraries find what they know, and what agents earn is told."""

from collections.abc import Callable
import subprocess
import sys
from typing import Any
import warnings

import gymnasium
from gymnasium.utils import env_checker
import numpy as np
import pettingzoo.test
import pytest

from waggle_tasks import Team, rl
from waggle_tasks.protocol import payload
from waggle_tasks.rl import commands, draws, glimpses, needs

SMALL = {'language': 'swift', 'camera_width_px': 64, 'camera_height_px': 64}
BLIND = {'language': 'swift', 'observe': ('time_s', 'position_m')}
SAID_S = 6.8  # When all of a message in this language was danced.


def parallel(**choices: object) -> rl.ParallelBroadcast:
  return rl.parallel_env('broadcast', **choices)


def action(bits: str) -> int:
  return int(bits, 2) + 1


def fly(
  env: rl.ParallelBroadcast, wanted: dict[str, Any], from_s: float = SAID_S
) -> tuple[dict[str, float], dict[str, str], dict[str, bool]]:
  """Gives each agent one action after a time: returns, reasons, late or not."""
  observations, _ = env.reset(seed=1)
  earned = dict.fromkeys(env.possible_agents, 0.0)
  reasons, truncated = {}, {}
  while env.agents:
    actions = {}
    for agent in env.agents:
      now = observations[agent]['time_s'][0] >= from_s
      actions[agent] = wanted[agent] if now else 0
    observations, rewards, _, late, infos = env.step(actions)
    for agent, reward in rewards.items():
      earned[agent] += reward
      if infos[agent]:
        reasons[agent], truncated[agent] = infos[agent]['reason'], late[agent]
  env.close()
  return earned, reasons, truncated


def test_the_official_checks_pass() -> None:
  with warnings.catch_warnings():
    warnings.simplefilter('error')
    for env in (parallel(observers=2, **SMALL), parallel(**BLIND)):
      pettingzoo.test.parallel_api_test(env, num_cycles=120)
      env.close()
    pettingzoo.test.parallel_seed_test(
      lambda: parallel(observers=1, **SMALL), num_cycles=20
    )
  for name, choices in (('Broadcast', SMALL), ('Read', {})):
    made = gymnasium.make(f'waggle/{name}-v0', **choices)
    env_checker.check_env(made.unwrapped, skip_render_check=True)
    made.close()


def test_every_scenario_has_an_id_and_none_needs_the_simulator_before() -> None:
  program = (
    'import sys, gymnasium, waggle_tasks.rl\n'
    'gymnasium.make("waggle/Read-v0")\n'
    'print("dm_control" in sys.modules, sorted(k for k in gymnasium.registry'
    ' if k.startswith("waggle/")))'
  )
  child = subprocess.run(
    [sys.executable, '-c', program], capture_output=True, text=True, check=True
  )
  assert child.stdout.startswith('False ')
  for name in ('Broadcast', 'NoSend', 'SevenBits', 'Read'):
    assert f"'waggle/{name}-v0'" in child.stdout


def test_several_environments_are_stepped_in_one_process() -> None:
  many = gymnasium.make_vec(
    'waggle_tasks.rl:waggle/Broadcast-v0', num_envs=2,
    vectorization_mode='sync', **SMALL,
  )  # fmt: skip
  observations, _ = many.reset(seed=3)
  assert observations['camera'].shape == (2, 64, 64, 3)
  many.step(np.zeros(2, int))
  many.close()


@pytest.mark.long
def test_several_environments_are_stepped_in_processes_of_their_own() -> None:
  many = gymnasium.make_vec(
    'waggle_tasks.rl:waggle/Broadcast-v0', num_envs=2,
    vectorization_mode='async', vector_kwargs={'context': 'spawn'}, **SMALL,
  )  # fmt: skip
  many.reset(seed=3)
  _, rewards, *_ = many.step(np.zeros(2, int))
  assert rewards.tolist() == [0.0, 0.0]
  many.close()


def test_who_says_what_was_danced_arrives_and_others_end_by_themselves() -> (
  None
):
  env = parallel(observers=3, payload='000010', draw='nothing', **BLIND)
  right, wrong = action('000010'), action('000101')
  wanted = {'observer_1': right, 'observer_2': wrong, 'observer_3': 0}
  earned, reasons, late = fly(env, wanted)
  assert earned == {'observer_1': 1, 'observer_2': -1, 'observer_3': 0}
  assert reasons == {
    'observer_1': 'arrived', 'observer_2': 'wrong', 'observer_3': 'time'
  }  # fmt: skip
  assert late == {
    'observer_1': False, 'observer_2': False, 'observer_3': True
  }  # fmt: skip


def test_who_does_not_wait_for_the_end_earns_nothing_but_loss() -> None:
  env = parallel(observers=1, payload='000010', draw='nothing', **BLIND)
  earned, reasons, late = fly(env, {'observer_1': action('000010')}, 3.0)
  assert earned == {'observer_1': -1}
  assert reasons == {'observer_1': 'premature'}
  assert late == {'observer_1': False}


@pytest.mark.parametrize(
  ('kind', 'of_way'),
  [
    (commands.DISPLACEMENT, lambda x, y: np.array([1, x, y], np.float32)),
    (commands.MESSAGE, lambda x, y: action('000010')),
  ],
)
def test_small_actions_fly_as_agreed(
  kind: str, of_way: Callable[[float, float], Any]
) -> None:
  reach_m = payload.Units().reach_m
  wanted = of_way(0.0, 0.4 / reach_m)  # 0.4 m forward.
  env = parallel(
    observers=1, payload='000010', draw='nothing', action=kind, **BLIND
  )
  if kind == commands.DISPLACEMENT:
    still = np.zeros(3, np.float32)
    observations, _ = env.reset(seed=0)
    while env.agents:
      now = observations['observer_1']['time_s'][0] >= SAID_S
      told = {'observer_1': wanted if now else still}
      observations, rewards, _, _, infos = env.step(told)
    assert rewards['observer_1'] in (0, 1)
    assert infos['observer_1'] == {'reason': 'arrived'}
  else:
    earned, reasons, _ = fly(env, {'observer_1': wanted})
    assert earned == {'observer_1': 1}
    assert reasons == {'observer_1': 'arrived'}


@pytest.mark.slow
def test_the_tasks_own_actions_are_those_of_a_team() -> None:
  """Also the whole chain: what is drawn is read from pictures and flown."""
  env = parallel(
    observers=1, language='swift', action=commands.REFERENCE,
    draw='place_and_payload',
  )  # fmt: skip
  drawn = []
  for number in range(2):
    observations, _ = env.reset(seed=number or None)
    team = None
    while env.agents:
      seen = observations['observer_1']
      if team is None:
        team = Team(1, 'joint', env._scene.agreement)
      told = {**seen, 'time_s': seen['time_s'][0]}
      (wanted,) = team.step([told])
      observations, _, _, _, infos = env.step({'observer_1': wanted})
    assert infos['observer_1'] == {'reason': 'arrived'}
    drawn.append(env._scene.payload)
  env.close()
  assert len({*drawn}) == 2


@pytest.mark.slow
def test_a_reset_draws_and_equal_seeds_draw_the_same() -> None:
  """Whether the environment is new or was used before."""
  used, new = (parallel(observers=1, **SMALL) for _ in range(2))
  used.reset(seed=5)
  said = {used._scene.payload}
  for _ in range(4):
    used.reset()
    said.add(used._scene.payload)
  assert len(said) > 2
  ways = []
  for env in (used, new):
    seen = [env.reset(seed=7)[0]]
    for _ in range(120):
      seen.append(env.step({'observer_1': 0})[0])
    ways.append(seen)
    env.close()
  for a, b in zip(*ways, strict=True):
    for name, value in a['observer_1'].items():
      np.testing.assert_array_equal(value, b['observer_1'][name])


def test_a_draw_of_ones_own_changes_any_field() -> None:
  def farther(rng: np.random.Generator, scene: object) -> dict[str, object]:
    return {**draws.payload(rng, scene), 'distance_m': 2.0}

  env = parallel(observers=1, draw=farther, **BLIND)
  observations, _ = env.reset(seed=0)
  assert abs(observations['observer_1']['position_m'][1] + 2.0) < 1e-3
  assert [*observations['observer_1']] == ['time_s', 'position_m']
  env.close()


def test_a_picture_of_the_room_is_rendered_when_asked_for() -> None:
  env = rl.gym_env('no_send', render_mode='rgb_array', **SMALL)
  env.reset(seed=0)
  picture = env.render()
  assert picture.shape == (480, 640, 3)
  assert picture.std() > 5
  env.close()


@pytest.mark.parametrize(
  ('choices', 'words'),
  [
    ({'action': 'velocity'}, "`action` must be one of.*'message'"),
    ({'observe': ('kamera',)}, '`observe` must be one of.*Did you mean camera'),
    ({'draw': 'payloads'}, '`draw` must be one of.*Did you mean payload'),
    ({'render_mode': 'human'}, '`render_mode` must be one of'),
    ({'language': 'swift', 'bits': '0101'}, '`bits` must be empty'),
  ],
)
def test_choices_that_do_not_exist_are_refused(
  choices: dict[str, Any], words: str
) -> None:
  with pytest.raises(needs.LearningError, match=words):
    parallel(**choices)


def test_steps_out_of_turn_are_refused() -> None:
  env = parallel(observers=2, **BLIND)
  with pytest.raises(needs.LearningError, match='`reset` must come before'):
    env.step({})
  env.reset(seed=0)
  with pytest.raises(needs.LearningError, match='hold one of observer_2'):
    env.step({'observer_1': 0})
  env.close()
  with pytest.raises(needs.LearningError, match='`observers` must be 1'):
    rl.gym_env('broadcast', observers=2)


@pytest.mark.parametrize(
  ('kind', 'wrong'),
  [
    (commands.MESSAGE, 65), (commands.MESSAGE, -1), (commands.MESSAGE, None),
    (commands.DISPLACEMENT, [1.0, float('nan'), 0.0]),
    (commands.DISPLACEMENT, [1.0, 2.0, 0.0]), (commands.REFERENCE, [0.0] * 12),
  ],
)  # fmt: skip
def test_an_action_outside_of_its_space_is_refused(
  kind: str, wrong: object
) -> None:
  env = parallel(observers=1, action=kind, **BLIND)
  env.reset(seed=0)
  with pytest.raises(needs.LearningError, match='of observer_1 must be in'):
    env.step({'observer_1': wrong})
  env.close()


@pytest.mark.parametrize(
  'changed', [{'observers': 2}, {'camera_width_px': 320}]
)
def test_a_draw_that_changes_spaces_is_refused(changed: dict) -> None:
  env = parallel(observers=1, draw=lambda *_: changed, **BLIND)
  with pytest.raises(needs.LearningError, match='`draw` must leave observers'):
    env.reset(seed=0)


def test_what_is_missing_is_said_with_the_line_that_mends_it() -> None:
  program = (
    'import sys\nsys.modules["pettingzoo"] = None\nimport importlib.util as u\n'
    'find = u.find_spec\n'
    'u.find_spec = lambda n: None if n == "pettingzoo" else find(n)\n'
    'import waggle_tasks.rl'
  )
  child = subprocess.run(
    [sys.executable, '-c', program], capture_output=True, text=True, check=False
  )
  assert child.returncode == 1
  assert "needs pettingzoo: pip install 'waggle-tasks[rl]'" in child.stderr


@pytest.mark.parametrize('reward', ['sparse', 'dense'])
def test_reading_earns_by_what_is_said(reward: str) -> None:
  env = rl.Read(reward=reward)
  env.reset(seed=4)
  *_, info = env.step(1)
  right = action(info['payload'])
  for said, wanted in (
    (right, 1.0),
    (1 + ((right - 1) ^ 0b1), {'sparse': -1.0, 'dense': 2 / 3}[reward]),
    (1 + ((right - 1) ^ 0b111111), -1.0),
  ):
    env.reset(seed=4)
    _, earned, ended, late, _ = env.step(said)
    assert earned == pytest.approx(wanted)
    assert (ended, late) == (True, False)


def test_who_only_watches_a_track_runs_out_of_time() -> None:
  env = rl.Read()
  env.reset(seed=0)
  steps, late, total = 0, False, 0.0
  while not late:
    _, earned, ended, late, _ = env.step(0)
    assert not ended
    steps, total = steps + 1, total + earned
  assert total == 0.0
  assert 6.5 * 25 < steps < 12 * 25


def test_a_track_tells_what_was_danced() -> None:
  """Which dance fits best is the one that was danced: it can be learned."""
  env, said = rl.Read(lost_share=0.05), 0
  for number in range(8):
    seen, _ = env.reset(seed=number)
    heights, lost = [seen[1]], False
    while not lost:
      seen, _, _, lost, _ = env.step(0)
      heights.append(seen[1] if seen[2] else heights[-1])
    *_, info = env.step(1)
    said += nearest(env, np.array(heights)) == info['payload']
  assert said == 8


def nearest(env: rl.Read, heights: np.ndarray) -> str:
  """The payload whose dance fits heights best, at any scale and time."""
  best = {}
  for value in range(64):
    path = glimpses.paths_m(env._glimpses.agreement)[value, :, 1]
    for wait in range(len(heights) - len(path) + 1):
      part = heights[wait : wait + len(path)]
      scale = part @ path / (path @ path)
      rest = heights.copy()
      rest[wait : wait + len(path)] -= scale * path
      best[value, wait] = rest @ rest
  (value, _), _ = min(best.items(), key=lambda each: each[1])
  return f'{value:06b}'


def test_numbers_out_of_range_are_refused() -> None:
  with pytest.raises(needs.LearningError, match='`lost_share` must be between'):
    rl.Read(lost_share=1.5)
  with pytest.raises(needs.LearningError, match='`reward` must be one of'):
    rl.Read(reward='thick')
