"""Runs a suite of broadcasts and sets the results beside the paper's.

Leaves index.html, results.jsonl, results.csv and a run folder for each case.
Ended at any moment, the same command goes on where it was. Flags of a scenario,
such as --dynamics=rotors, change it in every case. Exit status 0 when
every case gave what is published for it, or passed where nothing is; 1
otherwise; 2 on bad input. A suite of your own is a JSON list of cases, each
with a `name` and the fields of a scenario that it changes. `--compare A B`
sets two result folders side by side and runs nothing.
"""

from collections.abc import Sequence
import dataclasses
import hashlib
import json
import pathlib
import sys
import time

from absl import flags

from waggle_tasks import suites
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import (
  engine_flag,
  foresight,
  receiver_flag,
  scenario_flags,
)
from waggle_tasks.experiments.pages import run_page, suite_page
from waggle_tasks.experiments.record import (
  archive,
  provenance,
  scenario_fields,
)
from waggle_tasks.experiments.results import suite_tables
from waggle_tasks.experiments.studies import case_rows
from waggle_tasks.protocol import checks

ARGUMENTS = '[B]'
_ROOM = 40  # Characters of a value in a folder's name.

_SUITE = flags.DEFINE_string(
  'suite',
  'paper',
  f'One of {", ".join(suites.SUITES)}, or a JSON file of your own.',
)
_CASE = flags.DEFINE_list('case', [], 'Only these cases, by name.')
_RECEIVER = receiver_flag.define()
scenario_flags.define()
engine_flag.define()
_OUTPUT = flags.DEFINE_string(
  'output',
  None,
  'Result folder; unset, runs/SUITE-RECEIVER, the cases, and what is changed.',
)
_COMPARE = flags.DEFINE_string(
  'compare', None, 'Result folder to set beside the folder B.'
)


def main(argv: Sequence[str]) -> int:
  """Runs or compares suites and returns the exit status."""
  if _COMPARE.value is not None:
    return _compare([_COMPARE.value, *argv[1:]])
  if argv[1:]:
    raise flags.Error(f'takes only flags, --name=value: got {argv[1]!r}.')
  cases = _cases()
  scenes = [case.scene for case in cases]
  reader = receiver_flag.chosen(_RECEIVER, scenes)
  foresight.tell(scenes, reader)
  # Imported here: to compare results, no simulator is needed.
  from waggle_tasks.experiments.studies import runner, suite_study

  engine, what = engine_flag.engine()
  stem = pathlib.Path(_SUITE.value).stem
  changes = scenario_fields.flags(scenario_flags.given())
  words = [_word(each.removeprefix('--')) for each in changes]
  name = '-'.join([stem, reader, *_CASE.value, *words])
  folder = pathlib.Path(_OUTPUT.value or f'runs/{name}')
  command = provenance.command_line(
    'suite',
    [f'--suite={_SUITE.value}', f'--receiver={reader}', *changes],
  )
  began_s = time.monotonic()
  study = suite_study.Suite(cases, reader, run_page.leave)
  rows = runner.run(study, folder, engine, command)
  wall_s = time.monotonic() - began_s
  page = suite_page.write(folder)
  print(suite_tables.report(rows))
  simulated_s = sum(row.simulated_s for row in rows)
  print(
    f'\n{len(rows)} cases, {simulated_s:.0f} s simulated, {wall_s:.0f} s of'
    f' wall time in this call with {what}, {page}'
  )
  return 0 if all(row.as_expected for row in rows) else 1


def _word(change: str) -> str:
  """A change for a folder's name, which has no room for long values."""
  name, _, value = change.partition('=')
  if len(value) <= _ROOM:
    return change
  return f'{name}={hashlib.sha256(value.encode()).hexdigest()[:8]}'


def _cases() -> tuple[suites.Case, ...]:
  """The cases of the flags."""
  name = _SUITE.value
  cases = _own(name) if name.endswith('.json') else suites.find(name)
  known = [case.name for case in cases]
  for wanted in _CASE.value:
    checks.choice('case', wanted, known, suites.SuiteError)
  return tuple(
    dataclasses.replace(case, scene=scenario_flags.read(case.scene))
    for case in cases
    if not _CASE.value or case.name in _CASE.value
  )


def _own(path: str) -> tuple[suites.Case, ...]:
  try:
    # Editors on Windows begin such a file with a mark, which is no JSON.
    rows = json.loads(pathlib.Path(path).read_text(encoding='utf-8-sig'))
  except (OSError, ValueError) as error:
    raise suites.SuiteError(
      f'`suite` must be a readable JSON file: {path}: {error}'
    ) from None
  if not isinstance(rows, list):
    raise suites.SuiteError(f'`suite` must be a JSON list of cases: {path}')
  return suites.from_rows(rows)


def _compare(folders: Sequence[str]) -> int:
  if len(folders) != 2:
    raise flags.Error(f'--compare takes two folders: got {len(folders)}.')
  one, other = folders
  try:
    a, b = (case_rows.read_suite(pathlib.Path(each)) for each in folders)
  except archive.ArchiveError as error:
    raise suites.SuiteError(
      f'`compare` must name folders of finished suites: {error}'
    ) from None
  print(suite_tables.compare(a, b, (one, other)))
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
