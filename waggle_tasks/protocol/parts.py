"""A message of an agreed length as numbered parts, with a check of the whole.

Whoever answers what it has needs no header that says how long a message is:
both sides know it. So parts are short, and are danced between two black-outs.
"""

from collections.abc import Mapping
import dataclasses

from waggle_tasks import errors
from waggle_tasks.protocol import checks, crc

_CHECK = 'crc8'
_CHUNK_BITS = 9
_MOST_PARTS = 8


class PartsError(errors.WaggleError):
  """A message that parts do not hold."""


@dataclasses.dataclass(frozen=True)
class Parts:
  """How a message is cut.

  Attributes:
    num_bits: How long the message is, 1 to 64 bits.
  """

  num_bits: int

  def __post_init__(self) -> None:
    most = _MOST_PARTS * _CHUNK_BITS - crc.width(_CHECK)
    checks.settle_numbers(self, {'num_bits': (1, most)}, PartsError)

  @property
  def chunk_bits(self) -> int:
    """Bits of a part."""
    return _CHUNK_BITS

  @property
  def count(self) -> int:
    """How many parts there are."""
    return -(-(self.num_bits + crc.width(_CHECK)) // _CHUNK_BITS)

  def cut(self, bits: str) -> tuple[str, ...]:
    """The parts of a message, in order; its check is in the last ones.

    Raises:
      PartsError: if it is not as long as agreed.
    """
    checks.bits('bits', bits, self.num_bits, self.num_bits, PartsError)
    whole = crc.append(bits, _CHECK).ljust(self.count * _CHUNK_BITS, '0')
    return tuple(
      whole[k : k + _CHUNK_BITS] for k in range(0, len(whole), _CHUNK_BITS)
    )

  def join(self, parts: Mapping[int, str]) -> str | None:
    """The message of parts by their numbers; None where it is not whole.

    It is none either where its check does not hold.
    """
    if sorted(parts) != [*range(self.count)]:
      return None
    whole = ''.join(parts[k] for k in range(self.count))
    used = self.num_bits + crc.width(_CHECK)
    return None if '1' in whole[used:] else crc.strip(whole[:used], _CHECK)
