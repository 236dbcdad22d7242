"""What a link delivers, as tables for people."""

from collections.abc import Sequence
import math
import textwrap

from waggle_tasks import scenario
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.results import envelope, goodput, sweep_tables
from waggle_tasks.experiments.studies import link_cases

ROUNDS = 3  # Of the paper's message: what all schemes are given time for.
# What lines are told apart by, beside the scheme: the rest is counted together.
_FACTORS = (link_cases.CONDITION, 'distance_m', 'bearing_deg')

Table = tuple[tuple[str, ...], list[tuple[str, ...]]]


def usual_airtime_s() -> float:
  """How long the paper's message takes, `ROUNDS` times."""
  return ROUNDS * goodput.airtime_s(scenario.Scenario())


def report(rows: Sequence[goodput.Row], airtime_s: float) -> str:
  """Every table of a link.

  Args:
    rows: Its results, of whole messages.
    airtime_s: How much time all schemes are given to be compared.
  """
  parts = [table.render(*each) for each in tables(rows, airtime_s)]
  lines = [textwrap.fill(line, 80) for line in legend(airtime_s)]
  return '\n\n'.join([*parts, '\n'.join(lines), '\n'.join(totals(rows))])


def tables(rows: Sequence[goodput.Row], airtime_s: float) -> list[Table]:
  """By condition; and by distance and bearing where there are several."""
  several = [
    name
    for name in _FACTORS
    if name == link_cases.CONDITION or len({r.cell[name] for r in rows}) > 1
  ]
  return [_table(rows, name, airtime_s) for name in several]


def _table(rows: Sequence[goodput.Row], factor: str, airtime_s: float) -> Table:
  header = (
    'scheme', factor, 's', 'delivered', '95 %', 'wrong', 'at most', 'refused',
    'unseen', 'bit/s', f'in {airtime_s:.0f} s', '95 %',
  )  # fmt: skip
  groups = goodput.grouped(rows, link_cases.SCHEME, factor)
  return header, [
    (scheme, f'{value:g}' if isinstance(value, float) else value,
     *_cells(goodput.tally(members), airtime_s))
    for (scheme, value), members in groups.items()
  ]  # fmt: skip


def _cells(got: goodput.Tally, airtime_s: float) -> tuple[str, ...]:
  times, limits = got.fits(airtime_s), got.limits
  within = [got.within(airtime_s, share) for share in (got.share, *limits)]
  share = f'{within[0]:.1%}'
  if share == '100.0%' and got.delivered < got.messages:
    share = '> 99.9%'
  later = f'{times} x: {share}', _limits(*within[1:])
  return (
    f'{got.seconds:.1f}', f'{got.delivered}/{got.messages}', _limits(*limits),
    str(got.wrong), f'{got.wrong_limit:.1%}', str(got.refused),
    str(got.unseen), f'{got.goodput:.3f}', *(later if times else ('-', '-')),
  )  # fmt: skip


def _limits(low: float, high: float) -> str:
  """In whole percent, which hold at least what they stand for."""
  return f'{math.floor(low * 100)}-{math.ceil(high * 100)}'


def legend(airtime_s: float) -> list[str]:
  """What the columns of a table are."""
  return [
    's: seconds of a message with all its rounds, from the first hover to the'
    ' rest that confirms the last END.',
    'delivered: messages that every observer read as sent, of all, each a'
    ' broadcast of its own, and 95 % limits in percent (Clopper-Pearson).',
    'wrong: read as another message, at most so many with 95 % confidence'
    ' (one-sided). refused: something was recognised, no message believed.'
    ' unseen: nothing was recognised.',
    'bit/s: bits of a message x share delivered / seconds.',
    f'in {airtime_s:.0f} s: how many whole messages fit into this time, and'
    ' which share is delivered if all of them say the same and losses are'
    ' independent. It is calculated from the share of one, which is all that'
    ' was flown; what hides every sending alike makes it too good.',
  ]


def totals(rows: Sequence[goodput.Row]) -> list[str]:
  """How often there was what must not be, of all schemes together."""
  schemes = goodput.grouped(rows, link_cases.SCHEME).values()
  found = [goodput.tally(members) for members in schemes]
  sent = sum(each.messages for each in found)
  moved = sum(envelope.count([row]).unauthorised > 0 for row in rows)
  return [
    sweep_tables.event_line(
      'wrong messages', sum(each.wrong for each in found), sent, 'messages'
    ),
    sweep_tables.event_line(
      'unauthorised motions', moved, len(rows), 'broadcasts'
    ),
  ]
