"""Arithmetic of 4, 8 or 16 symbols, in which each but 0 divides each.

Symbols are polynomials over bits, 3 being x + 1; sums and differences are `^`.
Polynomials over symbols are sequences with the lowest power first.
"""

from collections.abc import Sequence
import dataclasses
import functools

# Primitive over bits: x^2 + x + 1, x^3 + x + 1 and x^4 + x + 1, in which the
# powers of x are all symbols but 0.
_POLYNOMIALS = {4: 0b111, 8: 0b1011, 16: 0b10011}
SIZES = (*_POLYNOMIALS,)


@dataclasses.dataclass(frozen=True)
class Field:
  """A finite field.

  Attributes:
    powers: Those of x, which are all symbols but 0, each once.
  """

  powers: tuple[int, ...]

  def power(self, exponent: int) -> int:
    """A power of x, which may be negative."""
    return self.powers[exponent % len(self.powers)]

  def times(self, first: int, second: int) -> int:
    """The product of two symbols."""
    if not first or not second:
      return 0
    return self.power(self._logs[first] + self._logs[second])

  def over(self, first: int, second: int) -> int:
    """The first symbol divided by the second, which is not 0."""
    if not first:
      return 0
    return self.power(self._logs[first] - self._logs[second])

  def value(self, polynomial: Sequence[int], at: int) -> int:
    """The value of a polynomial."""
    total = 0
    for factor in reversed(polynomial):
      total = self.times(total, at) ^ factor
    return total

  def product(self, first: Sequence[int], second: Sequence[int]) -> list[int]:
    """The product of two polynomials."""
    out = [0] * (len(first) + len(second) - 1)
    for i, one in enumerate(first):
      for j, other in enumerate(second):
        out[i + j] ^= self.times(one, other)
    return out

  def divided(
    self, first: Sequence[int], second: Sequence[int]
  ) -> tuple[list[int], list[int]]:
    """The quotient of two polynomials, and the remainder.

    Args:
      first: What is divided.
      second: By what; its last factor is not 0.
    """
    last = len(second) - 1
    rest, quotient = [*first], [0] * max(len(first) - last, 1)
    for shift in reversed(range(len(first) - last)):
      quotient[shift] = self.over(rest[shift + last], second[-1])
      for i, factor in enumerate(second):
        rest[shift + i] ^= self.times(quotient[shift], factor)
    return quotient, rest[:last]

  @functools.cached_property
  def _logs(self) -> dict[int, int]:
    return {symbol: log for log, symbol in enumerate(self.powers)}


@functools.cache
def of(size: int) -> Field:
  """The field of so many symbols, one of `SIZES`."""
  powers, symbol = [], 1
  for _ in range(size - 1):
    powers.append(symbol)
    symbol <<= 1
    if symbol >= size:
      symbol ^= _POLYNOMIALS[size]
  return Field(tuple(powers))
