"""A board as tables for people."""

from collections.abc import Iterable, Sequence
import dataclasses
import itertools
import math
import statistics
import textwrap

from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.results import board_file, intervals
from waggle_tasks.experiments.studies import board_cases, board_tiers

ALL = 'all'
_NOTHING = '-'
HEADER = (
  'tier', 'language', 'receiver', 'delivered', '95 %', 'wrong', 'at most',
  'moved', 'ms', 'held after s', 'held',
)  # fmt: skip
PAIRS = ('tier', 'A', 'B', 'both', 'only A', 'only B', 'neither', 'p')
LEGEND = (
  'delivered: broadcasts of which every observer read what was sent, of all'
  ' that sent a message, each counted once, and 95 % limits in percent'
  ' (Clopper-Pearson).',
  'wrong: broadcasts of which an observer read something else than was sent, or'
  ' anything where nothing was, at most so many with 95 % confidence'
  ' (one-sided). moved: those of which one left its place without a right'
  ' message.',
  'ms: what a receiver took for an image on the machine that flew it, median'
  ' of the medians of broadcasts.',
  'held after: from the first motion to when the track that a receiver tells of'
  ' lies on the dancer, within its width, for 0.4 s; 0 where it did before. The'
  ' median of the observers that held it, and how many did. Films have no truth'
  ' to tell it by.',
)
PAIRS_LEGEND = (
  'p: exact two-sided McNemar test of the broadcasts that both receivers were'
  ' shown; "all" pools tiers, which no single use does.'
)


@dataclasses.dataclass(frozen=True)
class Tally:
  """What became of some broadcasts with one receiver.

  Attributes:
    broadcasts: How many.
    sent: How many of them sent a message.
    delivered: How many were read by all to whom they were sent.
    wrong: Of how many an observer read something else.
    moved: Of how many one left its place without a right message.
    read_ms: See `LEGEND`.
    held: How many observers held the dancer.
    watched: How many there were, where something moved.
    held_s: How long after the first motion they did: the median, or None.
  """

  broadcasts: int
  sent: int
  delivered: int
  wrong: int
  moved: int
  read_ms: float
  held: int
  watched: int
  held_s: float | None

  @classmethod
  def of(cls, results: Iterable[board_file.Result]) -> 'Tally':
    """Counts results, those of a broadcast once."""
    kept = [*{each.broadcast: each for each in results}.values()]
    times = [time_s for each in kept for time_s in each.acquired_s]
    held = [time_s for time_s in times if time_s is not None]
    return cls(
      len(kept),
      sum(each.sent for each in kept),
      sum(each.delivered for each in kept),
      sum(each.wrong > 0 for each in kept),
      sum(each.moved > 0 for each in kept),
      statistics.median(each.read_ms for each in kept),
      len(held),
      len(times),
      statistics.median(held) if held else None,
    )

  @property
  def cells(self) -> tuple[str, ...]:
    """Its columns, from 'delivered' on."""
    limits = _NOTHING
    if self.sent:
      low, high = intervals.clopper_pearson(self.delivered, self.sent)
      limits = f'{math.floor(low * 100)}-{math.ceil(high * 100)}'
    held = _NOTHING if self.held_s is None else f'{self.held_s:.2f}'
    return (
      f'{self.delivered}/{self.sent}', limits,
      f'{self.wrong}/{self.broadcasts}',
      f'{intervals.upper_limit(self.wrong, self.broadcasts):.1%}',
      str(self.moved), f'{self.read_ms:.2f}', held,
      f'{self.held}/{self.watched}' if self.watched else _NOTHING,
    )  # fmt: skip


def tiers(board: board_file.Board) -> list[str]:
  """Its tiers, in the order of the suite."""
  return [name for name in board_tiers.TIERS if name in board.scenes]


