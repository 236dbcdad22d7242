"""Reads letters and confirms them with a short dance of its own."""

from collections.abc import Sequence
import math

from waggle_tasks.agents import part, strips
from waggle_tasks.protocol import accord as accord_lib
from waggle_tasks.protocol import letters


class _Sender:
  """What a listener knows of one who sends.

  Attributes:
    owed_s: When what it owes a reply for was read; None without a debt.
    failed: Whether that is a frame that failed.
    parts: What was read of its message, by number.
    rests_s: Since when it rests; infinite while it does not.
  """

  def __init__(self) -> None:
    self.owed_s: float | None = None
    self.failed = False
    self.parts: dict[int, str] = {}
    self.rests_s = math.inf


class Listener:
  """One who reads; see `part.Part`.

  A reply is danced when the sender has rested for the agreed time, and not at
  all when that is later than the sender would see it.
  """

  hears: str = part.LETTERS

  def __init__(
    self,
    accord: accord_lib.Accord,
    member: int,
    mute: bool = False,
    flies: bool = True,
  ) -> None:
    """Listens to all whom it sees.

    Args:
      accord: The rules.
      member: Its own number.
      mute: Whether it answers nothing.
      flies: Whether it flies what it was told.
    """
    self._accord, self._member, self._mute = accord, member, mute
    self._flies = flies and accord.parts is None
    self._senders = {view.member: _Sender() for view in accord.views(member)}
    self._message: tuple[int, str] | None = None  # Whose, and what.
    self.order: str | None = None
    self.done = False
    self.diary: list[part.Entry] = []

  @property
  def message(self) -> str | None:
    """What it was told; None before all of it was read."""
    return None if self._message is None else self._message[1]

  def step(
    self,
    now_s: float,
    heard: Sequence[strips.Heard],
    busy: frozenset[int],
  ) -> part.Say | None:
    """See `part.Part`."""
    for each in heard:
      self._hear(each)
    for member, sender in self._senders.items():
      if member in busy:
        sender.rests_s = math.inf
      elif not math.isfinite(sender.rests_s):
        sender.rests_s = now_s
    self._obey(now_s)
    for member, sender in self._senders.items():
      if sender.owed_s is None or self._mute:
        continue
      if now_s > sender.owed_s + self._accord.late_s:
        sender.owed_s = None
      elif now_s >= sender.rests_s + self._accord.ready_s:
        return self._answer(member, sender, now_s)
    return None

  def _hear(self, each: strips.Heard) -> None:
    sender = self._senders[each.member]
    if each.bits is None:
      if not (sender.owed_s is not None and not sender.failed):
        sender.owed_s, sender.failed = each.time_s, True
      self._note(each.time_s, each.member, 'fails', each.reason)
      return
    letter = self._accord.form.read(each.bits)
    if letter.recipient not in (self._member, letters.NOBODY):
      note = f'for {letter.recipient}'
      self._note(each.time_s, each.member, 'passes', note, each.bits)
      return
    sender.owed_s, sender.failed = each.time_s, False
    if self._accord.parts is None:
      self._note(each.time_s, each.member, 'reads', letter.payload, each.bits)
      self._take(each, letter.payload)
      return
    if not letter.number < self._accord.parts.count:
      self._note(
        each.time_s, each.member, 'refused',
        f'there is no part {letter.number}', each.bits,
      )  # fmt: skip
      sender.failed = True
      return
    if sender.parts.get(letter.number, letter.payload) != letter.payload:
      sender.parts.clear()  # Two messages are not mixed.
    sender.parts[letter.number] = letter.payload
    note = f'part {letter.number}'
    self._note(each.time_s, each.member, 'reads', note, each.bits)
    if len(sender.parts) == self._accord.parts.count:
      whole = self._accord.parts.join(sender.parts)
      if whole is None:
        sender.parts.clear()
      else:
        self._take(each, whole)

  def _take(self, each: strips.Heard, bits: str) -> None:
    if self._message is None:
      self._message = each.member, bits
      self._note(each.time_s, each.member, 'has', bits)

  def _answer(
    self, member: int, sender: _Sender, now_s: float
  ) -> part.Say | None:
    """What it has of a sender's message, or that a frame failed."""
    failed, parts = sender.failed, self._accord.parts
    sender.owed_s, sender.failed = None, False
    has = ''
    if parts:
      has = ''.join(str(int(k in sender.parts)) for k in range(parts.count))
    elif failed and self._message and self._message[0] == member:
      failed = False  # It was said again, and is known.
    number = letters.NOBODY if failed and not parts else self._member
    bits = self._accord.replies.write(letters.Reply(number, member, has))
    note = f'has {has}' if parts else ('NACK' if failed else 'ACK')
    self._note(now_s, member, 'says', note, bits)
    return part.Say(part.REPLIES, bits, note)

  def _obey(self, now_s: float) -> None:
    """Ends, and flies a payload, when its sender has no more to say."""
    if self._message is None or self.order is not None:
      return
    member, payload = self._message
    if now_s >= self._senders[member].rests_s + self._accord.over_s:
      self.order = payload if self._flies else None
      self.done = True

  def _note(
    self, time_s: float, member: int, what: str, note: str, bits: str = ''
  ) -> None:
    self.diary.append(part.Entry(time_s, what, member, note, bits))
