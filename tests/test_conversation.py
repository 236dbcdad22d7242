"""Conversations: what they must be, and a few on real rendered images."""

from collections.abc import Callable
import json
import pathlib
import subprocess

import numpy as np
import pytest

import waggle_tasks
from waggle_tasks import conversation, errors, plain
from waggle_tasks import sensor as sensor_lib
from waggle_tasks.experiments.episodes import talk_rules, talking
from waggle_tasks.experiments.record import talk
from waggle_tasks.protocol import seats
from waggle_tasks.tasks import surroundings

Waggle = Callable[..., subprocess.CompletedProcess[str]]
SMALL = {'camera_width_px': 320, 'camera_height_px': 240}
TURNS = {'mission': 'dancers', 'listeners': 4, 'distance_m': 1.1}


@pytest.mark.parametrize(
  ('changes', 'text'),
  [
    ({'mission': 'talk'}, "`mission` must be one of ['ack', 'relay'"),
    ({'language': 'brisk'}, "`language` must be one of ['swift', 'rapid']"),
    ({'listeners': 6}, '`listeners` must be between 1 and 5'),
    ({'hops': 3}, "`hops` must not be given with `mission` 'ack'"),
    ({**TURNS, 'bits': '01'}, "`bits` must not be given with `mission` 'dan"),
    ({**TURNS, 'dancers': 4}, '`listeners` must be at most 3 beside 4 dancers'),
    ({'bits': '01' * 40}, '`num_bits` must be between 1 and 64'),
    ({'payload': '0101'}, '`payload` must be 6 characters of 0 and 1'),
    ({'half_span_deg': 38.0}, 'member_0 sees member_2'),
    ({**TURNS, 'camera_fovy_deg': 40.0}, 'must leave member_'),
    ({'camera_fovy_deg': 20.0, 'listeners': 2}, 'member_0 sees nobody'),
    ({'hover_height_m': 9.0}, '`pose` of member_0 must lie in the room'),
  ],
)
def test_impossible_missions_are_refused_by_name(
  changes: dict, text: str
) -> None:
  with pytest.raises(errors.WaggleError) as caught:
    conversation.Conversation(**changes)
  assert text in str(caught.value)


def test_a_seat_that_is_hidden_by_another_one_is_not_seen() -> None:
  lens = conversation.Conversation().accord.agreement.camera
  own, near, behind = (seats.Seat(x, 0, 0) for x in (0, 1, 2))
  assert seats.views([own, near], 0, lens)[0].column_px == 320
  assert seats.views([own, near, behind], 0, lens) == ()
  assert seats.views([own, seats.Seat(-1, 0, 0)], 0, lens) == ()
  assert seats.views([own, seats.Seat(3.5, 0, 0)], 0, lens) == ()


def test_each_of_a_chain_sees_its_neighbours_alone() -> None:
  accord = conversation.Conversation(mission='relay', hops=6).accord
  for member in range(7):
    seen = {view.member for view in accord.views(member)}
    assert seen == {member - 1, member + 1} & {*range(7)}


def test_a_conversation_is_plain_data_and_back() -> None:
  scene = conversation.Conversation(**TURNS, seed=3)
  table = json.loads(json.dumps(plain.to_plain(scene)))
  assert plain.from_plain(conversation.Conversation, table) == scene


def test_its_environment_follows_dances_and_nothing_else() -> None:
  environment = waggle_tasks.load('conversation', listeners=1, **SMALL)
  timestep = environment.reset()
  homes_m = [each['position_m'] for each in timestep.observation]
  assert [each['camera'].shape for each in timestep.observation] == [
    (240, 320, 3)
  ] * 2
  actions = []
  for home_m, off_m in zip(homes_m, ([0, 0, 0.1], [0.1, 0, 0]), strict=True):
    place_m = home_m + off_m
    actions.append(np.concatenate([place_m, np.zeros(7), home_m]))
  for _ in range(40):
    timestep = environment.step(actions)
  moved_m = [
    each['position_m'] - home_m
    for each, home_m in zip(timestep.observation, homes_m, strict=True)
  ]
  environment.close()
  assert moved_m[0][2] == pytest.approx(0.1, abs=0.02)
  assert np.abs(moved_m[1]).max() < 1e-3
  assert timestep.reward == [0.0, 0.0]


def test_a_field_that_there_is_not_is_refused_with_a_close_one() -> None:
  with pytest.raises(errors.ScenarioError, match='Did you mean listeners'):
    waggle_tasks.load('conversation', listener=2)


def held(**changes: object) -> talk.Talk:
  return talking.hold(conversation.Conversation(**changes))


@pytest.mark.slow
def test_two_confirm_at_once_and_fly_what_they_were_told() -> None:
  found = held(payload='000011', listeners=2)
  assert found.passed
  assert sorted(member for _, member, _ in found.confirmed) == [1, 2]
  says_s = [
    entry.time_s
    for diary in found.diaries[1:]
    for entry in diary
    if entry.what == 'says'
  ]
  assert np.ptp(says_s) < 0.2
  assert found.diaries[0][-1].note == '2 of 2 confirmed after 1 try'
  assert all(found.flew_s[1:])


@pytest.mark.long
def test_who_saw_nothing_is_told_again() -> None:
  dark = sensor_lib.Sensor(blackout_s=2.0, blackout_length_s=4.0)
  found = held(listeners=1, sensor=dark)
  assert found.passed
  assert found.diaries[0][-1].note == '1 of 1 confirmed after 2 tries'


