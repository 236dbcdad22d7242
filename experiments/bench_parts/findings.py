"""What the two checks found, for people."""

from collections.abc import Sequence

from waggle_tasks.experiments.bench_parts import events, sameness
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import camera

_PIXELS = camera.Camera.columns * camera.Camera.rows


def pictures(found: Sequence[sameness.Comparison]) -> str:
  """How pictures differ, by what was changed before them."""
  header = (
    'changed before', 'pictures', 'not equal', 'pixels', 'grey levels',
    'pixels', 'grey levels',
  )  # fmt: skip
  names = dict.fromkeys(each.change for each in found)
  rows = [
    _row(name.replace('_', ' '), [e for e in found if e.change == name])
    for name in names
  ]
  rows.append(_row('all of them', found))
  worst = worst_levels(found)
  share = sum(e.single_pass.pixels for e in found) / (len(found) * _PIXELS)
  return '\n'.join(
    [
      'Incremental against full render, then full render against a single pass',
      '',
      table.render(header, rows),
      '',
      f'Incremental and full render differ by {worst} grey levels at most in'
      f' {len(found)} pictures:',
      f'{_verdict(worst)}, {sameness.MAX_LEVELS} is allowed. {share:.4%} of'
      ' pixels differ from a single pass.',
    ]
  )


def worst_levels(found: Sequence[sameness.Comparison]) -> int:
  """The largest difference between incremental and full pictures."""
  return max(each.incremental.levels for each in found)


def event_logs(found: Sequence[events.Verdict]) -> str:
  """Whether logs are equal, case by case."""
  rows = [
    (each.case, str(each.events), 'differ' if each.difference else 'equal')
    for each in found
  ]
  lines = [table.render(('case', 'events', 'event logs'), rows), '']
  for each in found:
    if each.difference:
      one, other = (line or 'nothing' for line in each.difference)
      lines += [
        f'{each.case}, incremental: {one}',
        f'{each.case}, full: {other}',
      ]
  equal = sum(each.difference is None for each in found)
  lines.append(f'{equal} of {len(found)} event logs are equal.')
  return '\n'.join(lines)


def _verdict(levels: int) -> str:
  return 'the same' if levels <= sameness.MAX_LEVELS else 'NOT the same'


def _row(name: str, found: Sequence[sameness.Comparison]) -> Sequence[str]:
  cells = [sum(each.incremental.pixels > 0 for each in found)]
  for kind in ('incremental', 'single_pass'):
    differences = [getattr(each, kind) for each in found]
    cells.append(sum(each.pixels for each in differences))
    cells.append(max(each.levels for each in differences))
  return name, str(len(found)), *map(str, cells)
