"""Says letters where others want to dance too.

Who wants to dance looks first: all whom it sees must rest for longer than an
answer may take, and then for a time that is drawn. Who begins together with
another one, or is not answered by whom its letter is for, draws a longer time
and tries again.
"""

from collections.abc import Sequence
import math

import numpy as np

from waggle_tasks.agents import part, strips
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import letters

# A dance that began is surely seen within this time.
_SLOT_S = 0.6
_SLOTS = 4  # To draw from; twice as many with every try.


class Contender:
  """One of several who have something to say; see `part.Part`.

  Attributes:
    confirmed: The recipients that confirmed their letters.
  """

  hears: str = part.REPLIES
  order: str | None = None

  def __init__(
    self,
    accord: accord_lib.Accord,
    member: int,
    told: Sequence[tuple[int, str]],
    seed: int,
    looks: bool = True,
  ) -> None:
    """Waits to be allowed to begin.

    Args:
      accord: The rules.
      member: Its own number.
      told: To whom it says what, one after another.
      seed: Of what is drawn.
      looks: Whether it looks before its first letter.
    """
    self._accord, self._member = accord, member
    self._letters = [letters.Letter(bits, to) for to, bits in told]
    self._random = np.random.RandomState([seed, member])
    self._try, self._rests_s = 1, math.inf
    self._asks_until_s: float | None = None
    self._begin_s = accord.agreement.spoken.initial_hover_s
    self._wait_s = self._draw_s() if looks else -math.inf
    self._waited = False
    self.confirmed: list[int] = []
    self.done = False
    self.diary: list[part.Entry] = []

  def _draw_s(self) -> float:
    """How long all must rest before it begins."""
    slots = int(self._random.randint(_SLOTS * 2 ** (self._try - 1)))
    return self._accord.sense_s + _SLOT_S * slots

  def step(
    self,
    now_s: float,
    heard: Sequence[strips.Heard],
    busy: frozenset[int],
  ) -> part.Say | None:
    """See `part.Part`."""
    for each in heard:
      self._hear(each)
    self._rests_s = math.inf if busy else min(self._rests_s, now_s)
    if self.done or now_s < self._begin_s:
      return None
    if self._asks_until_s is not None:
      if now_s >= self._asks_until_s:
        self._try_again(now_s)
      return None
    if busy and not self._waited and self._wait_s > 0:
      self._waited = True
      note = f'others dance: {sorted(busy)}'
      self.diary.append(part.Entry(now_s, 'waits', None, note))
    if now_s >= self._rests_s + self._wait_s or self._wait_s < 0:
      return self._say(now_s)
    return None

  def _say(self, now_s: float) -> part.Say:
    letter = self._letters[0]
    bits = self._accord.form.write(letter)
    note = f'{letter.payload} to {letter.recipient}, try {self._try}'
    self._asks_until_s = now_s + self._accord.letter_s + self._accord.window_s
    self.diary.append(part.Entry(now_s, 'says', letter.recipient, note, bits))
    return part.Say(part.LETTERS, bits, note)

  def _hear(self, each: strips.Heard) -> None:
    """Takes the answer of whom its letter is for."""
    if each.bits is None or self._asks_until_s is None:
      return
    letter = self._letters[0]
    reply = self._accord.replies.read(each.bits)
    if each.member != letter.recipient or reply.to != self._member:
      return
    what = {each.member: 'confirmed', letters.NOBODY: 'fails'}.get(
      reply.member, 'refused'
    )
    self.diary.append(
      part.Entry(each.time_s, what, each.member, letter.payload, each.bits)
    )
    if what == 'confirmed':
      self.confirmed.append(letter.recipient)
      self._next(each.time_s)

  def _try_again(self, now_s: float) -> None:
    self._try += 1
    if self._try <= self._accord.tries:
      self._asks_until_s, self._waited = None, False
      self._wait_s = self._draw_s()
      return
    letter = self._letters[0]
    note = f'given up after {self._accord.tries}: {letter.recipient} is silent'
    self.diary.append(part.Entry(now_s, 'gives up', letter.recipient, note))
    self._next(now_s)

  def _next(self, now_s: float) -> None:
    """Goes on to the next letter, if there is one."""
    self._letters = self._letters[1:]
    self._try, self._waited, self._asks_until_s = 1, False, None
    self._wait_s = self._draw_s()
    if not self._letters:
      self.done = True
      note = f'confirmed by {self.confirmed}'
      self.diary.append(part.Entry(now_s, 'done', None, note))