@pytest.mark.long
def test_two_dances_at_once_are_read_each_by_whom_it_is_for() -> None:
  found = held(**TURNS, together=True, seed=1)
  assert found.passed
  first = [diary[0] for diary in found.diaries[:2]]
  assert first[0].time_s == first[1].time_s
  passes = [e for d in found.diaries[2:] for e in d if e.what == 'passes']
  assert passes


@pytest.mark.long
@pytest.mark.parametrize(
  'changes',
  [
    {'listeners': 5},
    {'tries': 6, 'sensor': sensor_lib.Sensor(dropped_share=0.3)},
    {'tries': 6, 'bits': '0110100001101000'},
    {'tries': 6, 'surroundings': surroundings.Surroundings(0, 5.0)},
    {'distance_m': 2.5, 'sensor': sensor_lib.Sensor(noise_sigma=10)},
    {'mission': 'relay', 'hops': 4},
    TURNS,
  ],
  ids=['five', 'dropped', 'parts', 'board', 'noise', 'relay', 'dancers'],
)
def test_all_are_told_and_nothing_wrong_is_read(changes: dict) -> None:
  found = held(**changes)
  assert found.passed
  assert len(found.confirmed) >= len(found.told)


@pytest.mark.long
def test_nobody_confirms_what_it_did_not_read() -> None:
  dark = sensor_lib.Sensor(blackout_length_s=600.0)
  found = held(listeners=3, sensor=dark, tries=2)
  assert found.delivered == ()
  assert found.confirmed == ()
  assert found.false_confirmations == found.wrong == found.strays == ()
  assert found.diaries[0][-1].note == 'given up after 2 tries: 0 of 3 confirmed'


def test_rules_alone_tell_all_in_spite_of_losses() -> None:
  for changes in (
    {},
    {'bits': '0110100001101000'},
    {'mission': 'relay'},
    TURNS,
  ):
    scene = conversation.Conversation(tries=12, **changes)
    whole = talk_rules.play(scene, 0.0, 0)
    assert whole.passed
    for seed in range(3):
      lossy = talk_rules.play(scene, 0.3, seed)
      assert lossy.passed
      assert lossy.duration_s >= whole.duration_s


def test_rules_alone_confirm_nothing_that_was_lost() -> None:
  found = talk_rules.play(conversation.Conversation(tries=2), 1.0, 0)
  assert found.delivered == ()
  assert found.confirmed == ()
  assert not found.passed


def test_confirmations_tell_more_with_fewer_dances_than_repetition() -> None:
  asked = conversation.Conversation(tries=12)
  blind = conversation.Conversation(tries=7, blind=True)
  dances_s = {}
  for scene in (asked, blind):
    held = [talk_rules.play(scene, 0.3, seed) for seed in range(20)]
    assert all(len(each.delivered) == 3 for each in held)
    dances_s[scene.blind] = sum(each.dances_s[0] for each in held)
  assert dances_s[False] < 0.7 * dances_s[True]


@pytest.mark.slow
@pytest.mark.parametrize(
  ('flags', 'text'),
  [
    (['--loss=0.3'], '`loss` must be given with `times`'),
    (['--times=0'], '`times` must be between 1 and'),
    (['--times=2', '--loss=1.5'], '`loss` must be between 0 and 1'),
    (['--times=2', '--output=x'], '`output` must not be given beside'),
    (['--text=a', '--bits=01'], '`text` must not be given beside `bits`'),
  ],
)
def test_flags_that_do_not_go_together_are_refused(
  waggle: Waggle, tmp_path: pathlib.Path, flags: list[str], text: str
) -> None:
  done = waggle('converse', *flags, cwd=tmp_path)
  assert done.returncode == 2
  assert text in done.stderr
  assert [*tmp_path.iterdir()] == []


def test_the_command_counts(waggle: Waggle, tmp_path: pathlib.Path) -> None:
  done = waggle('converse', '--times=3', '--loss=0', cwd=tmp_path)
  assert done.returncode == 0
  assert 'conversations passed: 3/3' in done.stdout
  assert 'delivered: 9/9 (100.00%)' in done.stdout


@pytest.mark.slow
def test_the_command_leaves_a_page_and_its_record(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle(
    'converse', '--listeners=1', '--payload=000000', '--output=talk',
    cwd=tmp_path,
  )  # fmt: skip
  assert (done.returncode, done.stderr) == (0, '')
  assert 'Conversation passed: 1 of 1 told' in done.stdout
  found = talk.read(tmp_path / 'talk' / talk.NAME)
  assert found.passed
  page = (tmp_path / 'talk' / 'index.html').read_text(encoding='utf-8')
  assert 'member_1' in page
  assert 'confirmed' in page
  again = waggle('converse', '--output=talk', cwd=tmp_path)
  assert again.returncode == 2
  assert '`output` must not exist yet' in again.stderr


@pytest.mark.slow
def test_bad_input_is_one_line_and_leaves_nothing(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  done = waggle('converse', '--half_span_deg=39', cwd=tmp_path)
  assert done.returncode == 2
  assert done.stderr.startswith('waggle converse: `distance_m` and')
  assert [*tmp_path.iterdir()] == []
