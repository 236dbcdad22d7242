"""How often coded messages are right, wrong and refused on a noisy channel."""

import dataclasses
import functools

import numpy as np

from waggle_tasks import errors
from waggle_tasks.protocol import checks, coding

CONFUSIONS = ('any', 'natural', 'gray')
_BATCH = 100_000
_MISSING = 255


class ChannelError(errors.WaggleError):
  """A channel that there cannot be."""


@dataclasses.dataclass(frozen=True)
class Channel:
  """What happens to each symbol, whatever happens to the others.

  Attributes:
    substitution: Probability that another symbol is seen.
    erasure: Probability that none is; both together are at most 1.
    confusion: Which other: `any` with equal chances; or that of the level above
      or below, where level k dances symbol k (`natural`) or symbol k ^ k >> 1
      (`gray`), so that neighbours differ in one bit. The levels at the ends
      have one neighbour, which is then the one that is seen.
  """

  substitution: float
  erasure: float
  confusion: str = 'any'

  def __post_init__(self) -> None:
    limits = {'substitution': (0.0, 1.0), 'erasure': (0.0, 1.0)}
    checks.settle_numbers(self, limits, ChannelError)
    checks.settle_numbers(
      self, {'substitution': (0.0, 1.0 - self.erasure)}, ChannelError
    )
    checks.choice('confusion', self.confusion, CONFUSIONS, ChannelError)

  def others(self, size: int) -> np.ndarray:
    """(size, choices) What may be seen of each symbol in its place."""
    symbols = np.arange(size)
    if self.confusion == 'any':
      return symbols[:, None] ^ symbols[1:]
    levels = symbols ^ symbols >> 1 if self.confusion == 'gray' else symbols
    # What is beyond an end is its only neighbour.
    around = np.pad(levels, 1, mode='reflect')
    out = np.empty((size, 2), int)
    out[levels] = np.stack([around[:-2], around[2:]], axis=1)
    return out

  def received(
    self, sent: np.ndarray, size: int, rng: np.random.Generator
  ) -> np.ndarray:
    """What is seen of symbols, (N, L), with 255 for those that are not."""
    others = self.others(size)
    chance = rng.random(sent.shape, np.float32)
    picked = others[sent, rng.integers(others.shape[1], size=sent.shape)]
    wrong = chance < self.erasure + self.substitution
    seen = np.where(wrong, picked, sent)
    return np.where(chance < self.erasure, _MISSING, seen).astype(np.uint8)


@dataclasses.dataclass(frozen=True)
class Counts:
  """Messages by what became of them."""

  right: int
  wrong: int
  refused: int


def simulate(
  code: coding.Coding,
  num_bits: int,
  size: int,
  channel: Channel,
  messages: int,
  seed: int = 0,
) -> Counts:
  """Sends random messages, and counts what is read of them.

  Checks and codes are linear: whether a message is read rightly depends on
  which symbols are missing and by which bits the others differ, not on the
  message. So each such pattern is read once, on a message of zeros.

  Args:
    code: How messages are coded.
    num_bits: Bits of a message.
    size: How many symbols the alphabet has.
    channel: What happens to symbols.
    messages: How many are sent.
    seed: Of the messages and the channel.
  """
  checks.integer('messages', messages, 1, 10**10, ChannelError)
  rng = np.random.default_rng(seed)
  zeros = '0' * num_bits
  zero = np.array(code.symbols(zeros, size), np.uint8)
  units = [f'{1 << k:0{num_bits}b}' for k in range(num_bits)]
  words = [np.array(code.symbols(unit, size), np.uint8) for unit in units]
  steps = [word ^ zero for word in words]

  @functools.lru_cache(maxsize=2**18)
  def outcome(pattern: bytes) -> int:
    pairs = zip(pattern, zero.tolist(), strict=True)
    seen = [None if p == _MISSING else p ^ symbol for p, symbol in pairs]
    bits = code.read(seen, num_bits, size).bits
    return 2 if bits is None else int(bits != zeros)

  totals = [0, 0, 0]
  for begin in range(0, messages, _BATCH):
    batch = min(_BATCH, messages - begin)
    bits = rng.integers(2, size=(batch, num_bits), dtype=np.uint8)
    sent = np.tile(zero, (batch, 1))
    for column, step in zip(bits.T, steps, strict=True):
      sent ^= column[:, None] * step
    seen = channel.received(sent, size, rng)
    patterns = np.where(seen == _MISSING, _MISSING, seen ^ sent)
    spoilt = patterns[patterns.any(axis=1)]
    totals[0] += batch - len(spoilt)
    rows, numbers = np.unique(spoilt, axis=0, return_counts=True)
    for row, number in zip(rows, numbers.tolist(), strict=True):
      totals[outcome(row.tobytes())] += number
  return Counts(*totals)
