"""A board as a file, and boards of several machines as one."""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import hashlib
import json
import pathlib
import statistics

from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import archive, encoding, provenance
from waggle_tasks.experiments.studies import (
  board_cases,
  board_tiers,
  case_rows,
)

FILE = 'board.json'
PUBLIC = 'public'


@dataclasses.dataclass(frozen=True)
class Result:
  """What became of one broadcast with one receiver.

  Attributes:
    receiver: Who read it.
    tier: Of which tier it is.
    language: In which language it was danced.
    scene: Of which scene it is.
    number: Which of the scene's broadcasts.
    identity: What decides the result, as a hash.
    broadcast: The broadcast, as a hash: the same whoever read it.
    sent: Whether a message was sent.
    delivered: Whether every observer to whom it was sent read it.
    wrong: How many observers read something else.
    moved: How many left their place without a right message.
    observers: How many there were.
    read_ms: What the receiver took for an image: the median.
    acquired_s: How long after the first motion each observer held the dancer;
      empty where nobody danced, or nobody knows where the dancer is.
  """

  receiver: str
  tier: str
  language: str
  scene: str
  number: int
  identity: str
  broadcast: str
  sent: bool
  delivered: bool
  wrong: int
  moved: int
  observers: int
  read_ms: float
  acquired_s: tuple[float | None, ...]

  @property
  def key(self) -> tuple[str, str, str, str, int]:
    """What it is the result of."""
    return (
      self.receiver, self.tier, self.language, self.scene, self.number
    )  # fmt: skip

  @property
  def fate(self) -> tuple[object, ...]:
    """What must come out the same on every machine."""
    return self.identity, self.delivered, self.wrong, self.moved

  @classmethod
  def of(cls, row: case_rows.SweepRow) -> 'Result':
    """What a row of a board says."""
    text = json.dumps(row.scenario, sort_keys=True) + _film(row)
    asked = [each for each in row.outcomes if each.expected is not None]
    times_ms = [each.read_ms for each in row.outcomes if each.read_ms]
    return cls(
      row.cell[board_cases.RECEIVER],
      row.cell[board_cases.TIER],
      row.cell[board_cases.LANGUAGE],
      row.cell[board_cases.SCENE],
      row.repeat,
      row.identity,
      hashlib.sha256(text.encode()).hexdigest()[:16],
      bool(asked),
      bool(asked) and all(each.right for each in asked),
      sum(each.wrong for each in row.outcomes),
      sum(each.unauthorised for each in row.outcomes),
      len(row.outcomes),
      statistics.median(times_ms or [0.0]),
      _acquired_s(row),
    )


def _film(row: case_rows.SweepRow) -> str:
  is_film = row.cell[board_cases.TIER] == board_tiers.RECORDINGS
  return row.cell[board_cases.SCENE] if is_film else ''


def _acquired_s(row: case_rows.SweepRow) -> tuple[float | None, ...]:
  if _film(row) or row.scenario['control'] == 'no_send':
    return ()
  return tuple(each.acquired_s for each in row.outcomes)


@dataclasses.dataclass(frozen=True)
class Board:
  """What receivers did, and what decided it.

  Attributes:
    suite: Version of the tiers, see `board_tiers.VERSION`.
    scenes: By tier, a hash of what is danced in it.
    referee: 'public', or a hash of the referee's number.
    sources: A hash of the sources that decide results.
    versions: Of this project and of what it needs.
    receivers: By receiver, a hash of its numbers and of its sources from
      outside.
    unread: What receivers cannot read, and why.
    renderers: What drew the images.
    commands: The shell lines that flew it.
    results: One for each broadcast and receiver.
  """

  suite: int
  scenes: dict[str, str]
  referee: str
  sources: str
  versions: dict[str, str]
  receivers: dict[str, str]
  unread: tuple[board_cases.Unread, ...]
  renderers: tuple[str, ...]
  commands: tuple[str, ...]
  results: tuple[Result, ...]

  @classmethod
  def of(
    cls,
    plan: board_cases.Plan,
    readers: dict[str, str],
    unread: Sequence[board_cases.Unread],
    rows: Sequence[case_rows.SweepRow],
    command: str,
  ) -> 'Board':
    """The board of a plan that was flown.

    Args:
      plan: The plan.
      readers: See `Board.receivers`.
      unread: What of it cannot be read.
      rows: What came of the rest.
      command: The shell line.
    """
    return cls(
      board_tiers.VERSION,
      board_cases.digest(plan.tiers, plan.referee),
      referee(plan.referee),
      provenance.source_digest(provenance.deciding_hashes()),
      provenance.versions(),
      readers,
      tuple(unread),
      tuple(sorted({row.renderer for row in rows})),
      (command,),
      tuple(map(Result.of, rows)),
    )


