"""What became of a conversation, as values and as a file."""

from collections.abc import Mapping
import dataclasses
import itertools
import json
import pathlib
from typing import Any

from waggle_tasks import conversation, plain
from waggle_tasks.agents import part
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import encoding

NAME = 'conversation.json'


@dataclasses.dataclass(frozen=True)
class Told:
  """Something that one member had to tell another one.

  Attributes:
    sender: Who says it.
    recipient: Whom it is for.
    bits: What.
  """

  sender: int
  recipient: int
  bits: str


@dataclasses.dataclass(frozen=True)
class Talk:
  """A conversation that was held.

  Attributes:
    scene: Its scenario.
    told: What was to be told to whom.
    diaries: By member, what each noted.
    flew_s: By member, when it began to fly; None for never.
    aside_m: By member, how far it truly was aside of its place at most before
      it was told to fly.
    contacts: Who touched.
    duration_s: How long it took.
    dances_s: By member, for how long it danced.
  """

  scene: conversation.Conversation
  told: tuple[Told, ...]
  diaries: tuple[tuple[part.Entry, ...], ...]
  flew_s: tuple[float | None, ...]
  aside_m: tuple[float, ...]
  contacts: tuple[tuple[str, str], ...]
  duration_s: float
  dances_s: tuple[float, ...]

  def has(self, member: int) -> list[tuple[float, str]]:
    """When a member had all of a message, and what, as it read it."""
    form = self.scene.accord.form
    out = []
    for entry in self.diaries[member]:
      if entry.what == 'has':
        letter = form.read(entry.bits).payload if entry.bits else entry.note
        out.append((entry.time_s, letter))
    return out

  @property
  def delivered(self) -> tuple[Told, ...]:
    """What its recipient has, as it was to be told."""
    return tuple(
      each
      for each in self.told
      if each.bits in [bits for _, bits in self.has(each.recipient)]
    )

  @property
  def wrong(self) -> tuple[tuple[int, str], ...]:
    """Members with a message that nobody had to tell them."""
    meant = {(each.recipient, each.bits) for each in self.told}
    if self.scene.mission == 'relay':  # All of a chain have it.
      meant |= {(k, bits) for _, bits in meant for k in self._members}
    return tuple(
      (k, bits)
      for k in self._members
      for _, bits in self.has(k)
      if (k, bits) not in meant
    )

  @property
  def _members(self) -> range:
    return range(len(self.diaries))

  @property
  def confirmed(self) -> tuple[tuple[int, int, float], ...]:
    """Sender, member and time of every confirmation that was seen."""
    return tuple(
      (sender, entry.member, entry.time_s)
      for sender, diary in enumerate(self.diaries)
      for entry in diary
      if entry.what == 'confirmed' and entry.member is not None
    )

  @property
  def false_confirmations(self) -> tuple[tuple[int, int, float], ...]:
    """Confirmations of members that had nothing that was meant for them."""
    out = []
    for sender, member, time_s in self.confirmed:
      meant = {each.bits for each in self.told}
      had = [at for at, bits in self.has(member) if bits in meant]
      if not had or min(had) > time_s:
        out.append((sender, member, time_s))
    return tuple(out)

  @property
  def strays(self) -> tuple[int, ...]:
    """Members that left their places without a message."""
    return tuple(k for k, m in enumerate(self.aside_m) if m > 0.01)

  @property
  def hops_s(self) -> tuple[float, ...]:
    """Of a relay, how long each hop took, from letter to letter."""
    says = [
      next((e.time_s for e in diary if e.what == 'says'), None)
      for diary in self.diaries
    ]
    times_s = [each for each in says if each is not None]
    return tuple(
      after - before for before, after in itertools.pairwise(times_s)
    )

  @property
  def passed(self) -> bool:
    """Whether everything was told, and nothing wrong happened."""
    whole = len(self.delivered) == len(self.told)
    bad = self.wrong or self.false_confirmations or self.strays or self.contacts
    return whole and not bad


def write(folder: pathlib.Path, talk: Talk) -> pathlib.Path:
  """Writes a conversation as a whole and returns its file."""
  return files.replace(folder / NAME, encoding.pretty(encoding.stamped(talk)))


def read(path: pathlib.Path) -> Talk:
  """A conversation that was written.

  Raises:
    WaggleError: if the file holds none.
  """
  table: Mapping[str, Any] = json.loads(path.read_text(encoding='utf-8'))
  return plain.from_plain(Talk, encoding.unstamped(table, path))
