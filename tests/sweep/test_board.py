"""`waggle board`: what is danced, how it is counted, and what is merged."""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import pathlib
import subprocess

import numpy as np
import pytest

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import acquired
from waggle_tasks.experiments.pages import board_page
from waggle_tasks.experiments.record import archive, episode, traces
from waggle_tasks.experiments.results import board_file, board_tables
from waggle_tasks.experiments.studies import (
  board_cases,
  board_study,
  board_tiers,
  case_rows,
  pool,
  runner,
  sweep_cases,
)
from waggle_tasks.experiments.video import board_films

Waggle = Callable[..., subprocess.CompletedProcess[str]]
Error = board_tiers.BoardError
# What is danced, whatever scenarios may have beside: see `board_tiers.VERSION`.
FROZEN = {
  'paper': '7598c1bdddace6f7',
  'envelope': '88d573049a14d1e2',
  'camera': 'b0c982a278318455',
  'room': '7aac51c10ca94864',
  'motion': '715110f01a9cd4ee',
  'crowd': '7f7e7d3f75936f3e',
  'recordings': 'ac054b0e12f405e8',
}
STUB = """
from waggle_tasks.agents import joint_receiver

class Stub(joint_receiver.JointReceiver):
  pass
"""


# What is danced.


def test_tiers_are_frozen() -> None:
  found = board_cases.digest([*board_tiers.TIERS], None)
  assert {name: value[:16] for name, value in found.items()} == FROZEN


def test_a_referees_number_makes_other_dances_of_the_same_scenes() -> None:
  public = [sample for _, sample in board_cases.scenes('crowd', None)]
  private = [sample for _, sample in board_cases.scenes('crowd', 5)]
  assert [s.cell for s in private] == [s.cell for s in public]
  seeds = {s.values['seed'] for s in (*public, *private)}
  assert len(seeds) == len(public) + len(private)
  payloads = [[s.scene.payload for s in each] for each in (public, private)]
  assert payloads[0] != payloads[1]
  assert board_file.referee(5) != board_file.referee(6)
  assert board_file.referee(5) != '5'


def test_every_tier_dances_messages_and_what_is_none() -> None:
  for name, tier in board_tiers.TIERS.items():
    names = [scene.name for scene in tier.scenes]
    assert {*tier.shown} <= {*names}
    sends = {'control' not in scene.values for scene in tier.scenes}
    films = name == board_tiers.RECORDINGS
    assert sends == {True} if films else sends == {True, False}
  scenes = board_tiers.TIERS[board_tiers.RECORDINGS].scenes
  assert [scene.name for scene in scenes] == [*board_films.KINDS]


def test_what_a_receiver_cannot_read_is_told_and_not_flown() -> None:
  cases, unread = board_cases.cases(board_cases.Plan(['crowd'], ['klt']))
  assert {case.cell['language'] for case in cases} == {'paper'}
  (only,) = unread
  assert (only.receiver, only.tier, only.language) == ('klt', 'crowd', 'swift')
  assert "must be 'paper' for receivers that read one gesture" in only.reason


@pytest.mark.parametrize(
  ('changes', 'said'),
  [
    ({'tiers': ['crowds']}, 'Did you mean crowd'),
    ({'tiers': []}, '`tiers` must name each once, and one the least'),
    ({'receivers': ['klt', 'klt']}, '`receivers` must name each once'),
    ({'languages': ['swoft']}, 'Did you mean swift'),
    ({'referee': 0}, '`referee` must be between 1 and'),
  ],
)
def test_a_board_that_cannot_be_is_refused(
  changes: dict[str, object], said: str
) -> None:
  usual = {'tiers': ['paper'], 'receivers': ['klt']}
  with pytest.raises(Error, match=said):
    board_cases.Plan(**(usual | changes))


# What is flown.


def _here(jobs: Sequence[pool.Job]) -> Iterator[pool.Done]:
  for job in jobs:
    yield pool.Done(job, job.do(lambda amount: None))


