"""Results that were touched, or come from elsewhere, are never used."""

from collections.abc import Callable
import json
import pathlib
import re

import pytest

from waggle_tasks import suites
from waggle_tasks.experiments.episodes import identity
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.studies import suite_case

ELSEWHERE = 'from another configuration, other sources or other versions'


def edit(name: str, old: str, new: str) -> Callable[[pathlib.Path], None]:
  def damage(home: pathlib.Path) -> None:
    text = (home / name).read_text(encoding='utf-8')
    assert old in text
    (home / name).write_text(text.replace(old, new), encoding='utf-8')

  return damage


def write(name: str, data: bytes) -> Callable[[pathlib.Path], None]:
  return lambda home: (home / name).write_bytes(data)


def truncate(name: str) -> Callable[[pathlib.Path], None]:
  def damage(home: pathlib.Path) -> None:
    data = (home / name).read_bytes()
    (home / name).write_bytes(data[:-20])

  return damage


def delete(name: str) -> Callable[[pathlib.Path], None]:
  return lambda home: (home / name).unlink()


def delete_all(home: pathlib.Path) -> None:
  for path in home.iterdir():
    path.unlink()


@pytest.mark.parametrize(
  ('damage', 'flaw'),
  [
    (edit('result.json', '"passed": false', '"passed": true'), 'result.json'),
    (edit('config.json', '000010', '000011'), 'config.json'),
    (edit('provenance.json', '"renderer"', '"artist"'), 'provenance.json'),
    (truncate('events.jsonl'), 'events.jsonl'),
    (truncate('traces.npz'), 'traces.npz'),
    (write('positions.npz', b''), 'positions.npz'),
    (delete('result.json'), 'result.json'),
    (write('notes', b'mine'), 'notes'),
    (lambda home: (home / 'more').mkdir(), 'damaged'),
    (delete('seal.json'), 'not finished'),
    (delete_all, 'not finished'),
    (truncate('seal.json'), 'damaged'),
    (write('seal.json', b''), 'damaged'),
    (write('seal.json', b'\xff\xfe'), 'damaged'),
    (write('seal.json', b'[1]'), 'damaged'),
    (write('seal.json', b'{"identity": "a"}'), 'damaged'),
    (edit('seal.json', '"identity": "', '"identity": "0'), ELSEWHERE),
  ],
)
def test_every_damage_is_found(
  finished: object, damage: Callable[[pathlib.Path], None], flaw: str
) -> None:
  home = finished.home('dance')
  seal = json.loads((home / 'seal.json').read_text(encoding='utf-8'))
  assert suite_case.flaw(home, seal['identity']) is None
  damage(home)
  assert flaw in suite_case.flaw(home, seal['identity'])


def test_a_page_is_no_result(finished: object) -> None:
  home = finished.home('dance')
  seal = json.loads((home / 'seal.json').read_text(encoding='utf-8'))
  delete('index.html')(home)
  assert suite_case.flaw(home, seal['identity']) is None


@pytest.mark.slow
def test_damaged_results_are_named_and_run_anew_and_others_kept(
  finished: object, reference: object, capsys: pytest.CaptureFixture[str]
) -> None:
  edit('result.json', '"passed": false', '"passed": true')(
    finished.home('dance')
  )
  truncate('traces.npz')(finished.home('silent'))
  before = finished.written()
  finished.run()
  out = capsys.readouterr().out
  assert re.search('dance: .*anew.* result.json', out)
  assert re.search('silent: .*anew.* traces.npz', out)
  assert 'pair' not in out
  assert finished.results() == reference.results()
  kept = {k for k, when in finished.written().items() if before[k] == when}
  assert {pathlib.Path(name).parent.name for name in kept} == {'pair'}


def test_tables_of_the_suite_that_were_touched_are_written_again(
  finished: object, reference: object
) -> None:
  edit('results.jsonl', '"passed": false', '"passed": true')(finished.folder)
  delete('results.csv')(finished.folder)
  finished.run()
  assert finished.results() == reference.results()


def test_an_identity_follows_all_that_decides_a_result(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  def identify(
    changes: dict[str, object], receiver: str = 'klt', digest: str = 'a'
  ) -> str:
    (case,) = suites.from_rows([{'name': 'a', **changes}])
    return identity.of(case.scene, receiver, digest)

  first = identify({})
  assert identify({'name': 'b', 'label': 'x', 'group': 'g'}) == first
  others = [
    identify({'seed': 1}),
    identify({'pauses': {'gap_s': 2.5}}),
    identify({'codebook': {'duration_s': 7.0}}),
    identify({'appearance': {'floor': 'plain'}}),
    identify({'layout': 'line'}),
    identify({}, receiver='klt:max_rmse=0.2'),
    identify({}, digest='b'),
  ]
  known = provenance.versions()
  monkeypatch.setattr(provenance, 'versions', lambda: known | {'mujoco': '9'})
  others.append(identify({}))
  assert len({first, *others}) == 1 + len(others)


@pytest.mark.slow
def test_results_of_other_sources_are_run_anew_with_a_notice(
  blink: object,
  blink_reference: object,
  monkeypatch: pytest.MonkeyPatch,
  capsys: pytest.CaptureFixture[str],
) -> None:
  here = provenance.deciding_hashes()
  notice = f'blink: .*anew.* {ELSEWHERE}'
  with monkeypatch.context() as patch:
    patch.setattr(provenance, 'deciding_hashes', lambda: here | {'x.py': '0'})
    (there,) = blink.run()
  assert re.search(notice, capsys.readouterr().out)
  (row,) = blink.run()
  assert re.search(notice, capsys.readouterr().out)
  assert row.identity != there.identity
  assert blink.results() == blink_reference.results()


@pytest.mark.slow
def test_sources_that_change_meanwhile_are_an_error(
  fresh_blink: object, monkeypatch: pytest.MonkeyPatch
) -> None:
  here = provenance.deciding_hashes()
  seen = [here, here | {'waggle_tasks/new.py': '0'}]
  monkeypatch.setattr(provenance, 'deciding_hashes', lambda: seen.pop(0))
  with pytest.raises(
    provenance.SourceError, match='sources must not change while a suite runs'
  ):
    fresh_blink.run()
  assert not (fresh_blink.folder / 'results.jsonl').exists()
