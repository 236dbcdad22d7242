"""What is said in a conversation: letters, and replies to them, as bits."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks

_FIELD_BITS = 3
MOST_MEMBERS = 7
# What stands for no member: for all in a letter, for a failure in a reply.
NOBODY = 2**_FIELD_BITS - 1
_PAYLOAD_BITS = 12


class LetterError(errors.WaggleError):
  """A letter or a reply that has no such form."""


@dataclasses.dataclass(frozen=True)
class Letter:
  """One letter.

  Attributes:
    payload: Its bits.
    recipient: Whom it is for; `NOBODY` for all who see it.
    hops: How often it was passed on.
    number: Which part of a longer message it is.
  """

  payload: str
  recipient: int = NOBODY
  hops: int = 0
  number: int = 0


@dataclasses.dataclass(frozen=True)
class Form:
  """Which fields stand before the payload of a letter, of 3 bits each.

  Attributes:
    payload_bits: Bits of the payload, 3 to 12.
    addressed: Whether it has a recipient.
    hopping: Whether it counts how often it was passed on.
    numbered: Whether it is a part of a longer message.
  """

  payload_bits: int = 6
  addressed: bool = False
  hopping: bool = False
  numbered: bool = False

  def __post_init__(self) -> None:
    bounds = {'payload_bits': (_FIELD_BITS, _PAYLOAD_BITS)}
    checks.settle_numbers(self, bounds, LetterError)

  @property
  def _fields(self) -> tuple[str, ...]:
    fields = {
      'recipient': self.addressed,
      'hops': self.hopping,
      'number': self.numbered,
    }
    return tuple(name for name, there in fields.items() if there)

  @property
  def num_bits(self) -> int:
    """How many bits a letter has."""
    return _FIELD_BITS * len(self._fields) + self.payload_bits

  def write(self, letter: Letter) -> str:
    """The bits of a letter.

    Raises:
      LetterError: if a field does not fit.
    """
    size, head = self.payload_bits, ''
    checks.bits('payload', letter.payload, size, size, LetterError)
    for name in self._fields:
      value = getattr(letter, name)
      checks.integer(name, value, 0, NOBODY, LetterError)
      head += f'{value:0{_FIELD_BITS}b}'
    return head + letter.payload

  def read(self, bits: str) -> Letter:
    """The letter of bits.

    Raises:
      LetterError: if they are not as many as a letter has.
    """
    checks.bits('bits', bits, self.num_bits, self.num_bits, LetterError)
    values = {
      name: int(bits[_FIELD_BITS * k : _FIELD_BITS * (k + 1)], 2)
      for k, name in enumerate(self._fields)
    }
    return Letter(bits[_FIELD_BITS * len(self._fields) :], **values)


@dataclasses.dataclass(frozen=True)
class Reply:
  """What a member answers.

  Attributes:
    member: Who answers; `NOBODY` says that a frame began and failed.
    to: Whose letter it is about, where letters are addressed.
    has: Which parts it has, a character of 0 or 1 for each; empty where a
      letter is a whole message.
  """

  member: int
  to: int = NOBODY
  has: str = ''


@dataclasses.dataclass(frozen=True)
class ReplyForm:
  """The fields of a reply.

  Attributes:
    addressed: Whether it says whose letter it is about.
    parts: How many parts a message has; 0 where a letter is a whole one.
  """

  addressed: bool = False
  parts: int = 0

  @property
  def num_bits(self) -> int:
    """How many bits a reply has."""
    return _FIELD_BITS * (1 + self.addressed) + self.parts

  def write(self, reply: Reply) -> str:
    """The bits of a reply.

    Raises:
      LetterError: if a field does not fit.
    """
    checks.integer('member', reply.member, 0, NOBODY, LetterError)
    checks.integer('to', reply.to, 0, NOBODY, LetterError)
    checks.bits('has', reply.has, self.parts, self.parts, LetterError)
    to = f'{reply.to:0{_FIELD_BITS}b}' if self.addressed else ''
    return f'{reply.member:0{_FIELD_BITS}b}{to}{reply.has}'

  def read(self, bits: str) -> Reply:
    """The reply of bits.

    Raises:
      LetterError: if they are not as many as a reply has.
    """
    checks.bits('bits', bits, self.num_bits, self.num_bits, LetterError)
    split = _FIELD_BITS * (1 + self.addressed)
    to = int(bits[_FIELD_BITS:split], 2) if self.addressed else NOBODY
    return Reply(int(bits[:_FIELD_BITS], 2), to, bits[split:])