def _none(jobs: Sequence[pool.Job]) -> Iterator[pool.Done]:
  assert not jobs
  yield from ()


@dataclasses.dataclass(frozen=True)
class Flown:
  """A small board that was flown."""

  folder: pathlib.Path
  cases: list[sweep_cases.Sample]
  board: board_file.Board


@pytest.fixture(scope='module')
def flown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Flown]:
  """A receiver of one's own on a dance in a crowd, and on a film."""
  home = tmp_path_factory.mktemp('board')
  (home / 'own_stub.py').write_text(STUB)
  with pytest.MonkeyPatch.context() as patch:
    patch.syspath_prepend(home)
    plan = board_cases.Plan(['crowd', 'recordings'], ['own_stub:Stub'])
    cases, unread = board_cases.cases(plan)
    wanted = 'one bystander', 'vp8'
    some = [
      case for case in cases
      if case.cell['scene'] in wanted and case.cell['language'] == 'swift'
      and not case.repeat
    ]  # fmt: skip
    folder = home / 'results'
    rows = _run(some, folder, _here)
    known = board_study.readers(plan.receivers)
    board = board_file.Board.of(plan, known, unread, rows, 'waggle board')
    board_file.write(folder, board)
    yield Flown(folder, some, board)


def _run(
  cases: Sequence[sweep_cases.Sample],
  folder: pathlib.Path,
  engine: pool.Engine,
) -> list[case_rows.SweepRow]:
  told: list[int] = []
  study = board_study.Board(
    cases, board_films.Films(), lambda waiting: told.append(len(waiting))
  )
  rows = runner.run(study, folder, engine, 'waggle board')
  assert told == [len(cases) if engine is _here else 0]
  return rows


@pytest.mark.slow
def test_a_receiver_of_ones_own_is_on_the_board(flown: Flown) -> None:
  dance, film = sorted(flown.board.results, key=lambda each: each.tier)
  assert (dance.delivered, dance.wrong, dance.moved) == (True, 0, 0)
  assert (film.delivered, film.wrong, film.moved) == (True, 0, 0)
  assert dance.read_ms > 0
  assert film.read_ms > 0
  (held_s,) = dance.acquired_s
  assert 0 <= held_s < 1.5  # Within the first motions of the dance.
  assert film.acquired_s == ()  # Nobody knows where it is in a film.
  assert len(flown.board.receivers['own_stub:Stub']) == 64


@pytest.mark.slow
def test_what_was_flown_is_not_flown_again_and_a_film_is_kept(
  flown: Flown,
) -> None:
  films = [*(flown.folder / board_study.FILMS).iterdir()]
  assert [path.suffix for path in films] == ['.webm']
  before = (flown.folder / case_rows.RESULTS).read_bytes()
  _run(flown.cases, flown.folder, _none)
  assert (flown.folder / case_rows.RESULTS).read_bytes() == before
  assert [*(flown.folder / board_study.FILMS).iterdir()] == films


@pytest.mark.slow
def test_its_page_is_made_again_from_its_file(
  flown: Flown, waggle: Waggle
) -> None:
  child = waggle('report', str(flown.folder))
  assert child.returncode == 0, child.stderr
  page = (flown.folder / 'index.html').read_text('utf-8')
  assert 'own_stub:Stub' in page
  assert '0 wrong messages' in page
  assert board_file.read(flown.folder) == flown.board


# How it is counted.


def result(
  receiver: str = 'klt', number: int = 0, **changes: object
) -> board_file.Result:
  usual = board_file.Result(
    receiver, 'crowd', 'paper', 'one bystander', number, f'{receiver} {number}',
    f'dance {number}', True, True, 0, 0, 1, 2.0, (0.5,),
  )  # fmt: skip
  return dataclasses.replace(usual, **changes)


