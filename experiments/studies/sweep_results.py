"""The files of a sweep's result folder, and its rows read back."""

import pathlib
from typing import Any

from waggle_tasks.experiments.record import archive, journal, scenario_fields

JOURNAL, RESULTS, TABLE = 'journal.jsonl', 'results.jsonl', 'results.csv'
PROVENANCE, SUMMARY = 'provenance.json', 'summary.txt'
FIGURES = 'envelope.svg', 'envelope.png'
NAMES = (
  JOURNAL, RESULTS, TABLE, PROVENANCE, SUMMARY, archive.PAGE, *FIGURES,
)  # fmt: skip
# Of a row, and of an outcome in it: what tables and maps are made from.
_FIELDS = 'case', 'cell', 'receiver', 'simulated_s', 'outcomes', 'scenario'
_OUTCOME = (
  'observer', 'expected', 'decoded', 'failures', 'stages', 'right', 'wrong',
  'unauthorised', 'true_angle_deg', 'true_distance_m',
)  # fmt: skip


def read(folder: pathlib.Path) -> list[dict[str, Any]]:
  """The rows of a sweep, or as many as there are yet.

  Fields of a scenario that a row of an older program lacks have their default:
  what they say did not exist then.

  Raises:
    ArchiveError: if there are none, they are damaged, or lack what maps need.
    FormatError: if a newer program wrote them.
  """
  path = folder / RESULTS
  if path.exists():
    rows = archive.read_rows(path, _FIELDS, _OUTCOME)
  else:
    path = folder / JOURNAL
    try:
      rows = journal.read(path)
    except OSError as error:
      raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
  if not rows:
    raise archive.ArchiveError(f'{folder} holds no results of a sweep')
  usual = scenario_fields.defaults()
  for row in rows:
    if strange := [name for name in row['scenario'] if name not in usual]:
      raise archive.ArchiveError(
        f'{path} holds what this program does not know: a scenario with'
        f' `{strange[0]}`; the program that flew it can show it'
      )
    row['scenario'] = {**usual, **row['scenario']}
  return rows
