"""The tables of a suite, beside the paper's, and of two suites."""

import dataclasses
import re

import pytest
import suite_rows

from waggle_tasks import suites
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.experiments.results import suite_tables
from waggle_tasks.experiments.studies import case_rows

Row = case_rows.SuiteRow


def published_row(case: suites.Case) -> Row:
  """The row of a case that gave just what the paper did."""
  scene, published = case.scene, case.published
  expecting = {'none': scene.observers, 'black_input': scene.observers - 1}
  failed = 0 if published.passed else scene.observers - published.correct
  outcomes = tuple(
    verdicts.Outcome(
      f'observer_{number + 1}',
      None,
      failures=('message: none',) * (number < failed),
    )
    for number in range(scene.observers)
  )
  return suite_rows.make(
    case=case.name, group=case.group, label=case.label,
    observers=scene.observers, expecting=expecting.get(scene.control, 0),
    correct=published.correct, passed=published.passed, published=published,
    outcomes=outcomes,
  )  # fmt: skip


def failing(outcome: verdicts.Outcome, *failures: str) -> verdicts.Outcome:
  return dataclasses.replace(outcome, failures=failures)


def changed(rows: list[Row], case: str, **values: object) -> list[Row]:
  """The rows, one of which has other values."""
  return [
    dataclasses.replace(row, **values) if row.case == case else row
    for row in rows
  ]


@pytest.fixture
def paper() -> list[Row]:
  """The results of the paper's suite when all is as published."""
  return [published_row(case) for case in suites.find('paper')]


def cells(report: str, label: str) -> list[str]:
  """The cells of the line of a configuration."""
  (line,) = [
    each for each in report.splitlines() if each.startswith(f'{label}  ')
  ]
  return re.split(r' {2,}', line)


def test_the_totals_are_the_papers_when_the_rows_are(paper: list[Row]) -> None:
  lines = suite_tables.report(paper).splitlines()
  totals = [line for line in lines if re.match('(messages|broadcasts) ', line)]
  assert totals == [
    'messages correct: 44/53 (83.02%), paper 44/53; 95 % interval 68.4% to'
    ' 96.1% (bootstrap by broadcast)',
    'broadcasts passed: 13/17 (76.47%), paper 13/17; 95 % interval 50.1% to'
    ' 93.2% (Clopper-Pearson)',
    'messages correct: 14/14 (100.00%), paper 14/14; 95 % interval 29.2% to'
    ' 100.0% (Clopper-Pearson, by broadcast)',
    'broadcasts passed: 3/3 (100.00%), paper 3/3; 95 % interval 29.2% to'
    ' 100.0% (Clopper-Pearson)',
    'broadcasts passed: 3/3 (100.00%), paper 3/3; 95 % interval 29.2% to'
    ' 100.0% (Clopper-Pearson)',
  ]


# Broadcasts that are all alike have nothing to draw from.
@pytest.mark.parametrize(
  ('correct', 'said'),
  [
    (
      (4, 5, 5),
      '95 % interval 29.2% to 100.0% (Clopper-Pearson, by broadcast)',
    ),
    ((0, 0, 0), '95 % interval 0.0% to 70.8% (Clopper-Pearson, by broadcast)'),
    ((4, 5, 4), '95 % interval 80.0% to 100.0% (bootstrap by broadcast)'),
  ],
)
def test_an_interval_of_messages_is_never_without_width(
  paper: list[Row], correct: tuple[int, ...], said: str
) -> None:
  rows = [row for row in paper if row.group == 'supplemental']
  assert [row.observers for row in rows] == [4, 5, 5]
  rows = [
    dataclasses.replace(row, correct=count)
    for row, count in zip(rows, correct, strict=True)
  ]
  line = suite_tables.totals(rows)[0]
  assert line.endswith(f'; {said}')


def test_broadcasts_with_one_share_have_no_interval_and_say_why(
  paper: list[Row],
) -> None:
  row = next(row for row in paper if row.case == 'span-45')
  line = suite_tables.totals([row])[0]
  assert line.startswith('messages correct: 1/3 (33.33%)')
  assert line.endswith('; no interval: every broadcast has the same share')


def test_groups_have_tables_of_their_own_in_order(paper: list[Row]) -> None:
  report = suite_tables.report(paper)
  heads = re.findall(r'^(\w+): configuration', report, re.MULTILINE)
  assert heads == ['standard', 'supplemental', 'controls']
  assert 'differs' not in report
  assert report.endswith(suite_tables.CAVEAT)
  assert report.count('deterministic matrix is descriptive') == 1


