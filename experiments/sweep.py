"""Flies a scenario over a grid of its fields and maps where it succeeds.

Every combination of the values of each --grid is a cell; each cell is flown
--repeats times, every time with a seed of its own and, with --payload=random,
a payload of its own. All other flags fix the scenario. Leaves results.jsonl,
results.csv and the map, as text, pictures and a page. Ended at any moment, the
same command goes on where it was. Exit status 0 when no observer read a wrong
message or moved without a right one, 1 otherwise, 2 on bad input. --summary
flies nothing and makes the map of the sweeps in FOLDERs, finished or not.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import (
  engine_flag,
  foresight,
  receiver_flag,
  scenario_flags,
)
from waggle_tasks.experiments.pages import sweep_output
from waggle_tasks.experiments.record import folders, provenance
from waggle_tasks.experiments.results import envelope, figures, sweep_tables
from waggle_tasks.experiments.studies import case_rows, sweep_cases
from waggle_tasks.protocol import checks

ARGUMENTS = '[FOLDER ...]'
_MOST_REPLAYS = 10_000
_MOST = 20  # Lines of a list that are printed; summary.txt has all.

scenario_flags.define()
_GRID = flags.DEFINE_multi_string(
  'grid', [], 'A field of the scenario and its values, NAME=VALUE,...; again'
  ' for another. payload=all stands for all 64.',
)  # fmt: skip
_REPEATS = flags.DEFINE_integer('repeats', 1, 'Episodes of each cell.')
_RECEIVER = receiver_flag.define()
engine_flag.define()
_REPLAYS = flags.DEFINE_integer(
  'replays', 0, 'Fly each case before observers who only watch, and show the'
  ' images of each so many times to a receiver, spoilt in ways that are drawn.',
)  # fmt: skip
_OUTPUT = flags.DEFINE_string(
  'output', None, 'Result folder; unset, runs/sweep-RECEIVER-FIELDS.'
)
_SUMMARY = flags.DEFINE_boolean(
  'summary', False, 'Only show what is in the FOLDERs.'
)


def main(argv: Sequence[str]) -> int:
  """Runs or shows sweeps and returns the exit status."""
  if _SUMMARY.value:
    return _summary(argv[1:])
  if argv[1:]:
    raise flags.Error(f'takes only flags, --name=value: got {argv[1]!r}.')
  grid = sweep_cases.grid(_GRID.value)
  cases = sweep_cases.cases(grid, scenario_flags.values(), _REPEATS.value)
  checks.integer(
    'replays', _REPLAYS.value, 0, _MOST_REPLAYS, sweep_cases.SweepError
  )
  scenes = [case.scene for case in cases]
  reader = receiver_flag.chosen(_RECEIVER, scenes)
  foresight.tell(scenes, reader)
  # Imported here: to show results, no simulator is needed.
  from waggle_tasks.experiments.episodes import low_level
  from waggle_tasks.experiments.studies import runner, sweep_study

  low_level.check(scenes, reader, bool(_REPLAYS.value))
  engine, _ = engine_flag.engine()
  command = provenance.command_line('sweep', launch.given_flags())
  factors = '-'.join(['sweep', reader, *grid])
  folder = pathlib.Path(_OUTPUT.value or f'runs/{factors}')
  study = sweep_study.Sweep(cases, reader, _REPLAYS.value)
  return _show(folder, runner.run(study, folder, engine, command))


def _summary(names: Sequence[str]) -> int:
  """Shows what is in result folders, all together."""
  if not names:
    raise flags.Error('--summary takes at least one FOLDER: got none.')
  rows = [
    row for name in names for row in case_rows.read_sweep(pathlib.Path(name))
  ]
  if _OUTPUT.value is not None:
    folders.check_writable(pathlib.Path(_OUTPUT.value))
    return _show(pathlib.Path(_OUTPUT.value), rows)
  if len(names) == 1:
    return _show(pathlib.Path(names[0]), rows)
  print(sweep_tables.report(rows, _MOST))
  return _status(rows)


def _show(folder: pathlib.Path, rows: Sequence[envelope.Row]) -> int:
  """Prints results, and writes what people read of them."""
  page = sweep_output.write(folder, rows)
  print(sweep_tables.report(rows, _MOST))
  print(f'\n{len(rows)} cases, {page}')
  if not figures.can_draw():
    print(figures.MISSING)
  return _status(rows)


def _status(rows: Sequence[envelope.Row]) -> int:
  """1 when an observer was misled."""
  got = envelope.count(rows)
  return 1 if got.wrong or got.unauthorised else 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
