"""Messages of any length as numbered packets, and a receiver's collection."""

import dataclasses
import math

from waggle_tasks import errors
from waggle_tasks.protocol import checks, crc

_NUMBER_BITS = 5
_MARK = 'crc8'
_CHUNK_BITS = 64  # At most.
MOST_PACKETS = 2**_NUMBER_BITS


class PacketError(errors.WaggleError):
  """A message that packets do not hold, or bits that are no packet."""


@dataclasses.dataclass(frozen=True)
class Packets:
  """How messages are cut.

  A packet is its number and that of the last one, 5 bits each; how many bits
  the last one's chunk has, less one, in as few bits as tell it; a check of the
  whole message, 8 bits; and its chunk, filled up with zeros. So each packet
  tells how long the whole message is, and which one it is a part of.

  Attributes:
    chunk_bits: Bits of the message in a packet, 1 to 64.
  """

  chunk_bits: int = 64

  def __post_init__(self) -> None:
    bounds = {'chunk_bits': (1, _CHUNK_BITS)}
    checks.settle_numbers(self, bounds, PacketError)

  @classmethod
  def of(cls, num_bits: int) -> 'Packets':
    """As few packets as hold a message of some length, of one size.

    Raises:
      PacketError: if it is too long.
    """
    most = MOST_PACKETS * _CHUNK_BITS
    num_bits = checks.integer('bits', num_bits, 1, most, PacketError)
    return cls(math.ceil(num_bits / math.ceil(num_bits / _CHUNK_BITS)))

  @property
  def packet_bits(self) -> int:
    """Bits of every packet."""
    return self._header_bits + self.chunk_bits

  @property
  def _header_bits(self) -> int:
    return 2 * _NUMBER_BITS + self._used_bits + crc.width(_MARK)

  @property
  def most_bits(self) -> int:
    """Bits of the longest message."""
    return MOST_PACKETS * self.chunk_bits

  @property
  def _used_bits(self) -> int:
    return (self.chunk_bits - 1).bit_length()

  def split(self, bits: str) -> tuple[str, ...]:
    """The packets of a message, in order.

    Raises:
      PacketError: if `bits` are none, or more than 32 packets hold.
    """
    checks.bits('bits', bits, 1, self.most_bits, PacketError)
    starts = range(0, len(bits), self.chunk_bits)
    used = len(bits) - starts[-1]
    return tuple(
      self._header(number, len(starts) - 1, used)
      + mark(bits)
      + bits[start : start + self.chunk_bits].ljust(self.chunk_bits, '0')
      for number, start in enumerate(starts)
    )

  def _header(self, number: int, last: int, used: int) -> str:
    numbers = f'{number:0{_NUMBER_BITS}b}{last:0{_NUMBER_BITS}b}'
    width = self._used_bits
    return numbers + (f'{used - 1:0{width}b}' if width else '')

  def parse(self, packet: str) -> tuple[int, 'Whole', str] | None:
    """The number of a packet, what it tells of its message, and its chunk.

    Returns:
      None where no message has such a packet.

    Raises:
      PacketError: if it is not as many characters of 0 and 1 as a packet has.
    """
    size = self.packet_bits
    checks.bits('packet', packet, size, size, PacketError)
    widths = _NUMBER_BITS, _NUMBER_BITS, self._used_bits, crc.width(_MARK)
    parts, at = [], 0
    for width in widths:
      parts.append(packet[at : at + width])
      at += width
    number, last, used = (int(f'0{part}', 2) for part in parts[:3])
    chunk = packet[at:]
    kept = used + 1 if number == last else self.chunk_bits
    if number > last or used >= self.chunk_bits or '1' in chunk[kept:]:
      return None
    return number, Whole(last, used + 1, parts[3]), chunk[:kept]


def mark(bits: str) -> str:
  """What every packet of a message tells of all of it: a check."""
  return crc.append(bits, _MARK)[len(bits) :]


@dataclasses.dataclass(frozen=True)
class Whole:
  """What each packet tells of its message.

  Attributes:
    last: The number of the last packet.
    used: How many bits that one's chunk has.
    mark: See `mark`.
  """

  last: int
  used: int
  mark: str


@dataclasses.dataclass(frozen=True)
class Collector:
  """What a receiver has of a message, from any rounds of its packets.

  A packet of another message, by its number of packets, its length, its check
  or another chunk of the same number, begins a new one: two messages are not
  mixed. A whole one whose check does not hold is none. What is no packet of any
  message changes nothing.

  Attributes:
    packets: How messages are cut.
    whole: What its packets tell of it; None before the first packet.
    chunks: Those that were seen, by their numbers, in order.
  """

  packets: Packets = Packets()
  whole: Whole | None = None
  chunks: tuple[tuple[int, str], ...] = ()

  def add(self, packet: str) -> 'Collector':
    """The collection with one packet more.

    Raises:
      PacketError: if it is not as many characters of 0 and 1 as a packet has.
    """
    parsed = self.packets.parse(packet)
    if parsed is None:
      return self
    number, whole, chunk = parsed
    had = dict(self.chunks)
    if self.whole != whole or had.get(number, chunk) != chunk:
      had = {}
    had[number] = chunk
    return Collector(self.packets, whole, (*sorted(had.items()),))

  @property
  def bits(self) -> str | None:
    """The message; None until all of it was seen."""
    if self.whole is None or len(self.chunks) <= self.whole.last:
      return None
    bits = ''.join(chunk for _, chunk in self.chunks)
    return bits if mark(bits) == self.whole.mark else None


def text_bits(text: str) -> str:
  """The bits of a text in UTF-8.

  Raises:
    PacketError: if it is no text, empty, or has no form in UTF-8.
  """
  if not isinstance(text, str) or not text:
    raise PacketError(f'`text` must be at least one character: got {text!r}')
  try:
    data = text.encode('utf-8')
  except UnicodeEncodeError as error:
    raise PacketError(
      f'`text` must be characters that UTF-8 has: got {text!r}'
    ) from error
  return ''.join(f'{byte:08b}' for byte in data)


def bits_text(bits: str) -> str | None:
  """The text of bits; None where they are none in UTF-8.

  Raises:
    PacketError: if they are not characters of 0 and 1.
  """
  checks.bits('bits', bits, 1, None, PacketError)
  if len(bits) % 8:
    return None
  data = bytes(int(bits[k : k + 8], 2) for k in range(0, len(bits), 8))
  try:
    return data.decode('utf-8')
  except UnicodeDecodeError:
    return None
