"""What a link delivers: messages counted by scheme and condition."""

from collections.abc import Sequence
import dataclasses
from typing import Any

from waggle_tasks import scenario
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.experiments.results import intervals
from waggle_tasks.experiments.studies import case_rows, link_cases, link_schemes

Row = case_rows.SweepRow


@dataclasses.dataclass(frozen=True)
class Tally:
  """What became of the messages of one scheme.

  A message counts once, however many broadcasts and observers it had. It is
  delivered when every observer read it, and wrong when any of them read
  another; of several broadcasts, what an observer reads first counts.

  Attributes:
    bits: Of a message.
    seconds: How long one takes, with all its rounds.
    messages: How many were sent.
    delivered: How many were read by all.
    wrong: How many were read as others.
    unseen: How many of the others some observer recognised nothing of.
  """

  bits: int
  seconds: float
  messages: int
  delivered: int
  wrong: int
  unseen: int

  @property
  def refused(self) -> int:
    """Messages of which something was recognised, and none believed."""
    return self.messages - self.delivered - self.wrong - self.unseen

  @property
  def share(self) -> float:
    """The share that was delivered."""
    return self.delivered / self.messages

  @property
  def limits(self) -> tuple[float, float]:
    """Its 95 % interval."""
    return intervals.clopper_pearson(self.delivered, self.messages)

  @property
  def wrong_limit(self) -> float:
    """The one-sided 95 % upper limit of the share of wrong messages."""
    return intervals.upper_limit(self.wrong, self.messages)

  @property
  def goodput(self) -> float:
    """Bits delivered in a second."""
    return self.bits * self.share / self.seconds

  def fits(self, airtime_s: float) -> int:
    """How many whole messages can be sent in some time."""
    return int(airtime_s / self.seconds + 1e-9)

  def within(self, airtime_s: float, share: float | None = None) -> float:
    """The share that is delivered if it is sent for some time.

    That follows from the share of one sending if sendings were independent.

    Args:
      airtime_s: For how long.
      share: The share of one sending; None for the measured one.
    """
    share = self.share if share is None else share
    ends = min(share + self.wrong / self.messages, 1.0)  # Whatever was read.
    if not ends:
      return 0.0
    return share / ends * (1 - (1 - ends) ** self.fits(airtime_s))


def airtime_s(scene: scenario.Scenario) -> float:
  """How long a broadcast takes: from its first hover to its last rest."""
  confirm_s = scene.agreement.spoken.confirm_s
  return scene.performance.schedule.end_s + confirm_s


def is_link(rows: Sequence[Row]) -> bool:
  """Whether rows of a sweep are those of a link."""
  return link_cases.SCHEME in rows[0].cell


def grouped(
  rows: Sequence[Row], *names: str
) -> dict[tuple[Any, ...], list[Row]]:
  """Rows by their values of some parts of their cells, as they come."""
  out: dict[tuple[Any, ...], list[Row]] = {}
  for row in rows:
    out.setdefault(tuple(row.cell[name] for name in names), []).append(row)
  return out


def tally(rows: Sequence[Row]) -> Tally:
  """Counts the messages of one scheme; see `whole`."""
  sent = _messages(rows)
  scenes = [scenario_fields.make(each[0].scenario) for each in sent]
  seconds = sum(map(airtime_s, scenes)) / len(scenes) * len(sent[0])
  fates = [*map(_fate, sent)]
  return Tally(
    len(rows[0].scenario['payload']), seconds, len(fates),
    *map(fates.count, ('delivered', 'wrong', 'unseen')),
  )  # fmt: skip


def whole(rows: Sequence[Row]) -> list[Row]:
  """The rows of messages whose broadcasts were all flown."""
  return [
    row for sent in _messages(rows) if len(sent) == _sendings(sent[0])
    for row in sent
  ]  # fmt: skip


def _messages(rows: Sequence[Row]) -> list[list[Row]]:
  """The broadcasts of each message, in the order in which they are sent."""
  out: dict[tuple[Any, ...], list[Row]] = {}
  for row in sorted(rows, key=lambda each: each.repeat):
    number = row.repeat // _sendings(row)
    out.setdefault((*row.cell.values(), number), []).append(row)
  return [*out.values()]


def _sendings(row: Row) -> int:
  return link_schemes.Scheme.of(row.cell[link_cases.SCHEME]).sendings


def _fate(sent: Sequence[Row]) -> str:
  """What became of one message, by all of its broadcasts."""
  observers = [*zip(*(row.outcomes for row in sent), strict=True)]
  first = [
    next((each for each in seen if each.decoded is not None), None)
    for seen in observers
  ]
  if any(each is not None and each.wrong for each in first):
    return 'wrong'
  if all(first):
    return 'delivered'
  lost = [s for s, one in zip(observers, first, strict=True) if one is None]
  blind = any(not any(each.events for each in seen) for seen in lost)
  return 'unseen' if blind else 'refused'
