"""The files of a sweep's result folder, and its rows read back."""

import json
import pathlib
from typing import Any

from waggle_tasks.experiments.record import archive, journal

JOURNAL, RESULTS, TABLE = 'journal.jsonl', 'results.jsonl', 'results.csv'
PROVENANCE, SUMMARY = 'provenance.json', 'summary.txt'
FIGURES = 'envelope.svg', 'envelope.png'
NAMES = (
  JOURNAL, RESULTS, TABLE, PROVENANCE, SUMMARY, archive.PAGE, *FIGURES,
)  # fmt: skip
_FIELDS = {'case', 'cell', 'receiver', 'outcomes', 'scenario'}  # Of a row.


def read(folder: pathlib.Path) -> list[dict[str, Any]]:
  """The rows of a sweep, or as many as there are yet.

  Raises:
    ArchiveError: if there are none, or they are damaged.
  """
  path = folder / RESULTS
  try:
    if path.exists():
      lines = path.read_text(encoding='utf-8').splitlines()
      rows = [json.loads(line) for line in lines]
    else:
      rows = journal.read(folder / JOURNAL)
  except (OSError, ValueError) as error:
    raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
  for row in rows:
    if not isinstance(row, dict) or not row.keys() >= _FIELDS:
      raise archive.ArchiveError(f'{path} must be results of a sweep')
  if not rows:
    raise archive.ArchiveError(f'{folder} holds no results of a sweep')
  return rows