def referee(number: int | None) -> str:
  """What a board tells of its seeds: whoever has the number can check it."""
  if number is None:
    return PUBLIC
  return hashlib.sha256(f'waggle board {number}'.encode()).hexdigest()[:16]


def write(folder: pathlib.Path, board: Board) -> pathlib.Path:
  """Writes the file of a board and returns its path."""
  text = encoding.pretty(encoding.stamped(board))
  return files.replace(folder / FILE, text)


def read(folder: pathlib.Path) -> Board:
  """Reads the file of a board.

  Raises:
    ArchiveError: if there is none, or it is damaged.
    FormatError: if a newer program wrote it.
  """
  path = folder / FILE
  if not path.exists():
    raise archive.ArchiveError(
      f'{folder} holds no whole board: it has no {FILE}; the command that began'
      ' it goes on with it'
    )
  table = archive.read_json(path)
  return archive.made(Board, table, path)


def merged(boards: Mapping[str, Board]) -> Board:
  """One board of several, of the same suite, seeds, sources and versions.

  Args:
    boards: The boards, by what errors call them.

  Raises:
    BoardError: naming the two that do not go together, and why.
  """
  (first, whole), *others = boards.items()
  for name, board in others:
    _check(first, whole, name, board)
    whole = dataclasses.replace(
      whole,
      scenes={**whole.scenes, **board.scenes},
      receivers={**whole.receivers, **board.receivers},
      unread=_once(whole.unread, board.unread),
      renderers=_once(whole.renderers, board.renderers),
      commands=_once(whole.commands, board.commands),
      results=_once_each(whole.results, board.results),
    )
  return whole


def _once(a: Sequence, b: Sequence) -> tuple:
  return tuple(dict.fromkeys([*a, *b]))


def _once_each(*parts: Iterable[Result]) -> tuple[Result, ...]:
  """Results of the same broadcast and receiver once, the first of them."""
  out: dict[tuple, Result] = {}
  for each in (each for part in parts for each in part):
    out.setdefault(each.key, each)
  return tuple(out.values())


def _check(first: str, a: Board, name: str, b: Board) -> None:
  """Refuses boards that cannot be one."""
  where = f'{first} and {name} are not of one board'
  for field, word in (
    ('suite', 'versions of the suite'),
    ('referee', 'seeds'),
    ('sources', 'sources of this project'),
  ):
    if getattr(a, field) != getattr(b, field):
      raise board_tiers.BoardError(
        f'{where}: their {word} differ, {_short(getattr(a, field))} and'
        f' {_short(getattr(b, field))}'
      )
  for field, word in (
    ('versions', 'versions of'),
    ('scenes', 'what is danced in the tier'),
    ('receivers', 'sources or numbers of the receiver'),
  ):
    one, other = getattr(a, field), getattr(b, field)
    for key in one.keys() & other.keys():
      if one[key] != other[key]:
        raise board_tiers.BoardError(
          f'{where}: {word} {key} differ, {_short(one[key])} and'
          f' {_short(other[key])}'
        )
  known = {each.key: each for each in a.results}
  for each in b.results:
    mine = known.get(each.key)
    if mine is not None and mine.fate != each.fate:
      raise board_tiers.BoardError(
        f'{where}: {each.receiver} read {each.tier}, {each.scene}, in'
        f' {each.language} differently, with {", ".join(a.renderers)} and'
        f' {", ".join(b.renderers)}'
      )


def _short(value: object) -> str:
  return str(value)[:12]
