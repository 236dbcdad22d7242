"""Says a message to all whom it sees, and repeats what is not confirmed.

Stop and wait: a letter is said, all answer at once, and it is said again as
long as somebody has not confirmed it. Of a message in parts, only those are
said again that somebody lacks: selective repeat. Tries are bounded.
"""

from collections.abc import Sequence

import numpy as np

from waggle_tasks.agents import part, strips
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import letters


class Caller:
  """One who has a message for all; see `part.Part`.

  Attributes:
    confirmed: Who has all of it, as far as it knows.
  """

  hears: str = part.REPLIES
  order: str | None = None

  def __init__(
    self,
    accord: accord_lib.Accord,
    member: int,
    bits: str,
    blind: bool = False,
    seed: int = 0,
  ) -> None:
    """Waits to be allowed to begin.

    Args:
      accord: The rules.
      member: Its own number.
      bits: The payload, or the message that parts hold.
      blind: Whether to ask nobody, and to say all in every try.
      seed: Of what is drawn.
    """
    self._random = np.random.RandomState([seed, member])
    self._accord, self._blind = accord, blind
    self._audience = [view.member for view in accord.views(member)]
    chunks = accord.parts.cut(bits) if accord.parts else (bits,)
    self._letters = [
      letters.Letter(chunk, number=number)
      for number, chunk in enumerate(chunks)
    ]
    self._has = {m: set[int]() for m in self._audience}
    self._answered: set[int] = set()
    self._queue = [*range(len(chunks))]
    self._try = 1
    self._next_s = accord.agreement.spoken.initial_hover_s
    self._asks_until_s: float | None = None
    self.done = False
    self.diary: list[part.Entry] = []

  @property
  def confirmed(self) -> tuple[int, ...]:
    """See the class."""
    whole = len(self._letters)
    return tuple(m for m, has in self._has.items() if len(has) == whole)

  def step(
    self,
    now_s: float,
    heard: Sequence[strips.Heard],
    busy: frozenset[int],
  ) -> part.Say | None:
    """See `part.Part`."""
    del busy  # Who answers is heard out.
    for each in heard:
      self._hear(each)
    if self.done or now_s < self._next_s:
      return None
    if self._queue:
      return self._say(now_s)
    waited = self._asks_until_s is not None and now_s < self._asks_until_s
    if waited and len(self._answered) < len(self._audience):
      return None
    self._decide(now_s)
    return None

  def _say(self, now_s: float) -> part.Say:
    """The next letter of this try; after the last one it asks."""
    number = self._queue.pop(0)
    end_s = now_s + self._accord.letter_s
    self._next_s = end_s + self._accord.gap_s
    if not self._queue:
      self._next_s = end_s
      wait_s = 0.0 if self._blind else self._accord.window_s
      self._asks_until_s = end_s + wait_s
      self._answered = set()
    letter = self._letters[number]
    bits = self._accord.form.write(letter)
    one = f'part {number}' if self._accord.parts else letter.payload
    note = f'{one}, try {self._try}'
    self.diary.append(part.Entry(now_s, 'says', None, note, bits))
    return part.Say(part.LETTERS, bits, note)

  def _hear(self, each: strips.Heard) -> None:
    """Takes a reply, if it is one of the member in whose place it was."""
    if each.bits is None or self._asks_until_s is None or self._blind:
      return
    reply = self._accord.replies.read(each.bits)
    entry = (each.time_s, each.member)
    if reply.member not in (each.member, letters.NOBODY):
      note = f'the number {reply.member} in the place of {each.member}'
      self._note(*entry, 'refused', note, each.bits)
      return
    self._answered.add(each.member)
    if reply.member == letters.NOBODY and not reply.has:
      self._note(*entry, 'fails', 'a frame began and failed', each.bits)
      return
    had = len(self._has[each.member])
    owned = {k for k, bit in enumerate(reply.has) if bit == '1'}
    self._has[each.member] |= owned if self._accord.parts else {0}
    has = self._has[each.member]
    whole = len(has) == len(self._letters)
    if whole and had < len(has):
      self._note(*entry, 'confirmed', 'has all of it', each.bits)
    elif not whole:
      lacks = sorted({*range(len(self._letters))} - has)
      self._note(*entry, 'reads', f'lacks {lacks}', each.bits)

  def _note(
    self, time_s: float, member: int | None, what: str, note: str, bits: str
  ) -> None:
    self.diary.append(part.Entry(time_s, what, member, note, bits))

  def _decide(self, now_s: float) -> None:
    """Whether to end, or what to say again."""
    whole = {*range(len(self._letters))}
    lacking = set().union(*(whole - has for has in self._has.values()))
    count = f'{len(self.confirmed)} of {len(self._audience)} confirmed'
    if not self._blind and not lacking:
      self.done = True
      self._note(now_s, None, 'done', f'{count} after {self._tries}', '')
    elif self._try == self._accord.tries:
      self.done = True
      what = 'done' if self._blind else 'gives up'
      note = f'said {self._tries}' if self._blind else (
        f'given up after {self._tries}: {count}'
      )  # fmt: skip
      self._note(now_s, None, what, note, '')
    else:
      self._try += 1
      self._queue = sorted(whole if self._blind else lacking)
      more_s = self._random.uniform(0.0, self._accord.spread_s)
      self._next_s = now_s + self._accord.quiet_s + more_s
      self._asks_until_s = None

  @property
  def _tries(self) -> str:
    return f'{self._try} {"try" if self._try == 1 else "tries"}'
