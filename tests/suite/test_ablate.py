"""What the receivers' parts are good for: the table and the command."""

from collections.abc import Callable
import functools
import pathlib
import re
import subprocess

import pytest
import suite_rows

from waggle_tasks.agents import receivers
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.experiments.studies import ablations, case_rows

Waggle = Callable[..., subprocess.CompletedProcess[str]]


@pytest.mark.parametrize('name', ablations.ABLATIONS)
def test_every_ablation_is_a_receiver(name: str) -> None:
  ablation = ablations.ABLATIONS[name]
  receivers.make(ablation.receiver)
  assert ablation.changes == {}
  if ablation.full:
    assert ablations.ABLATIONS[ablation.full].full in ('', 'view_bank')


def test_no_two_ablations_are_the_same() -> None:
  found = [
    receivers.configured(each.receiver)[1]
    for each in ablations.ABLATIONS.values()
  ]
  assert all(found.count(each) == 1 for each in found)


def outcome(
  decoded: str | None, expected: str | None = '000010', **more: object
) -> verdicts.Outcome:
  return verdicts.Outcome('observer_1', expected, decoded, **more)


READ = outcome('000010', start_s=95.6)
NONE = outcome(None)


def row(
  group: str, *outcomes: verdicts.Outcome, passed: bool = True
) -> case_rows.SuiteRow:
  return suite_rows.make(
    group=group, observers=len(outcomes), passed=passed, outcomes=outcomes,
    correct=sum(each.correct for each in outcomes),
  )  # fmt: skip


def lines(results: dict[str, list[case_rows.SuiteRow]]) -> list[list[str]]:
  text = ablations.report(results).split('\n\n')[0]
  return [re.split(r' {2,}', line.strip()) for line in text.splitlines()]


def test_the_table_tells_messages_from_groups_and_right_from_wrong() -> None:
  moved = ('premature motion: 0.100 m from 3.00 s',)
  head, _, full, less = lines(
    {
      'klt': [
        row('standard', READ, READ),
        row('standard', READ, NONE, passed=False),
        row('supplemental', READ),
        row('controls', outcome(None, None)),
      ],
      'klt-final-null': [
        row('standard', READ, READ, passed=False),
        row('standard', outcome('111111', start_s=90.0), NONE, passed=False),
        row('supplemental', outcome(None, failures=moved), passed=False),
        row('controls', outcome('000010', None, start_s=20.0), passed=False),
      ],
    }
  )
  assert head == [
    'receiver', 'lacks', 'messages', 'groups', 'supplemental', 'controls',
    'wrong', 'moved', 'buys', 'costs',
  ]  # fmt: skip
  assert full == [
    'klt', 'absolute positions, views', '3/4', '1/2', '1/1', '1/1', '0', '0',
    '-', '-',
  ]  # fmt: skip
  assert less == [
    'klt:final_null=off', 'final null', '2/4', '0/2', '0/1', '0/1', '2', '3',
    '+2', '+2',
  ]  # fmt: skip


def test_messages_count_where_no_group_can_pass() -> None:
  results = {
    name: [row('standard', READ, READ, passed=passed)]
    for name, passed in (('klt', True), ('klt-final-null', False))
  }
  (*_, less) = lines(results)
  assert less[2:] == ['2/2', '0/1', '-', '-', '0', '0', '+0', '+0']


def test_a_part_that_does_harm_buys_less_than_nothing() -> None:
  *_, less = lines(
    {
      'klt': [row('standard', NONE, outcome('111111', start_s=9.0))],
      'klt-separators': [row('standard', READ, NONE)],
    }
  )
  assert less[-2:] == ['-1', '-1']


@pytest.fixture
def ablate(waggle: Waggle, tmp_path: pathlib.Path) -> Waggle:
  """Runs `waggle ablate` on a short control, in a folder of its own."""
  case = '--suite=controls', '--case=no-send', '--workers=1'
  return functools.partial(waggle, 'ablate', *case, cwd=tmp_path)


@pytest.mark.slow
def test_an_ablation_is_a_suite_of_its_own_and_is_run_once(
  ablate: Waggle, tmp_path: pathlib.Path
) -> None:
  flags = '--variant=view_bank,view_bank-separators', '--output=out'
  done = ablate(*flags)
  assert done.returncode == 0, done.stderr
  *_, last = done.stdout.split('\n\n')[0].splitlines()
  assert re.split(r' {2,}', last) == [
    'view_bank:separators=off', 'separators', '-', '-', '-', '1/1', '0', '0',
    '+0', '+0',
  ]  # fmt: skip
  home = tmp_path / 'out' / 'view_bank-separators'
  text = (home / 'results.jsonl').read_text('utf-8')
  assert '"receiver": "view_bank:separators=off"' in text
  seal = home / 'cases' / 'no-send' / 'seal.json'
  written = seal.stat().st_mtime_ns
  again = ablate(*flags)
  assert again.stdout == done.stdout
  assert seal.stat().st_mtime_ns == written


@pytest.mark.slow
@pytest.mark.parametrize(
  ('flag', 'error'),
  [
    ('--variant=separators', "`variant` must be .*: got 'separators'"),
    ('--case=no-snd', "`case` must be .*: got 'no-snd'. Did you mean no-send"),
  ],
)
def test_bad_input_is_one_line(ablate: Waggle, flag: str, error: str) -> None:
  done = ablate(flag)
  assert done.returncode == 2
  assert done.stderr.count('\n') == 1
  assert re.match(f'waggle ablate: {error}', done.stderr)


@pytest.mark.slow
def test_what_a_receiver_has_no_time_for_is_refused_before_it_flies(
  waggle: Waggle, tmp_path: pathlib.Path
) -> None:
  flags = '--case=default', '--receiver=klt:hold_s=5', '--output=out'
  done = waggle('ablate', *flags, cwd=tmp_path)
  assert done.returncode == 2
  assert done.stdout == ''
  assert '4.00 s before START, of which a null' in done.stderr
  assert not (tmp_path / 'out').exists()
