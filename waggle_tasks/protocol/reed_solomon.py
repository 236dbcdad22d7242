"""Reed-Solomon blocks: parity symbols by which others are filled or corrected.

As a polynomial over its field (`finite_field`), the first symbol being the
highest power, a block with p parity symbols has the roots x, x^2 .. x^p. Any
two blocks differ in more than p places: where f symbols are missing and e are
wrong, no other block is so near while 2 e + f <= p.
"""

from collections.abc import Sequence
import functools
import itertools

from waggle_tasks import errors
from waggle_tasks.protocol import checks, finite_field


class ReedSolomonError(errors.WaggleError):
  """A block that its alphabet has no code for, or a symbol not of it."""


def encode(data: Sequence[int], parity: int, size: int) -> tuple[int, ...]:
  """Puts parity symbols behind data.

  Args:
    data: At least one symbol, each 0 to `size` - 1.
    parity: How many parity symbols to put, 0 to `size` - 2.
    size: How many symbols the alphabet has: 4, 8 or 16. A block is shorter
      than that.

  Raises:
    ReedSolomonError: naming what does not fit.
  """
  size, parity = _settled(size, parity)
  known = [_symbol('data', each, size) for each in data]
  _check_length('data', len(known), 1, size - 1 - parity)
  shifted = [*[0] * parity, *reversed(known)]
  generator = _generator(parity, size)
  _, rest = finite_field.of(size).divided(shifted, generator)
  return (*known, *reversed(rest))


def decode(
  word: Sequence[int | None], parity: int, size: int, spare: int = 0
) -> tuple[int, ...] | None:
  """Fills what is missing of a block and corrects what is wrong.

  Where f symbols are missing and e are wrong, it is the block that was encoded
  if 2 e + f <= parity - spare. A word that no block is so near to gives None.

  Args:
    word: The symbols of a block, None for each that is missing.
    parity: How many of them are parity symbols.
    size: As of `encode`.
    spare: Parity symbols that only confirm: behind every block that is found
      there are as many more symbols, seen, than it needs.

  Returns:
    The whole block, its data first; or None.

  Raises:
    ReedSolomonError: naming what does not fit.
  """
  size, parity = _settled(size, parity)
  spare = checks.integer('spare', spare, 0, parity, ReedSolomonError)
  seen = [s if s is None else _symbol('word', s, size) for s in word]
  _check_length('word', len(seen), parity + 1, size - 1)
  missing = seen.count(None)
  if missing > parity - spare:
    return None
  block = _near(seen, parity, size)
  if block is None:
    return None
  pairs = zip(seen, block, strict=True)
  wrong = sum(was is not None and was != symbol for was, symbol in pairs)
  return block if 2 * wrong + missing <= parity - spare else None


def _settled(size: int, parity: int) -> tuple[int, int]:
  """Both as plain numbers."""
  sizes = finite_field.SIZES
  size = checks.whole_choice('size', size, sizes, ReedSolomonError)
  return size, checks.integer('parity', parity, 0, size - 2, ReedSolomonError)


def _symbol(field: str, value: int, size: int) -> int:
  return checks.integer(field, value, 0, size - 1, ReedSolomonError)


def _check_length(field: str, length: int, fewest: int, most: int) -> None:
  if not fewest <= length <= most:
    raise ReedSolomonError(
      f'`{field}` must have {fewest} to {most} symbols: got {length}'
    )


@functools.cache
def _generator(parity: int, size: int) -> tuple[int, ...]:
  """The polynomial that every block is a multiple of."""
  field, product = finite_field.of(size), [1]
  for exponent in range(1, parity + 1):
    product = field.product(product, (field.power(exponent), 1))
  return (*product,)


def _syndromes(block: Sequence[int], parity: int, size: int) -> list[int]:
  """What a word is at the roots that a block has: no block, if not all 0."""
  field, upwards = finite_field.of(size), block[::-1]
  return [field.value(upwards, field.power(1 + i)) for i in range(parity)]


def _near(
  seen: Sequence[int | None], parity: int, size: int
) -> tuple[int, ...] | None:
  """A block near a word, by Sugiyama's algorithm and Forney's formula."""
  field = finite_field.of(size)
  block = [symbol or 0 for symbol in seen]
  syndromes = _syndromes(block, parity, size)
  if not any(syndromes):
    return (*block,)
  places = [field.power(len(seen) - 1 - place) for place in range(len(seen))]
  missing = [x for x, s in zip(places, seen, strict=True) if s is None]
  locator, values = _key(field, syndromes, missing)
  slope = [each * (power % 2) for power, each in enumerate(locator)][1:]
  for place, x in enumerate(places):
    back = field.over(1, x)
    if field.value(locator, back):
      continue
    steep = field.value(slope, back)
    if not steep:  # A root twice.
      return None
    block[place] ^= field.over(field.value(values, back), steep)
  return None if any(_syndromes(block, parity, size)) else (*block,)


def _key(
  field: finite_field.Field, syndromes: Sequence[int], missing: Sequence[int]
) -> tuple[list[int], list[int]]:
  """Two polynomials: one with its roots at what is not right, its values there.

  Args:
    field: That of the symbols.
    syndromes: Those of the word with 0 for what is missing.
    missing: Powers of x that stand for the places of what is missing.
  """
  known = [1]
  for x in missing:
    known = field.product(known, (1, x))
  before: list[int] = [*[0] * len(syndromes), 1]
  rest = _trimmed(field.product(syndromes, known)[: len(syndromes)])
  wrong_before, wrong = [0], [1]
  while 2 * (len(rest) - 1) >= len(syndromes) + len(missing):
    quotient, remainder = field.divided(before, rest)
    before, rest = rest, _trimmed(remainder)
    step = field.product(quotient, wrong)
    pairs = itertools.zip_longest(wrong_before, step, fillvalue=0)
    wrong_before, wrong = wrong, [one ^ other for one, other in pairs]
  return field.product(wrong, known), rest


def _trimmed(polynomial: list[int]) -> list[int]:
  """Without the highest powers, where they are 0."""
  while polynomial and not polynomial[-1]:
    polynomial = polynomial[:-1]
  return polynomial
