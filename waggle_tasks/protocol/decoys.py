"""Performances that are no message, for receivers to leave alone.

Figures of about the size, the duration and the pauses of gestures, and frames
that are not whole or not in order. A receiver must read nothing in any.
"""

from collections.abc import Callable, Sequence
import dataclasses

import numpy as np

from waggle_tasks.protocol import (
  decoy_figures,
  gestures,
  payload,
  schedule,
  timing,
)
from waggle_tasks.protocol.symbols import BITS, Symbol

Tokens = list[Symbol | int]


@dataclasses.dataclass(frozen=True)
class Words:
  """What frames are made of.

  Attributes:
    draw: Draws the symbols of a message.
    size: How many symbols there are.
  """

  draw: Callable[[np.random.RandomState], Sequence[int]]
  size: int = len(BITS)


def _swapped(rng: np.random.RandomState, words: Words) -> Tokens:
  """The symbols of a message in an order that is none."""
  if rng.randint(2):
    return [Symbol.END, *words.draw(rng), Symbol.START]
  motions: Tokens = [Symbol.START, *words.draw(rng), Symbol.END]
  while motions[0] is Symbol.START and motions[-1] is Symbol.END:
    rng.shuffle(motions)
  return motions


def _repeated(rng: np.random.RandomState, words: Words) -> Tokens:
  """A symbol too many, or everything twice and too few symbols."""
  word = words.draw(rng)
  if rng.randint(2):
    twice = rng.randint(len(word))
    return [Symbol.START, *word[: twice + 1], *word[twice:], Symbol.END]
  once: Tokens = [Symbol.START, *word[:2], Symbol.END]
  return [each for symbol in once for each in (symbol, symbol)]


def _half_frame(rng: np.random.RandomState, words: Words) -> Tokens:
  """The first half of a message, and then of another one."""
  word = words.draw(rng)
  half = len(word) // 2
  return [Symbol.START, *word[:half], Symbol.START, *word[half:]]


def _five_bits(rng: np.random.RandomState, words: Words) -> Tokens:
  """A message with a symbol too few."""
  return [Symbol.START, *words.draw(rng)[1:], Symbol.END]


def _seven_bits(rng: np.random.RandomState, words: Words) -> Tokens:
  """A message with a symbol too many: with one hidden, a message is left."""
  word = words.draw(rng)
  return [Symbol.START, *word, rng.randint(words.size), Symbol.END]


def _split(
  rng: np.random.RandomState, words: Words
) -> tuple[Sequence[int], Sequence[int]]:
  """The symbols of a message in two parts, neither of them empty."""
  word = words.draw(rng)
  first = rng.randint(1, len(word))
  return word[:first], word[first:]


def _begun_anew(rng: np.random.RandomState, words: Words) -> Tokens:
  """Broken off and begun anew: a message, with the second START hidden."""
  before, after = _split(rng, words)
  return [Symbol.START, *before, Symbol.START, *after, Symbol.END]


def _run_together(rng: np.random.RandomState, words: Words) -> Tokens:
  """Two short dances: a message, with END and START between them hidden."""
  before, after = _split(rng, words)
  first: Tokens = [Symbol.START, *before, Symbol.END]
  return [*first, Symbol.START, *after, Symbol.END]


def _start_repeated(rng: np.random.RandomState, words: Words) -> Tokens:
  """START again and again, and a symbol too few."""
  starts: Tokens = [Symbol.START] * rng.randint(2, 4)
  return [*starts, *words.draw(rng)[1:], Symbol.END]


def _end_first(rng: np.random.RandomState, words: Words) -> Tokens:
  """END where START should be, and sometimes START where END should be."""
  last = (Symbol.START, Symbol.END)[rng.randint(2)]
  return [Symbol.END, *words.draw(rng), last]


_FRAME_MAKERS = {
  'swapped': _swapped,
  'repeated': _repeated,
  'half_frame': _half_frame,
  'five_bits': _five_bits,
  'seven_bits': _seven_bits,
  'begun_anew': _begun_anew,
  'run_together': _run_together,
  'start_repeated': _start_repeated,
  'end_first': _end_first,
}
DECOYS = (*decoy_figures.MAKERS, *_FRAME_MAKERS)


def figures(name: str, rng: np.random.RandomState) -> list[schedule.Path]:
  """The paths of a decoy that is of figures; empty for one of symbols."""
  make = decoy_figures.MAKERS.get(name)
  return [] if make is None else make(rng)


def tokens(name: str, rng: np.random.RandomState, words: Words) -> Tokens:
  """The motions of a decoy that is of symbols: START, symbols, END."""
  return _FRAME_MAKERS[name](rng, words)


def perform(
  name: str,
  seed: int,
  codebook: gestures.Codebook,
  pauses: timing.Timing,
  num_bits: int = payload.Units().num_bits,
) -> schedule.Schedule:
  """A decoy of the paper's gestures, laid out in time.

  Args:
    name: One of `DECOYS`.
    seed: Each gives another performance of the same kind.
    codebook: The agreed gestures.
    pauses: The agreed pauses.
    num_bits: How many bits a message has.

  Returns:
    The schedule.
  """
  rng = np.random.RandomState(seed)
  if paths := figures(name, rng):
    return schedule.lay_out(paths, pauses)
  words = Words(lambda rng: [rng.randint(2) for _ in range(num_bits)])
  symbols = tuple(
    each if isinstance(each, Symbol) else BITS[each]
    for each in tokens(name, rng, words)
  )
  return schedule.broadcast(symbols, codebook, pauses)
