"""Measures the levels of fidelity on pictures, and shows how they agree.

--measure renders broadcasts in swift, read by joint, at every distance and
angle in every condition, and leaves ladder.json: the errors of the tracker in
each broadcast, and how many frames were read. That file is the package's table
(experiments/episodes/ladder.json), on which --fidelity=tracks and symbols
stand. --validate renders other broadcasts of the same cells and reads each of
them on both levels, pixels and tracks, with the same seed. Without either the
package's table is shown. Ended at any moment, the same command goes on where it
was. Exit status 0 when nothing wrong was read, 1 otherwise, 2 on bad input.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.episodes import ladder_table
from waggle_tasks.experiments.flags import engine_flag
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import provenance
from waggle_tasks.experiments.studies import case_rows
from waggle_tasks.protocol import checks

_MEASURE = flags.DEFINE_boolean('measure', False, 'Make the table.')
_VALIDATE = flags.DEFINE_boolean('validate', False, 'Compare the levels.')
_CONDITIONS = flags.DEFINE_list(
  'conditions', [*ladder_table.CONDITIONS],
  f'Some of {", ".join(ladder_table.CONDITIONS)}.',
)  # fmt: skip
_DISTANCES = flags.DEFINE_list(
  'distances', ['0.6', '1', '1.3', '2', '3'], 'Of observers, m.'
)
_BEARINGS = flags.DEFINE_list(
  'bearings', ['0', '30', '60', '75'],
  'From where they look, degrees from the front.',
)  # fmt: skip
_BROADCASTS = flags.DEFINE_integer('broadcasts', 3, 'Of each cell.')
_FIRST = flags.DEFINE_integer(
  'first', None, 'Number of the first of them: others are other messages;'
  ' unset, 0 to measure and 1000 to validate.',
)  # fmt: skip
engine_flag.define()
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Result folder; unset, runs/ladder or runs/ladder-validate.'
)
_VALIDATES_FROM = 1000
_MOST = 10_000


def main(argv: Sequence[str]) -> int:
  """Measures, compares or shows; returns the exit status."""
  del argv
  if _MEASURE.value and _VALIDATE.value:
    raise errors.WaggleError(
      '`measure` and `validate` must not be given together: got both'
    )
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.results import ladder_tables

  if not (_MEASURE.value or _VALIDATE.value):
    table = ladder_table.read()
    print(ladder_tables.measured(table))
    print(f'\n{len(table.cells)} cells, made by {table.command}')
    return 0
  from waggle_tasks.experiments.studies import ladder_study

  first = _FIRST.value
  if first is None:
    first = _VALIDATES_FROM if _VALIDATE.value else 0
  checks.integer('first', first, 0, _MOST, errors.WaggleError)
  count = checks.integer(
    'broadcasts', _BROADCASTS.value, 1, _MOST, errors.WaggleError
  )
  cases = ladder_study.cases(
    _CONDITIONS.value,
    _numbers('distances', _DISTANCES.value),
    _numbers('bearings', _BEARINGS.value),
    range(first, first + count),
  )
  engine, _ = engine_flag.engine()
  command = provenance.command_line('ladder', launch.given_flags())
  usual = 'runs/ladder-validate' if _VALIDATE.value else 'runs/ladder'
  folder = pathlib.Path(_OUTPUT.value or usual)
  rows = ladder_study.run(cases, _VALIDATE.value, folder, engine, command)
  if _VALIDATE.value:
    text = ladder_tables.agreement(rows, ladder_table.read())
  else:
    made = ladder_study.table(rows, command)
    files.replace(folder / ladder_study.TABLE, ladder_table.text(made))
    text = ladder_tables.measured(made)
  files.replace(folder / case_rows.SUMMARY, f'{text}\n')
  print(text)
  print(f'\n{len(rows)} broadcasts, {folder}')
  return int(
    any(
      read not in (None, r.sent) for r in rows for read in (r.pixels, r.tracks)
    )
  )


def _numbers(field: str, texts: Sequence[str]) -> list[float]:
  try:
    return [*map(float, texts)]
  except ValueError:
    raise errors.WaggleError(
      f'`{field}` must be numbers: got {",".join(texts)!r}'
    ) from None


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