def test_groups_that_stand_mixed_are_not_split(paper: list[Row]) -> None:
  mixed = sorted(paper, key=lambda row: row.case)
  for report in (
    suite_tables.report(mixed), suite_tables.compare(mixed, paper, ('a', 'b')),
  ):  # fmt: skip
    for group in ('standard', 'supplemental', 'controls'):
      heads = re.findall(rf'^{group}(?::|, broadc)', report, re.MULTILINE)
      assert len(heads) == 1


@pytest.mark.parametrize(
  ('label', 'expected'),
  [
    ('Half-span 45 deg', ['3', '1/3', '1/3', 'Fail', 'Fail']),
    ('Half-span 40 deg, 100010', ['5', '3/5', '3/5', 'Fail', 'Fail']),
    ('One observer, front view', ['1', '1/1', '1/1', 'Pass', 'Pass']),
    ('Black input at observer 2', ['3', '2/3', '2/3', 'Pass', 'Pass']),
    ('Static, no send, 10 s', ['3', '0/3', '0/3', 'Pass', 'Pass']),
  ],
)
def test_a_row_has_ours_beside_the_papers(
  paper: list[Row], label: str, expected: list[str]
) -> None:
  assert cells(suite_tables.report(paper), label) == [label, *expected]


def test_a_row_unlike_the_papers_says_so_and_why(paper: list[Row]) -> None:
  (row,) = [each for each in paper if each.case == 'span-15']
  *others, last = row.outcomes
  last = failing(last, 'message: none, START support lost', 'hold')
  worse = changed(
    paper, 'span-15', correct=2, passed=False, outcomes=(*others, last)
  )
  report = suite_tables.report(worse)
  expected = ['3', '2/3', '3/3', 'Fail', 'Pass', 'differs']
  assert cells(report, 'Half-span 15 deg')[1:] == expected
  assert report.count('differs') == 1
  assert 'messages correct: 43/53 (81.13%), paper 44/53' in report
  assert 'broadcasts passed: 12/17 (70.59%), paper 13/17' in report
  standard = report[: report.index('supplemental: ')]
  assert '  span-15, observer_3: message: none, START support lost' in standard
  assert '  span-15, observer_3: hold' in standard


def test_a_right_message_in_a_failed_group_is_a_difference(
  paper: list[Row],
) -> None:
  report = suite_tables.report(changed(paper, 'default', passed=False))
  expected = ['3', '3/3', '3/3', 'Fail', 'Pass', 'differs']
  assert cells(report, 'Default, forward')[1:] == expected


def test_nothing_published_leaves_dashes(paper: list[Row]) -> None:
  rows = [dataclasses.replace(row, published=None) for row in paper]
  report = suite_tables.report(rows)
  assert cells(report, 'Half-span 45 deg')[1:] == ['3', '1/3', '-', 'Fail', '-']
  assert 'differs' not in report
  assert ', paper' not in report


@pytest.fixture
def worse(paper: list[Row]) -> list[Row]:
  """Six standard broadcasts more that fail, and one that passes instead."""
  rows = paper
  for row in [row for row in paper if row.passed][:6]:
    first, *others = row.outcomes
    outcomes = failing(first, 'message: none'), *others
    correct = row.correct - 1
    rows = changed(
      rows, row.case, correct=correct, passed=False, outcomes=outcomes
    )
  (near,) = [row for row in rows if row.case == 'distance-1-0']
  outcomes = tuple(map(failing, near.outcomes))
  return changed(rows, near.case, correct=3, passed=True, outcomes=outcomes)


def test_two_suites_stand_side_by_side_paired_by_case(
  paper: list[Row], worse: list[Row]
) -> None:
  report = suite_tables.compare(paper, worse[::-1], ('runs/a', 'runs/b'))
  head = re.split(r' {2,}', report.splitlines()[0])
  assert head == ['configuration', 'N', *(['runs/a', 'runs/b'] * 2)]
  assert cells(report, 'Distance 1.0 m')[1:] == [
    '3',
    '0/3',
    '3/3',
    'Fail',
    'Pass',
  ]
  assert cells(report, 'Default, forward')[1:] == [
    '3',
    '3/3',
    '2/3',
    'Pass',
    'Fail',
  ]
  # 2 (1 + 7) / 2^7 = 0.125.
  assert (
    'standard, broadcasts: 6 passed only first, 1 only second; McNemar exact'
    ' p = 0.125'
  ) in report
  assert 'standard, receivers: 6 passed only first, 3 only second' in report
  assert (
    'controls, broadcasts: 0 passed only first, 0 only second; McNemar exact'
    ' p = 1'
  ) in report


def test_only_cases_that_both_hold_are_compared(paper: list[Row]) -> None:
  report = suite_tables.compare(paper, paper[:1], ('a', 'b'))
  assert 'Default, forward' in report
  assert 'backward' not in report
  assert 'supplemental' not in report
