"""Decides between whole code words by all that was seen of their symbols.

A word is as near to what was seen as its symbols are together: no symbol is
decided alone, and one that was not seen speaks for none. All words of a block
are compared, which no other decoder can better; blocks of very many words are
decided symbol by symbol, with erasures.
"""

import functools
import itertools

import numpy as np

from waggle_tasks.agents import joint
from waggle_tasks.protocol import coding as coding_lib
from waggle_tasks.protocol import reed_solomon

_MOST = 2**15  # Words that are compared...
_NEAREST = 64  # ...and so many of them exactly.


@functools.cache
def _words(data: int, parity: int, size: int) -> np.ndarray:
  """All words of a block, (W, data + parity)."""
  rows = itertools.product(range(size), repeat=data)
  if not parity:
    return np.array([*rows])
  return np.array([reed_solomon.encode(row, parity, size) for row in rows])


def decide(
  reader: joint.Reader, blocks: tuple[coding_lib.Block, ...], size: int
) -> tuple[np.ndarray, float]:
  """The word that is nearest to what was seen, block by block.

  Args:
    reader: What was seen.
    blocks: Which symbols belong together.
    size: How many symbols there are.

  Returns:
    The word (N,), and how clear it is: how much nearer the least clear block
    is than any other word, as a share of how far that is from it if all is
    seen: 1 when every symbol was seen where it should be.
  """
  word, clear = reader.word.copy(), np.inf
  gains = _gains(reader, size)
  for block in blocks:
    places, parity = np.array(block.places), len(block.places) - block.data
    if size**block.data > _MOST:
      part, part_clear = _hard(reader, gains, places, parity)
    else:
      words = _words(block.data, parity, size)
      part, part_clear = _nearest(reader, gains, places, words)
    word[places], clear = part, min(clear, part_clear)
  return word, float(min(clear, 1.0))


def _gains(reader: joint.Reader, size: int) -> np.ndarray:
  """(N, M) how much farther every other symbol is, with all others as read."""
  count = len(reader.word)
  words = np.tile(reader.word, (count, size, 1))
  places = np.arange(count)
  words[places, :, places] = np.arange(size)
  costs = reader.costs(words.reshape(-1, count)).reshape(count, size)
  return costs - costs[places, reader.word][:, None]


def _nearest(
  reader: joint.Reader,
  gains: np.ndarray,
  places: np.ndarray,
  words: np.ndarray,
) -> tuple[np.ndarray, float]:
  """The nearest of some words of a block, and how clear that is."""
  rough = gains[places, words].sum(axis=1)
  words = words[np.argsort(rough, kind='stable')[:_NEAREST]]
  whole = np.tile(reader.word, (len(words), 1))
  whole[:, places] = words
  costs = reader.costs(whole)
  best = int(costs.argmin())
  if (words[best] != reader.word[places]).any():
    return words[best], 0.0  # To be looked at again.
  others = np.arange(len(words)) != best
  far = reader.apart(whole[others])
  return words[best], float(((costs[others] - costs[best]) / far).min())


def _hard(
  reader: joint.Reader, gains: np.ndarray, places: np.ndarray, parity: int
) -> tuple[np.ndarray, float]:
  """A block whose symbols are decided alone: those that are clear count."""
  size = gains.shape[1]
  alone = np.arange(size)[:, None]
  told = [
    _nearest(reader, gains, places[k : k + 1], alone)
    for k in range(len(places))
  ]
  clears = np.array([clear for _, clear in told])
  symbols = np.array([int(symbol[0]) for symbol, _ in told])
  # The least clear ones are left out, as many as leave one to confirm.
  kept = np.sort(clears)[max(parity - 1, 0)]
  seen = [
    int(symbol) if clear >= kept else None
    for symbol, clear in zip(symbols, clears, strict=True)
  ]
  block = reed_solomon.decode(seen, parity, size, min(parity, 1))
  if block is None:
    return symbols, 0.0
  return np.array(block), float(kept)
