"""Passes a letter on, from one who is seen to another one who is.

Each hop is read with its own check, and counted. That a letter was passed on,
the one before sees by itself: the next one's dance is its confirmation, and a
letter without it is said again. A letter is passed on once, whoever says it,
so that it neither goes in circles nor comes twice.
"""

from collections.abc import Sequence
import dataclasses
import math

from waggle_tasks.agents import part, strips
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import letters

MOST_HOPS = letters.MOST_MEMBERS - 1


class Relay:
  """One of a chain; see `part.Part`.

  Attributes:
    letter: What it says, or said; None before it has read one.
    confirmed: Whether it was seen to be passed on.
  """

  hears: str = part.LETTERS

  def __init__(
    self,
    accord: accord_lib.Accord,
    member: int,
    begins: letters.Letter | None = None,
  ) -> None:
    """Waits for a letter, or begins with one.

    Args:
      accord: The rules.
      member: Its own number.
      begins: The letter of the first of the chain.
    """
    self._accord, self._member = accord, member
    self.letter = begins
    self._came_from: int | None = None
    self._wants = begins is not None
    self._said = 0
    self._echo_by_s = math.inf
    self._rests_s = dict.fromkeys(
      (view.member for view in accord.views(member)), math.inf
    )
    self._begin_s = accord.agreement.spoken.initial_hover_s if begins else 0.0
    self.confirmed = self.done = False
    self.order: str | None = None
    self.diary: list[part.Entry] = []

  def step(
    self,
    now_s: float,
    heard: Sequence[strips.Heard],
    busy: frozenset[int],
  ) -> part.Say | None:
    """See `part.Part`."""
    for each in heard:
      self._hear(each)
    for member, since_s in self._rests_s.items():
      moves = member in busy
      self._rests_s[member] = math.inf if moves else min(since_s, now_s)
    self._obey(now_s)
    if self._wants:
      return self._pass_on(now_s)
    if not self.confirmed and now_s >= self._echo_by_s and not self.done:
      if self._said < self._accord.tries:
        self._wants = True
      else:
        self.done = True
        note = f'given up after {self._said}: nobody passed it on'
        self._note(now_s, None, 'gives up', note)
    return None

  def _hear(self, each: strips.Heard) -> None:
    if each.bits is None:
      self._note(each.time_s, each.member, 'fails', each.reason)
      return
    found = self._accord.form.read(each.bits)
    what, note = 'passes', f'{found.payload}, hop {found.hops}'
    own = self.letter
    if own is None and found.hops < MOST_HOPS:
      what = 'has'
      self.letter = dataclasses.replace(found, hops=found.hops + 1)
      self._came_from, self._wants = each.member, True
    elif own is None or (own.recipient, own.payload) != (
      found.recipient,
      found.payload,
    ):
      what = 'refused'
    elif each.member == self._came_from and found.hops == own.hops - 1:
      # It did not see this one pass it on.
      self._wants = self._said < self._accord.tries
    elif found.hops == own.hops + 1 and not self.confirmed:
      what = 'confirmed'
      self.confirmed = True
      self.done = self.done or self._member != own.recipient
    self._note(each.time_s, each.member, what, note, each.bits)

  def _pass_on(self, now_s: float) -> part.Say | None:
    """Says the letter, once whom it came from has rested for long enough."""
    if self.letter is None or now_s < self._begin_s:
      return None
    if self._came_from is not None:
      since_s = self._rests_s[self._came_from]
      if now_s < since_s + self._accord.ready_s:
        return None
    self._wants, self._said = False, self._said + 1
    last = self._member == self.letter.recipient
    wait_s = math.inf if last else self._accord.echo_s
    self._echo_by_s = now_s + self._accord.letter_s + wait_s
    bits = self._accord.form.write(self.letter)
    note = f'{self.letter.payload}, hop {self.letter.hops}, try {self._said}'
    self._note(now_s, None, 'says', note, bits)
    return part.Say(part.LETTERS, bits, note)

  def _obey(self, now_s: float) -> None:
    """Flies the letter, if it is for this one and has been passed on."""
    mine = self.letter is not None and self.letter.recipient == self._member
    if not mine or not self._said or self._came_from is None or self.done:
      return
    if now_s >= self._rests_s[self._came_from] + self._accord.over_s:
      self.order = self.letter.payload if self.letter else None
      self.done = True

  def _note(
    self,
    time_s: float,
    member: int | None,
    what: str,
    note: str,
    bits: str = '',
  ) -> None:
    self.diary.append(part.Entry(time_s, what, member, note, bits))


def _is_same(one: letters.Letter, other: letters.Letter) -> bool:
  """Whether two letters are one that was passed on."""
  return (one.recipient, one.payload) == (other.recipient, other.payload)
