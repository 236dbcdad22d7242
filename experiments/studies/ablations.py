"""Receivers without one of their parts, beside the same receivers with it.

The paper has no ablations and asks for those of null separators and of the
final confirmation (section 'Limitations and next simulation experiments').
"""

from collections.abc import Mapping
import dataclasses

from waggle_tasks.agents import receivers, settings
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.studies import case_rows, variants

LEGEND = (
  'messages: read as sent in the standard suite; groups: its broadcasts that'
  ' passed every check,\nnine nulls and the release by the last of them among'
  ' them. wrong: messages that were not sent;\nmoved: observers that left'
  ' their place without the message that was sent. buys: correct messages\n'
  'that the full receiver has more in all cases; costs: wrong ones that it'
  ' has fewer.'
)


@dataclasses.dataclass(frozen=True)
class Ablation(variants.Variant):
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


def report(
  results: variants.Results, known: Mapping[str, Ablation] = ABLATIONS
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
  tallies = {n: case_rows.Tally.of(rows) for n, rows in results.items()}
  lines = []
  for name, rows in results.items():
    ablation, own = known[name], tallies[name]
    full = tallies.get(ablation.full)
    of_group = {
      group: case_rows.Tally.of(members)
      for group, members in case_rows.by_group(rows).items()
    }
    standard, more = of_group.get('standard'), of_group.get('supplemental')
    lines.append(
      (
        ablation.receiver,
        ablation.label,
        standard.messages if standard else '-',
        standard.groups if standard else '-',
        more.messages if more else '-',
        of_group['controls'].groups if 'controls' in of_group else '-',
        str(own.wrong),
        str(own.moved),
        f'{full.correct - own.correct:+d}' if full else '-',
        f'{own.wrong - full.wrong:+d}' if full else '-',
      )
    )
  return f'{table.render(header, lines)}\n\n{LEGEND}'
