"""A suite's results as tables for people, beside what the paper published."""

from collections.abc import Sequence

from waggle_tasks import errors
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.results import intervals
from waggle_tasks.experiments.studies import case_rows

Row = case_rows.SuiteRow

CAVEAT = (
  'A deterministic matrix is descriptive: its intervals say how much so few'
  ' broadcasts could show,\nnot how reliable the system is over a population'
  ' of scenes.'
)


class CompareError(errors.WaggleError):
  """Results that cannot be set side by side."""


def report(rows: Sequence[Row]) -> str:
  """Every table of a suite: its groups one by one, never pooled."""
  parts = []
  for group, cases in case_rows.by_group(rows).items():
    parts.append(_group(group, cases))
    if failed := _failures(cases):
      parts.append(failed)
  return '\n\n'.join([*parts, CAVEAT])


def _group(group: str, rows: Sequence[Row]) -> str:
  header = (
    f'{group}: configuration', 'N', 'correct', 'paper', 'group', 'paper', '',
  )  # fmt: skip
  cells = []
  for row in rows:
    theirs = published(row) or ('-', '-')
    same = row.published is None or row.as_published
    cells.append(
      (
        row.label, str(row.observers), _counts(row), theirs[0],
        verdict(row.passed), theirs[1], '' if same else 'differs',
      )
    )  # fmt: skip
  return '\n'.join([table.render(header, cells), *totals(rows)])


def published(row: Row) -> tuple[str, str] | None:
  """What the paper gives for a case, as cells, such as '3/3' and 'Pass'."""
  if row.published is None:
    return None
  theirs = row.published
  return f'{theirs.correct}/{row.observers}', verdict(theirs.passed)


def verdict(passed: bool) -> str:
  """How a group did, in a word."""
  return 'Pass' if passed else 'Fail'


def totals(rows: Sequence[Row]) -> list[str]:
  """The sums of a group and their intervals."""
  got = case_rows.Tally.of(rows)
  theirs = [row.published for row in rows if row.published is not None]
  whole = len(theirs) == len(rows)
  exact = intervals.clopper_pearson(got.passed, got.broadcasts)
  lines = [
    _total(
      'broadcasts passed', got.passed, got.broadcasts,
      sum(each.passed for each in theirs) if whole else None,
    )
    + _interval('Clopper-Pearson', exact)
  ]  # fmt: skip
  if all(row.expecting == row.observers for row in rows):
    total = _total(
      'messages correct', got.correct, got.observers,
      sum(each.correct for each in theirs) if whole else None,
    )  # fmt: skip
    lines.insert(0, total + _of_messages(rows))
  return lines


def _total(what: str, count: int, of: int, theirs: int | None) -> str:
  line = f'{what}: {count}/{of} ({count / of:.2%})'
  return line if theirs is None else f'{line}, paper {theirs}/{of}'


def _of_messages(rows: Sequence[Row]) -> str:
  """The interval of a share of messages, which broadcasts have in common.

  Broadcasts that are all alike have no spread to draw from. Where all or none
  of their messages are correct, the broadcasts themselves are counted.
  """
  correct = [row.correct for row in rows]
  exposures = [row.observers for row in rows]
  drawn = intervals.bootstrap_by_broadcast(correct, exposures)
  if drawn[0] < drawn[1]:
    return _interval('bootstrap by broadcast', drawn)
  if sum(correct) in (0, sum(exposures)):
    whole = sum(c == e for c, e in zip(correct, exposures, strict=True))
    exact = intervals.clopper_pearson(whole, len(correct))
    return _interval('Clopper-Pearson, by broadcast', exact)
  return '; no interval: every broadcast has the same share'


def _interval(method: str, interval: tuple[float, float]) -> str:
  return f'; 95 % interval {interval[0]:.1%} to {interval[1]:.1%} ({method})'


def _failures(rows: Sequence[Row]) -> str:
  lines = [
    f'  {row.case}, {outcome.observer}: {failure}'
    for row in rows
    for outcome in row.outcomes
    for failure in outcome.failures
  ]
  return '\n'.join(['failures:', *lines]) if lines else ''


def compare(a: Sequence[Row], b: Sequence[Row], names: tuple[str, str]) -> str:
  """Two results side by side, over the cases that both hold.

  Args:
    a: The rows of the first.
    b: The rows of the second.
    names: What they are called.

  Raises:
    CompareError: if they have no case in common, or cases that differ.
  """
  others = {row.case: row for row in b}
  pairs = [(row, others[row.case]) for row in a if row.case in others]
  if not pairs:
    raise CompareError('`compare` must name folders with a case in common')
  for one, two in pairs:
    if one.observers != two.observers:
      raise CompareError(
        f'`compare` must name folders of the same cases: {one.case} has'
        f' {one.observers} and {two.observers} observers'
      )
  cells = [
    (
      one.label, str(one.observers), _counts(one), _counts(two),
      verdict(one.passed), verdict(two.passed),
    )
    for one, two in pairs
  ]  # fmt: skip
  header = ('configuration', 'N', *names, *names)
  lines = [table.render(header, cells), '']
  for group, members in case_rows.by_group(one for one, _ in pairs).items():
    lines += _paired(group, [(one, others[one.case]) for one in members])
  return '\n'.join(lines)


def _paired(group: str, pairs: Sequence[tuple[Row, Row]]) -> list[str]:
  """McNemar's test over a group's broadcasts and, described, its receivers."""
  broadcasts = [(one.passed, two.passed) for one, two in pairs]
  receivers = [
    (not x.failures, not y.failures)
    for one, two in pairs
    for x, y in zip(one.outcomes, two.outcomes, strict=True)
  ]
  lines = []
  for what, outcomes in (('broadcasts', broadcasts), ('receivers', receivers)):
    only_a = sum(x and not y for x, y in outcomes)
    only_b = sum(y and not x for x, y in outcomes)
    line = f'{group}, {what}: {only_a} passed only first, {only_b} only second'
    if what == 'broadcasts':
      p = intervals.mcnemar(only_a, only_b)
      line += f'; McNemar exact p = {p:.3g}'
    lines.append(line)
  return lines


def _counts(row: Row) -> str:
  return f'{row.correct}/{row.observers}'