def board(
  results: Sequence[board_file.Result], **changes: object
) -> board_file.Board:
  names = dict.fromkeys(each.receiver for each in results)
  usual = board_file.Board(
    1, {'crowd': 'what is danced'}, 'public', 'sources', {'numpy': '2'},
    dict.fromkeys(names, 'hash'), (), ('llvmpipe',), ('waggle board',),
    tuple(results),
  )  # fmt: skip
  return dataclasses.replace(usual, **changes)


def test_a_broadcast_counts_once_and_decoys_count_for_wrong_ones_alone() -> (
  None
):
  none = {'sent': False, 'delivered': False}
  got = board_tables.Tally.of(
    [
      result(number=0),
      result(number=1, delivered=False, acquired_s=(None,)),
      result(number=1, delivered=False, scene='the same', acquired_s=(None,)),
      result(number=2, wrong=2, moved=1, acquired_s=(0.3, 0.7, 1.0), **none),
    ]
  )
  assert (got.broadcasts, got.sent, got.delivered) == (3, 2, 1)
  assert (got.wrong, got.moved) == (1, 1)
  assert (got.held, got.watched, got.held_s) == (4, 5, 0.6)
  assert got.cells[:4] == ('1/2', '1-99', '1/3', '86.5%')


def test_receivers_are_paired_over_the_same_broadcasts() -> None:
  lost = {'delivered': False}
  results = [
    *(result('a', n) for n in range(8)),
    *(result('b', n, **(lost if n < 7 else {})) for n in range(8)),
    result('a', 9, sent=False, delivered=False),
  ]
  (line,) = board_tables.pairs(board(results))
  # Two sides of 7 of 7: 2 / 2^7.
  assert line == ('crowd', 'a', 'b', '1', '7', '0', '0', '0.0156')


def test_what_is_not_read_has_its_line_and_its_reason() -> None:
  unread = board_cases.Unread('klt', 'crowd', 'swift', 'it reads gestures')
  said = board_tables.report(board([result()], unread=(unread,)))
  assert 'crowd     swift       klt   not read' in said
  assert 'klt does not read swift in crowd: it reads gestures' in said


@pytest.mark.parametrize('changes', [{'wrong': 1}, {'moved': 1}])
def test_a_board_with_a_wrong_message_is_not_safe(
  changes: dict[str, int],
) -> None:
  assert board_tables.is_safe(board([result()]))
  assert not board_tables.is_safe(board([result(**changes)]))


def _rollout(off_px: Sequence[float]) -> episode.Rollout:
  """Images at 25 Hz of a dancer 1.3 m away, with a track so far off it."""
  times_s = np.arange(len(off_px)) / 25
  centre_px = np.stack([320.0 + np.array(off_px), 0 * times_s], axis=1)
  trace = traces.Trace(
    times_s, centre_px, 0 * times_s, 9 + 0 * times_s, 1 + 0 * times_s,
    times_s >= 0,
  )  # fmt: skip
  places = np.tile([0.0, 0.0, 1.3], (len(off_px), 1))
  return episode.Rollout(
    times_s,
    {'performer': places, 'observer_1': places - (0.0, 1.3, 0.0)},
    (), {}, 'none', {'observer_1': trace},
    targets_px={'observer_1': centre_px * 0 + (320.0, 0.0)},
  )  # fmt: skip


def test_a_target_is_held_once_its_track_stays_on_it() -> None:
  scene = scenario.Scenario(language='swift', observers=1)
  begin_s = scene.performance.schedule.slots[0].begin_s
  first = round(begin_s * 25)
  # A glimpse, then away, and on it from 0.8 s after the first motion.
  off_px = np.full(200, 99.0)
  off_px[first : first + 5] = 0.0
  off_px[first + 20 :] = 30.0  # The vehicle is 35 pixels wide.
  got = acquired.acquired_s(scene, _rollout(off_px), 'observer_1')
  assert got == pytest.approx(0.8, abs=0.04)
  always = _rollout(np.zeros(200))
  assert acquired.acquired_s(scene, always, 'observer_1') < 0.04
  never = _rollout(np.full(200, 99.0))
  assert acquired.acquired_s(scene, never, 'observer_1') is None


