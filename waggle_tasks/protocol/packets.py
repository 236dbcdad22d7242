"""Messages of any length as numbered packets, and a receiver's collection."""

import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks

_NUMBER_BITS = 5
MOST_PACKETS = 2**_NUMBER_BITS


class PacketError(errors.WaggleError):
  """A message that packets do not hold, or bits that are no packet."""


@dataclasses.dataclass(frozen=True)
class Packets:
  """How messages are cut.

  A packet is its number and that of the last one, 5 bits each; how many bits
  the last one's chunk has, less one, in as few bits as tell it; and its chunk,
  filled up with zeros. So each packet tells how long the whole message is.

  Attributes:
    chunk_bits: Bits of the message in a packet, 1 to 64.
  """

  chunk_bits: int = 64

  def __post_init__(self) -> None:
    checks.settle_numbers(self, {'chunk_bits': (1, 64)}, PacketError)

  @property
  def packet_bits(self) -> int:
    """Bits of every packet."""
    return 2 * _NUMBER_BITS + self._used_bits + self.chunk_bits

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
      + bits[start : start + self.chunk_bits].ljust(self.chunk_bits, '0')
      for number, start in enumerate(starts)
    )

  def _header(self, number: int, last: int, used: int) -> str:
    numbers = f'{number:0{_NUMBER_BITS}b}{last:0{_NUMBER_BITS}b}'
    width = self._used_bits
    return numbers + (f'{used - 1:0{width}b}' if width else '')

  def parse(self, packet: str) -> tuple[int, int, int, str] | None:
    """The numbers of a packet and of the last, the last's bits, and the chunk.

    Returns:
      None where no message has such a packet.

    Raises:
      PacketError: if it is not as many characters of 0 and 1 as a packet has.
    """
    size = self.packet_bits
    checks.bits('packet', packet, size, size, PacketError)
    number, last = int(packet[:5], 2), int(packet[5:10], 2)
    used = int('0' + packet[10 : 10 + self._used_bits], 2) + 1
    chunk = packet[10 + self._used_bits :]
    kept = used if number == last else self.chunk_bits
    if number > last or used > self.chunk_bits or '1' in chunk[kept:]:
      return None
    return number, last, used, chunk[:kept]


@dataclasses.dataclass(frozen=True)
class Collector:
  """What a receiver has of a message, from any rounds of its packets.

  A packet that contradicts the collection, by another number of packets,
  another length or another chunk of the same number, begins a new one: two
  messages are not mixed. Two messages of the same length of which no packet of
  the same number was seen cannot be told apart. What is no packet of any
  message changes nothing.

  Attributes:
    packets: How messages are cut.
    length: The number of the last packet and the bits of its chunk; None
      before the first packet.
    chunks: Those that were seen, by their numbers, in order.
  """

  packets: Packets = Packets()
  length: tuple[int, int] | None = None
  chunks: tuple[tuple[int, str], ...] = ()

  def add(self, packet: str) -> 'Collector':
    """The collection with one packet more.

    Raises:
      PacketError: if it is not as many characters of 0 and 1 as a packet has.
    """
    parsed = self.packets.parse(packet)
    if parsed is None:
      return self
    number, last, used, chunk = parsed
    had = dict(self.chunks)
    if self.length != (last, used) or had.get(number, chunk) != chunk:
      had = {}
    had[number] = chunk
    return Collector(self.packets, (last, used), (*sorted(had.items()),))

  @property
  def bits(self) -> str | None:
    """The message; None until all of it was seen."""
    if self.length is None or len(self.chunks) <= self.length[0]:
      return None
    return ''.join(chunk for _, chunk in self.chunks)


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
