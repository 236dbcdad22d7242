"""The rows of results: values, and how they are read back."""

from collections.abc import Iterable, Sequence
import dataclasses
import math
import pathlib
from typing import Any

from waggle_tasks import suites
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  journal,
  scenario_fields,
  verdicts,
)

_OF_FLIGHTS, _OF_REPLAYS = ('seen_angle_deg', 'seen_distance_m'), ('spoilt',)
_OF_BOARDS = 'read_ms', 'acquired_s'
JOURNAL, RESULTS, TABLE = 'journal.jsonl', 'results.jsonl', 'results.csv'
PROVENANCE, SUMMARY = 'provenance.json', 'summary.txt'
FIGURES = 'envelope.svg', 'envelope.png'
LINK_FIGURES = 'link.svg', 'link.png'


@dataclasses.dataclass(frozen=True, kw_only=True)
class SuiteRow:
  """One episode of a suite.

  Attributes:
    case: The case's name.
    group: What it is counted with.
    label: Its configuration, for tables.
    identity: What decides its result, as a hash.
    receiver: How observers read.
    observers: How many.
    expecting: How many of them a message was sent to.
    correct: How many read what was sent to them.
    passed: Whether no check of any observer failed.
    simulated_s: How long the episode was.
    published: What the paper gives for it.
    outcomes: One for each observer.
    scenario: Every field of the scenario.
  """

  case: str
  group: str
  label: str
  identity: str
  receiver: str
  observers: int
  expecting: int
  correct: int
  passed: bool
  simulated_s: float
  published: suites.Published | None
  outcomes: tuple[verdicts.Outcome, ...]
  scenario: dict[str, Any]

  @property
  def as_published(self) -> bool:
    """Whether it gave what the paper does."""
    return self.published == suites.Published(self.correct, self.passed)

  @property
  def as_expected(self) -> bool:
    """Whether it passed, or failed as published."""
    return self.passed or self.as_published


def by_group(rows: Iterable[SuiteRow]) -> dict[str, list[SuiteRow]]:
  """The rows of each group, wherever they stand."""
  out: dict[str, list[SuiteRow]] = {}
  for row in rows:
    out.setdefault(row.group, []).append(row)
  return out


@dataclasses.dataclass(frozen=True)
class Tally:
  """What some episodes of a suite gave together.

  Attributes:
    broadcasts: How many.
    passed: How many of them passed every check.
    observers: How many observers they had.
    correct: How many of these read what was sent to them.
    wrong: How many read a message that was not sent to them.
    moved: How many left their place without the message sent to them.
  """

  broadcasts: int
  passed: int
  observers: int
  correct: int
  wrong: int
  moved: int

  @property
  def messages(self) -> str:
    """Such as '44/53'."""
    return f'{self.correct}/{self.observers}'

  @property
  def groups(self) -> str:
    """Such as '13/17'."""
    return f'{self.passed}/{self.broadcasts}'

  @classmethod
  def of(cls, rows: Sequence[SuiteRow]) -> 'Tally':
    """Counts some rows."""
    outcomes = [outcome for row in rows for outcome in row.outcomes]
    return cls(
      len(rows),
      sum(row.passed for row in rows),
      sum(row.observers for row in rows),
      sum(row.correct for row in rows),
      sum(outcome.wrong for outcome in outcomes),
      sum(outcome.unauthorised for outcome in outcomes),
    )


@dataclasses.dataclass(frozen=True, kw_only=True)
class Exposure(verdicts.Account):
  """What became of one observer of a sweep, or of one replay.

  Attributes:
    true_angle_deg: Where it stood, seen from the performer.
    true_distance_m: The same.
    right: Whether it read what was sent, or nothing where nothing was.
    wrong: Whether it read something else.
    unauthorised: Whether it moved without a right message.
    stages: Which checks failed.
    events: How many it saw.
    seen_angle_deg: From where it believes that it saw its message.
    seen_distance_m: The same.
    spoilt: How its images were, in a replay.
    read_ms: How long its receiver took for an image, the median; on a board.
    acquired_s: How long after the first motion it held the dancer, see
      `acquired`; on a board.
  """

  true_angle_deg: float
  true_distance_m: float
  right: bool
  wrong: bool
  unauthorised: bool
  stages: tuple[str, ...]
  events: int = 0
  seen_angle_deg: float | None = None
  seen_distance_m: float | None = None
  spoilt: str = ''
  read_ms: float | None = None
  acquired_s: float | None = None

  @classmethod
  def of(
    cls, outcome: verdicts.Outcome, pose: layouts.Pose, **more: object
  ) -> 'Exposure':
    """What became of one observer.

    Args:
      outcome: What its episode was.
      pose: Where it stood.
      **more: What else is told of it, or told otherwise.
    """
    x_m, y_m, _ = pose.position_m
    told: dict[str, Any] = {
      **vars(outcome),
      'true_angle_deg': round(math.degrees(math.atan2(x_m, -y_m)), 6),
      'true_distance_m': round(math.hypot(x_m, y_m), 6),
      'right': outcome.decoded == outcome.expected,
      'wrong': outcome.wrong,
      'unauthorised': outcome.unauthorised,
      'stages': tuple(each.partition(':')[0] for each in outcome.failures),
    }
    return cls(**told | more)


@dataclasses.dataclass(frozen=True, kw_only=True)
class SweepRow:
  """One episode of a sweep.

  Attributes:
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


def table(row: SuiteRow | SweepRow) -> dict[str, Any]:
  """A row as plain data, without what is told of other kinds of rows."""
  whole = encoding.stamped(row)
  for each in whole['outcomes']:
    unlike = [*(_OF_FLIGHTS if each.get('spoilt') else _OF_REPLAYS)]
    if each.get('read_ms') is None:
      unlike += _OF_BOARDS
    for name in unlike:
      each.pop(name, None)
  return whole


def read_suite(folder: pathlib.Path) -> list[SuiteRow]:
  """The rows of a suite.

  Raises:
    ArchiveError: if there are none, or they are damaged.
    FormatError: if a newer program wrote them.
  """
  path = folder / RESULTS
  rows = archive.read_rows(path, SuiteRow)
  if not rows:
    raise archive.ArchiveError(f'{path} holds no results')
  return rows


def read_sweep(folder: pathlib.Path) -> list[SweepRow]:
  """The rows of a sweep, or as many as there are yet.

  Fields of a scenario that a row of an older program lacks have their default:
  what they say did not exist then.

  Raises:
    ArchiveError: if there are none, or they are damaged.
    FormatError: if a newer program wrote them.
  """
  path = folder / RESULTS
  if path.exists():
    rows = archive.read_rows(path, SweepRow)
  else:
    path = folder / JOURNAL
    try:
      rows = archive.rows(journal.read(path), SweepRow, path)
    except OSError as error:
      raise archive.ArchiveError(f'{path} cannot be read: {error}') from None
  if not rows:
    raise archive.ArchiveError(f'{folder} holds no results of a sweep')
  usual = scenario_fields.defaults()
  for row in rows:
    if strange := [name for name in row.scenario if name not in usual]:
      raise archive.ArchiveError(
        f'{path} holds what this program does not know: a scenario with'
        f' `{strange[0]}`; the program that flew it can show it'
      )
  return [
    dataclasses.replace(row, scenario={**usual, **row.scenario}) for row in rows
  ]
