"""How the bits of a message become symbols, and when they are believed."""

from collections.abc import Sequence
import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks, crc, reed_solomon

SIZES = (2, 4, 8, 16)
# As far as crc8 surely notices 3 wrong bits; what is longer goes in packets.
MOST_BITS = 119


class CodingError(errors.WaggleError):
  """A code that does not fit its alphabet, or symbols that are not of it."""


@dataclasses.dataclass(frozen=True)
class Reading:
  """What was made of the symbols of a message.

  Attributes:
    bits: The message; None where it is not believed.
    reason: Why it is not believed; empty where it is.
    filled: Symbols that were missing and that the code gave.
    corrected: Symbols that the code found to be others than were seen.
  """

  bits: str | None
  reason: str = ''
  filled: int = 0
  corrected: int = 0


@dataclasses.dataclass(frozen=True)
class Block:
  """Symbols of a message of which some follow from the others.

  Attributes:
    places: Where they are in the message, data first.
    data: How many of them are data; the others are parity.
  """

  places: tuple[int, ...]
  data: int


@dataclasses.dataclass(frozen=True)
class Coding:
  """A check of the bits, and parity of the symbols.

  Bits and their check are filled up with zeros to whole symbols and cut into
  Reed-Solomon blocks as equal as fit the alphabet. Their symbols are sent in
  turn, one of each block, so that a run of lost symbols spreads over blocks.

  Without a check nothing is corrected, only filled, and one parity symbol of
  every block stays spare: what is believed was confirmed by a symbol that was
  seen. With a check the whole code may be used, and the check decides. With
  neither, every symbol has to be seen, and all that are seen are believed.

  Attributes:
    check: The check of a message's bits: none, crc3, crc4 or crc8.
    parity: Parity symbols of a block, 0 for no code; at most 2 fewer than the
      alphabet has symbols.
  """

  check: str = 'none'
  parity: int = 0

  def __post_init__(self) -> None:
    checks.choice('check', self.check, crc.NAMES, CodingError)
    checks.settle_numbers(self, {'parity': (0, max(SIZES) - 2)}, CodingError)

  def count(self, num_bits: int, size: int) -> int:
    """How many symbols a message takes.

    Args:
      num_bits: Bits of the message, 1 to 119.
      size: How many symbols the alphabet has: 2, 4, 8 or 16.

    Raises:
      CodingError: naming what does not fit.
    """
    data, blocks = self._shape(num_bits, size)
    return data + blocks * self.parity

  def blocks(self, num_bits: int, size: int) -> tuple[Block, ...]:
    """How the symbols of a message belong together; see `count`."""
    count, blocks = self._shape(num_bits, size)
    if not self.parity:
      return tuple(Block((place,), 1) for place in range(count))
    places = range(count + blocks * self.parity)
    return tuple(
      Block((*places[k::blocks],), len(places[k::blocks]) - self.parity)
      for k in range(blocks)
    )

  def symbols(self, bits: str, size: int) -> tuple[int, ...]:
    """The symbols of a message, each 0 to `size` - 1.

    Args:
      bits: 1 to 119 characters of 0 and 1.
      size: As of `count`.

    Raises:
      CodingError: naming what does not fit.
    """
    checks.bits('bits', bits, 1, MOST_BITS, CodingError)
    count, blocks = self._shape(len(bits), size)
    each = size.bit_length() - 1
    word = crc.append(bits, self.check).ljust(count * each, '0')
    data = [int(word[k : k + each], 2) for k in range(0, len(word), each)]
    if not self.parity:
      return (*data,)
    out = [0] * (count + blocks * self.parity)
    for k in range(blocks):
      out[k::blocks] = reed_solomon.encode(data[k::blocks], self.parity, size)
    return (*out,)

  def read(
    self, symbols: Sequence[int | None], num_bits: int, size: int
  ) -> Reading:
    """The message of symbols, if it is to be believed.

    Args:
      symbols: As many as `count`, None for each that could not be told.
      num_bits: Bits of the message.
      size: As of `count`.

    Raises:
      CodingError: naming what does not fit.
    """
    count, blocks = self._shape(num_bits, size)
    total = count + blocks * self.parity
    if len(symbols) != total:
      raise CodingError(
        f'`symbols` must be {total}, as {num_bits} bits take, with'
        f' None for what could not be told: got {len(symbols)}'
      )
    seen = [
      s if s is None
      else checks.integer('symbols', s, 0, size - 1, CodingError)
      for s in symbols
    ]  # fmt: skip
    missing = seen.count(None)
    if missing and not self.parity:
      return Reading(None, f'{missing} symbols missing, and no code')
    whole = [symbol or 0 for symbol in seen]
    spare = int(self.check == 'none')
    for k in range(blocks if self.parity else 0):
      word = seen[k::blocks]
      block = reed_solomon.decode(word, self.parity, size, spare)
      if block is None:
        lost = f'{word.count(None)} of its symbols missing'
        return Reading(None, f'block {k + 1} cannot be decoded: {lost}')
      whole[k::blocks] = block
    pairs = zip(seen, whole, strict=True)
    corrected = sum(was is not None and was != now for was, now in pairs)
    if corrected and self.check == 'none':
      return Reading(None, f'{corrected} symbols wrong, and no check')
    reason, bits = self.judge(whole, num_bits, size)
    return Reading(bits, reason, missing, corrected)

  def judge(
    self, word: Sequence[int], num_bits: int, size: int
  ) -> tuple[str, str | None]:
    """The bits of a message whose blocks are whole, or why there are none.

    Args:
      word: Its symbols.
      num_bits: Bits of the message.
      size: As of `count`.
    """
    count, _ = self._shape(num_bits, size)
    data = word[:count]
    each = size.bit_length() - 1
    text = ''.join(f'{symbol:0{each}b}' for symbol in data)
    used = num_bits + crc.width(self.check)
    if '1' in text[used:]:
      return 'what fills the last symbol is not zero', None
    bits = crc.strip(text[:used], self.check)
    return ('', bits) if bits else (f'{self.check} does not hold', None)

  def _shape(self, num_bits: int, size: int) -> tuple[int, int]:
    """How many symbols of data there are, and blocks."""
    size = checks.whole_choice('size', size, SIZES, CodingError)
    num_bits = checks.integer('num_bits', num_bits, 1, MOST_BITS, CodingError)
    if self.parity > size - 2:
      coded = [each for each in SIZES if self.parity <= each - 2]
      raise CodingError(
        f'`parity` must be between 0 and {size - 2} in an alphabet of {size}'
        f' symbols, where a block has at most {size - 1} and one of them is'
        f' data: got {self.parity}, which fits alphabets of {coded}'
      )
    data = -(-(num_bits + crc.width(self.check)) // (size.bit_length() - 1))
    return data, -(-data // (size - 1 - self.parity)) if self.parity else 1
