"""The examples: what is added from outside, in a few lines each."""

import importlib
import pathlib

import pytest

FOLDER = pathlib.Path(__file__).parents[1] / 'examples'
READ = {
  'own_layout': ['000010'] * 2,
  'small_fast_camera': ['000010'],
  'twelve_bits': ['000100010100'],
  'two_dancers': ['000010'],
  'wind': ['000010'],
}
LONG = ('small_fast_camera', 'wind', 'own_layout')  # Others say nearly as much.


def test_every_example_is_here_and_short() -> None:
  lengths = {
    path.stem: len(path.read_text(encoding='utf-8').splitlines())
    for path in FOLDER.glob('*.py')
  }
  assert max(lengths.pop(name) for name in ('loop', 'learn')) < 40
  assert lengths.keys() == READ.keys()
  assert max(lengths.values()) < 40


@pytest.mark.slow
@pytest.mark.parametrize(
  'name',
  [
    pytest.param(name, marks=[pytest.mark.long] * (name in LONG))
    for name in READ
  ],
)
def test_an_example_reads_what_is_danced(
  name: str,
  monkeypatch: pytest.MonkeyPatch,
  capsys: pytest.CaptureFixture[str],
) -> None:
  monkeypatch.syspath_prepend(str(FOLDER))
  importlib.import_module(name).main()
  lines = capsys.readouterr().out.splitlines()
  assert lines[: len(READ[name])] == [
    f"observer_{number} read ['{bits}'], reward 1"
    for number, bits in enumerate(READ[name], 1)
  ]


@pytest.mark.slow
def test_learning_libraries_tell_who_was_right(
  monkeypatch: pytest.MonkeyPatch,
) -> None:
  monkeypatch.syspath_prepend(str(FOLDER))
  learn = importlib.import_module('learn')
  assert learn.follow() == {'observer_1': 'arrived', 'observer_2': 'wrong'}
  assert -1 <= learn.guess() <= 1
