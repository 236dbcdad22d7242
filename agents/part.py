"""What a member of a conversation does: a part, played by pure rules.

A part sees no image: it is told what was read and who moves, and says what to
dance. So the same parts can be played on whatever tells these.
"""

from collections.abc import Sequence
import dataclasses
from typing import Protocol

from waggle_tasks.agents import strips

LETTERS, REPLIES = 'letters', 'replies'


@dataclasses.dataclass(frozen=True)
class Say:
  """A frame that a member wants to dance now.

  Attributes:
    kind: `LETTERS` or `REPLIES`.
    bits: What it says.
    note: What that is, for people.
  """

  kind: str
  bits: str
  note: str


@dataclasses.dataclass(frozen=True)
class Entry:
  """A line of a member's diary.

  Attributes:
    time_s: When.
    what: The kind: 'says', 'reads', 'fails', 'has', 'confirmed', 'refused',
      'waits', 'done', 'gives up'.
    member: Whom it is about; None for the member itself.
    note: What it is, for people.
    bits: What was said or read, where something was.
  """

  time_s: float
  what: str
  member: int | None
  note: str
  bits: str = ''


class Part(Protocol):
  """What every part can do.

  Attributes:
    hears: `LETTERS` or `REPLIES`: what is read now.
    order: The payload that it was given to fly; None before that.
    done: Whether it has nothing more to do, whatever comes.
    diary: What it did, in order.
  """

  hears: str
  order: str | None
  done: bool
  diary: list[Entry]

  def step(
    self,
    now_s: float,
    heard: Sequence[strips.Heard],
    busy: frozenset[int],
  ) -> Say | None:
    """Takes a moment in which the member does not dance.

    Args:
      now_s: The time by its own clock.
      heard: What was just read.
      busy: Who is not seen at rest.

    Returns:
      What it dances now; None for nothing.
    """
    ...
