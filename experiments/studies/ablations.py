"""Receivers without one of their parts, beside the same receivers with it.

The paper has no ablations and asks for those of null separators and of the
final confirmation (section 'Limitations and next simulation experiments').
"""

from collections.abc import Mapping, Sequence
import dataclasses
from typing import Any

from waggle_tasks.agents import receivers, settings
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.experiments.studies import variant_runner

Row = Mapping[str, Any]

LEGEND = (
  'messages: read as sent in the standard suite; groups: its broadcasts that'
  ' passed every check,\nnine nulls and the release by the last of them among'
  ' them. wrong: messages that were not sent;\nmoved: observers that left'
  ' their place without the message that was sent. buys: correct messages\n'
  'that the full receiver has more in all cases; costs: wrong ones that it'
  ' has fewer.'
)


@dataclasses.dataclass(frozen=True)
class Ablation(variant_runner.Variant):
  """A receiver and what it lacks.

  Attributes:
    full: Name of the ablation of the receiver with that part; empty for one
      that lacks nothing.
  """

  full: str = ''


def _without(receiver: str, part: str, label: str) -> Ablation:
  sign = ',' if '=' in receiver else ':'  # Others of its numbers are changed.
  return Ablation(label, receiver=f'{receiver}{sign}{part}=off', full=receiver)


ABLATIONS = {
  'view_bank': Ablation('nothing', receiver='view_bank'),
  'absolute': Ablation('views', receiver='absolute', full='view_bank'),
  'klt_bank': Ablation(
    'absolute positions', receiver='klt_bank', full='view_bank'
  ),
  'klt': Ablation(
    'absolute positions, views', receiver='klt', full='view_bank'
  ),
  'view_bank-separators': _without('view_bank', 'separators', 'separators'),
  'view_bank-final-null': _without('view_bank', 'final_null', 'final null'),
  'klt-separators': _without('klt', 'separators', 'separators'),
  'klt-final-null': _without('klt', 'final_null', 'final null'),
  'klt-forward-backward': _without(
    'klt', 'forward_backward', 'forward-backward'
  ),
}


def of(receiver: str) -> dict[str, Ablation]:
  """A receiver, and the same without each of its switches.

  Raises:
    ReceiverError: if it is not known.
  """
  _, config = receivers.configured(receiver)
  return {receiver: Ablation('nothing', receiver=receiver)} | {
    f'{receiver}-{part}': _without(receiver, part, part.replace('_', ' '))
    for part in settings.switches(config)
  }


@dataclasses.dataclass(frozen=True)
class _Counts:
  """What one receiver did in all cases.

  Attributes:
    correct: Messages read as sent.
    wrong: Messages read that were not sent.
    moved: Observers that left their place without the message sent to them.
  """

  correct: int
  wrong: int
  moved: int

  @classmethod
  def of(cls, rows: Sequence[Row]) -> '_Counts':
    outcomes = [
      verdicts.Outcome(**fields) for row in rows for fields in row['outcomes']
    ]
    return cls(
      sum(row['correct'] for row in rows),
      sum(outcome.wrong for outcome in outcomes),
      sum(outcome.unauthorised for outcome in outcomes),
    )


def report(
  results: variant_runner.Results, known: Mapping[str, Ablation] = ABLATIONS
) -> str:
  """Puts what was run into a table, one line each.

  Args:
    results: By names of ablations, the rows of their cases.
    known: The ablations by name.
  """
  header = (
    'receiver', 'lacks', 'messages', 'groups', 'supplemental', 'controls',
    'wrong', 'moved', 'buys', 'costs',
  )  # fmt: skip
  counts = {name: _Counts.of(rows) for name, rows in results.items()}
  lines = []
  for name, rows in results.items():
    ablation, own = known[name], counts[name]
    full = counts.get(ablation.full)
    lines.append(
      (
        ablation.receiver,
        ablation.label,
        _share(rows, 'standard', 'correct', 'observers'),
        _share(rows, 'standard', 'passed'),
        _share(rows, 'supplemental', 'correct', 'observers'),
        _share(rows, 'controls', 'passed'),
        str(own.wrong),
        str(own.moved),
        f'{full.correct - own.correct:+d}' if full else '-',
        f'{own.wrong - full.wrong:+d}' if full else '-',
      )
    )
  return f'{table.render(header, lines)}\n\n{LEGEND}'


def _share(
  rows: Sequence[Row], group: str, count: str, of: str | None = None
) -> str:
  """Such as '44/53', of a group's cases; a dash when none of them ran."""
  members = [row for row in rows if row['group'] == group]
  if not members:
    return '-'
  total = sum(row[of] for row in members) if of else len(members)
  return f'{sum(row[count] for row in members)}/{total}'
