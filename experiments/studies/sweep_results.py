"""The files of a sweep's result folder, and its rows read back."""

import dataclasses
import pathlib
from typing import Any

from waggle_tasks.experiments.record import archive, journal, scenario_fields

JOURNAL, RESULTS, TABLE = 'journal.jsonl', 'results.jsonl', 'results.csv'
PROVENANCE, SUMMARY = 'provenance.json', 'summary.txt'
FIGURES = 'envelope.svg', 'envelope.png'
NAMES = (
  JOURNAL, RESULTS, TABLE, PROVENANCE, SUMMARY, archive.PAGE, *FIGURES,
)  # fmt: skip


@dataclasses.dataclass(frozen=True, kw_only=True)
class Exposure:
  """What became of one observer, or of one replay, as a row tells it.

  Its first fields, and what they mean, are those of `verdicts.Outcome`.

  Attributes:
    right: Whether it read what was sent, or nothing where nothing was.
    wrong: Whether it read something else.
    unauthorised: Whether it moved without a right message.
    stages: Which checks failed.
    true_angle_deg: Where it stood, seen from the performer.
    true_distance_m: The same.
    events: How many it saw.
    seen_angle_deg: From where it believes that it saw its message.
    seen_distance_m: The same.
    spoilt: How its images were, in a replay.
  """

  observer: str
  expected: str | None
  decoded: str | None
  end_s: float | None = None
  final_null_s: float | None = None
  start_s: float | None = None
  arrival_s: float | None = None
  error_m: float | None = None
  hold_s: float | None = None
  failures: tuple[str, ...] = ()
  diagnosis: str = ''
  estimate_error_m: float | None = None
  right: bool
  wrong: bool
  unauthorised: bool
  stages: tuple[str, ...]
  true_angle_deg: float
  true_distance_m: float
  events: int = 0
  seen_angle_deg: float | None = None
  seen_distance_m: float | None = None
  spoilt: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
  """A line of results.jsonl.

  Attributes:
    format: See `encoding`.
    case: The case's name.
    cell: Its factors and their values.
    repeat: Which of its cell's episodes.
    identity: What decides its result, as a hash.
    receiver: How observers read.
    renderer: The GL renderer.
    simulated_s: How long the episode was.
    passed: Whether no check of any observer failed.
    outcomes: One for each observer, or each replay.
    scenario: Every value of the scenario, see `scenario_fields`.
  """

  format: int = 1
  case: str
  cell: dict[str, Any]
  repeat: int
  identity: str
  receiver: str
  renderer: str
  simulated_s: float
  passed: bool
  outcomes: tuple[Exposure, ...]
  scenario: dict[str, Any]


def read(folder: pathlib.Path) -> list[dict[str, Any]]:
  """The rows of a sweep, or as many as there are yet.

  Fields of a scenario that a row of an older program lacks have their default:
  what they say did not exist then.

  Raises:
    ArchiveError: if there are none, or they are damaged.
    FormatError: if a newer program wrote them.
  """
  path = folder / RESULTS
  if path.exists():
    rows = archive.read_rows(path, Row)
  else:
    path = folder / JOURNAL
    try:
      rows = journal.read(path)
    except OSError as error:
      raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
    archive.check_rows(rows, Row, path)
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