# What is merged.


def test_boards_of_other_receivers_and_tiers_are_one() -> None:
  a = board([result('a', 0), result('a', 1)])
  b = board(
    [result('b', 0), result('a', 1, read_ms=9.0)],
    scenes={'crowd': 'what is danced', 'room': 'more'},
    renderers=('another',),
  )
  whole = board_file.merged({'one': a, 'two': b})
  assert whole.results == (*a.results, b.results[0])
  assert {*whole.receivers} == {'a', 'b'}
  assert {*whole.scenes} == {'crowd', 'room'}
  assert whole.renderers == ('llvmpipe', 'another')


@pytest.mark.parametrize(
  ('changes', 'said'),
  [
    ({'suite': 2}, 'their versions of the suite differ, 1 and 2'),
    ({'referee': 'abc'}, 'their seeds differ, public and abc'),
    ({'sources': 'others'}, 'their sources of this project differ'),
    ({'versions': {'numpy': '3'}}, 'versions of numpy differ, 2 and 3'),
    ({'scenes': {'crowd': '?'}}, 'what is danced in the tier crowd differ'),
    ({'receivers': {'klt': '?'}}, 'or numbers of the receiver klt differ'),
    ({'results': (result(delivered=False),)}, 'klt read crowd, one bystander'),
  ],
)
def test_boards_that_do_not_go_together_are_refused(
  changes: dict[str, object], said: str
) -> None:
  a = board([result()])
  b = dataclasses.replace(a, **changes)
  with pytest.raises(Error, match=f'one and two are not of one board.*{said}'):
    board_file.merged({'one': a, 'two': b})


@pytest.mark.slow
def test_the_command_merges_folders(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  for name in ('a', 'b'):
    (tmp_path / name).mkdir()
    made = board([result(name, number) for number in range(3)])
    board_file.write(tmp_path / name, made)
  pictures = tmp_path / 'b' / board_page.PICTURES
  pictures.mkdir()
  (pictures / 'crowd.png').write_bytes(b'a picture')
  line = 'board', '--merge', 'a', 'b', '--output=both'
  child = waggle(*line, cwd=tmp_path)
  assert child.returncode == 0, child.stderr
  assert '6 results, both/index.html' in child.stdout
  assert len(board_file.read(tmp_path / 'both').results) == 6
  page = (tmp_path / 'both' / 'index.html').read_text('utf-8')
  assert 'data:image/png' in page
  child = waggle(*line, cwd=tmp_path)
  assert child.returncode == 2
  assert 'must not exist' in child.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
  ('line', 'said'),
  [
    (['--tiers=room,rooms'], 'Did you mean room'),
    (['--receivers=klt,nobody'], "must be one of ['klt'"),
    (['--merge', 'a'], '--merge takes two FOLDERs or more: got 1'),
    (['--merge', 'a', 'b'], '--merge needs --output'),
    (['--merge', 'a', 'b', '--output=c'], 'a holds no whole board'),
    (['a'], 'takes only flags'),
  ],
)
def test_bad_input_is_told_in_one_line(
  waggle: Waggle, tmp_path: pathlib.Path, line: list[str], said: str
) -> None:
  child = waggle('board', *line, cwd=tmp_path)
  assert child.returncode == 2
  assert said in child.stderr
  assert not [*tmp_path.iterdir()]


def test_a_damaged_board_is_told(tmp_path: pathlib.Path) -> None:
  board_file.write(tmp_path, board([result()]))
  path = tmp_path / board_file.FILE
  path.write_text(path.read_text().replace('"suite": 1', '"suite": "x"'))
  with pytest.raises(archive.ArchiveError, match=r'board\.json is damaged'):
    board_file.read(tmp_path)