def lines(
  board: board_file.Board, tier: str | None = None
) -> list[tuple[str, ...]]:
  """The lines of the table: of a tier, or of all, with their sums."""
  out: list[tuple[str, ...]] = []
  names = tiers(board) if tier is None else [tier]
  for name in names:
    own = [each for each in board.results if each.tier == name]
    unread = [each for each in board.unread if each.tier == name]
    spoken = [each.language for each in own]
    spoken += [each.language for each in unread]
    for language in dict.fromkeys(spoken):
      out += _lines(board, own, unread, name, language)
  if tier is None and len(names) > 1:
    for receiver in board.receivers:
      mine = [each for each in board.results if each.receiver == receiver]
      if mine:
        out.append((ALL, ALL, receiver, *Tally.of(mine).cells))
  return out


def _lines(
  board: board_file.Board,
  own: Sequence[board_file.Result],
  unread: Sequence[board_cases.Unread],
  tier: str,
  language: str,
) -> list[tuple[str, ...]]:
  """The lines of a tier in a language."""
  out = []
  for receiver in board.receivers:
    head = tier, language, receiver
    mine = [
      each for each in own
      if (each.receiver, each.language) == (receiver, language)
    ]  # fmt: skip
    if mine:
      out.append((*head, *Tally.of(mine).cells))
    elif any(
      (each.receiver, each.language) == (receiver, language) for each in unread
    ):
      out.append((*head, 'not read', *[''] * (len(HEADER) - 4)))
  return out


def pairs(board: board_file.Board) -> list[tuple[str, ...]]:
  """The lines of the table of paired tests, of all tiers and each."""
  out: list[tuple[str, ...]] = []
  names = tiers(board)
  for one, other in itertools.combinations(board.receivers, 2):
    for tier in names if len(names) == 1 else (*names, ALL):
      a, b = (_sent(board, each, tier) for each in (one, other))
      shared = a.keys() & b.keys()
      if not shared:
        continue
      both = [(a[key], b[key]) for key in shared]
      only_a, only_b = both.count((True, False)), both.count((False, True))
      out.append(
        (
          tier, one, other, str(both.count((True, True))), str(only_a),
          str(only_b), str(both.count((False, False))),
          f'{intervals.mcnemar(only_a, only_b):.3g}',
        )
      )  # fmt: skip
  return out


def _sent(board: board_file.Board, receiver: str, tier: str) -> dict[str, bool]:
  """By broadcast that sent a message, whether a receiver got it."""
  return {
    each.broadcast: each.delivered
    for each in board.results
    if each.sent and each.receiver == receiver and tier in (each.tier, ALL)
  }


def reasons(board: board_file.Board) -> list[str]:
  """Why receivers do not read something, each reason once."""
  by_reason: dict[tuple[str, str, str], list[str]] = {}
  for each in board.unread:
    place = each.receiver, each.language, each.reason
    by_reason.setdefault(place, []).append(each.tier)
  return [
    f'{receiver} does not read {language} in {", ".join(names)}: {reason}'
    for (receiver, language, reason), names in by_reason.items()
  ]


def heading(board: board_file.Board) -> list[str]:
  """What kind of board it is."""
  seeds = (
    'public seeds' if board.referee == board_file.PUBLIC
    else f'private seeds of the referee whose number has hash {board.referee}'
  )  # fmt: skip
  told = {each.broadcast for each in board.results}
  return [
    f'suite {board.suite}, {seeds}; {len(told)} broadcasts, images by'
    f' {", ".join(board.renderers)}'
  ]


def report(board: board_file.Board) -> str:
  """Every table of a board."""
  tests = pairs(board)
  parts = [
    '\n'.join(heading(board)),
    table.render(HEADER, lines(board)),
    '\n'.join(_wrapped(reasons(board))),
    table.render(PAIRS, tests) if tests else '',
    '\n'.join(_wrapped([*LEGEND, *([PAIRS_LEGEND] if tests else [])])),
  ]
  return '\n\n'.join(filter(None, parts))


def _wrapped(sentences: Sequence[str]) -> list[str]:
  return [textwrap.fill(each, 80) for each in sentences]


def is_safe(board: board_file.Board) -> bool:
  """Whether nobody read a wrong message or moved without a right one."""
  return not any(each.wrong or each.moved for each in board.results)
