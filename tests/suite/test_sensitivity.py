"""Which rows change when a choice that the paper leaves open is moved."""

from collections.abc import Callable
import dataclasses
import functools
import pathlib
import re
import subprocess

import pytest
import suite_rows

from waggle_tasks import suites
from waggle_tasks.agents import receivers
from waggle_tasks.experiments.studies import case_rows, variants

Waggle = Callable[..., subprocess.CompletedProcess[str]]
CASES = suites.find('paper')


@pytest.mark.parametrize('name', variants.VARIANTS)
def test_every_case_can_be_flown_with_every_choice(name: str) -> None:
  variant = variants.VARIANTS[name]
  for case in CASES:
    moved = dataclasses.replace(case.scene, **variant.changes)
    receivers.make(variant.receiver, moved.agreement)


def test_every_variant_moves_something_else() -> None:
  (case,) = [case for case in CASES if case.name == 'default']
  seen = []
  for variant in variants.VARIANTS.values():
    moved = dataclasses.replace(case.scene, **variant.changes)
    seen.append((moved, variant.receiver))
  assert seen[0] == (case.scene, 'klt')
  assert all(first != seen[0] for first in seen[1:])
  assert all(seen.count(each) == 1 for each in seen)


@pytest.mark.parametrize(
  'field', ['spacing_m', 'eye_offset_m', 'appearance', 'codebook']
)
def test_open_choices_are_moved_both_ways(field: str) -> None:
  default = CASES[0].scene

  def sizes(value: object) -> list[float]:
    match field:
      case 'codebook':
        return [gesture.duration_s for gesture in value.gestures]
      case 'appearance':
        return [value.brightness]
    return [value]

  moved = [
    sizes(variant.changes[field])
    for variant in variants.VARIANTS.values()
    if field in variant.changes
  ]
  chosen = sizes(getattr(default, field))
  assert any(each < chosen for each in moved)
  assert any(each > chosen for each in moved)


def row(case: suites.Case, correct: int, passed: bool) -> case_rows.SuiteRow:
  return suite_rows.make(
    case=case.name, observers=case.scene.observers, correct=correct,
    passed=passed, published=case.published,
  )  # fmt: skip


def test_the_report_names_the_rows_that_changed() -> None:
  cases = suites.find('standard')
  moved = {'span-15': (1, False), 'distance-1-0': (3, True)}
  given = {case.name: dataclasses.astuple(case.published) for case in cases}
  results = {
    name: [row(case, *values[case.name]) for case in cases]
    for name, values in (('base', given), ('dim', given | moved))
  }
  head, _, base, dim = variants.report(results).splitlines()
  assert re.split(r' {2,}', head.strip())[:3] == [
    'choice moved', 'messages', 'groups',
  ]  # fmt: skip
  assert re.split(r' {2,}', base) == ['as chosen', '44/53', '13/17', 'none']
  assert re.split(r' {2,}', dim) == [
    'light 0.7', '45/53', '13/17',
    'distance-1-0 3/3 not 0/3; span-15 1/3 not 3/3',
  ]  # fmt: skip


@pytest.fixture
def sensitivity(waggle: Waggle, tmp_path: pathlib.Path) -> Waggle:
  """Runs `waggle sensitivity` on a short control, in a folder of its own."""
  case = '--suite=controls', '--case=no-send'
  return functools.partial(waggle, 'sensitivity', *case, cwd=tmp_path)


@pytest.mark.slow
def test_a_variant_is_a_suite_of_its_own(
  sensitivity: Waggle, tmp_path: pathlib.Path
) -> None:
  done = sensitivity('--variant=check-loose', '--output=out')
  assert done.returncode == 0, done.stderr
  last = done.stdout.splitlines()[-1]
  cells = ['forward_backward_px=2.0', '0/3', '1/1', 'none']
  assert re.split(r' {2,}', last) == cells
  text = (tmp_path / 'out' / 'check-loose' / 'results.jsonl').read_text('utf-8')
  assert '"receiver": "klt:forward_backward_px=2.0"' in text


@pytest.mark.parametrize(
  ('flag', 'error'),
  [
    ('--variant=dimm', "`variant` must be .*: got 'dimm'. Did you mean dim"),
    ('--case=no-snd', "`case` must be .*: got 'no-snd'. Did you mean no-send"),
    ('--workers=0', '`workers` must be between 1 and 1024: got 0'),
  ],
)
def test_bad_input_is_one_line(
  sensitivity: Waggle, flag: str, error: str
) -> None:
  done = sensitivity('--variant=base', flag)
  assert done.returncode == 2
  assert done.stderr.count('\n') == 1
  assert re.match(f'waggle sensitivity: {error}', done.stderr)
