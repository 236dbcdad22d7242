"""Decides between whole code words by all that was seen of their symbols.

A word is as near to what was seen as its symbols are together: no symbol is
decided alone, and one that was not seen speaks for none. All words of a block
are compared, which no other decoder can better; blocks of very many words are
decided symbol by symbol, with erasures.
"""

import functools
import itertools

import numpy as np

from waggle_tasks.agents import reading
from waggle_tasks.protocol import coding as coding_lib
from waggle_tasks.protocol import reed_solomon

_MOST = 2**15  # Words that are compared.


@functools.cache
def _words(data: int, parity: int, size: int) -> np.ndarray:
  """All words of a block, (W, data + parity)."""
  rows = itertools.product(range(size), repeat=data)
  if not parity:
    return np.array([*rows])
  return np.array([reed_solomon.encode(row, parity, size) for row in rows])


def decide(
  found: reading.Reading, blocks: tuple[coding_lib.Block, ...], size: int
) -> tuple[np.ndarray, float]:
  """The word that is nearest to what was seen, block by block.

  Args:
    found: What was seen.
    blocks: Which symbols belong together.
    size: How many symbols there are.

  Returns:
    The word (N,), and how clear it is: how much nearer the least clear block
    is than any other word, as a share of how far that is from it if all is
    seen: 1 when every symbol was seen where it should be.
  """
  word, clear = found.word.copy(), np.inf
  for block in blocks:
    places, parity = np.array(block.places), len(block.places) - block.data
    if size**block.data > _MOST:
      part, part_clear = _hard(found, places, parity, size)
    else:
      words = _words(block.data, parity, size)
      part, part_clear = _nearest(found, places, words)
    word[places], clear = part, min(clear, part_clear)
  return word, float(clear)


def _nearest(
  found: reading.Reading, places: np.ndarray, words: np.ndarray
) -> tuple[np.ndarray, float]:
  """The nearest of some words, and how clear that is."""
  costs = found.gains[places, words].sum(axis=1)
  best = int(costs.argmin())
  far = found.apart[places, words[best], words].sum(axis=1)
  others = np.arange(len(words)) != best
  clear = (costs - costs[best])[others] / far[others]
  return words[best], float(clear.min())


def _hard(
  found: reading.Reading, places: np.ndarray, parity: int, size: int
) -> tuple[np.ndarray, float]:
  """A block whose symbols are decided alone: those that are clear count."""
  alone = np.arange(size)[:, None]
  told = [_nearest(found, places[k : k + 1], alone) for k in range(len(places))]
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
