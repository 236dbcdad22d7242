"""Checks of bits, by name: cyclic redundancy codes of 3, 4 and 8 bits.

The check is the remainder of the bits, inverted, and stands behind them. As it
is inverted, no word of zeros holds, however long: a dancer that hangs still at
one level sends no message.

How many wrong bits are surely noticed decides the choice of polynomials, by P.
Koopman's tables (https://users.ece.cmu.edu/~koopman/crc/):

| name | polynomial | surely noticed |
|---|---|---|
| crc3 | 0x3, as CRC-3/GSM (3GPP TS 45.003) | any 2, to 4 bits of data |
| crc4 | 0x3, as CRC-4/G-704 (ITU-T G.704) and INTERLAKEN | 2, to 11 bits |
| crc8 | 0x2F, as CRC-8/AUTOSAR (AUTOSAR SWS CRC Library) | 3, to 119 bits |

No polynomial of 3 or 4 bits does so for longer data. Of those of 8 bits that
notice 3 to 119 bits, 0x2F lets fewest patterns of 4 through where data are
short: 5 of 1,001 behind 6 bits, and 0x07 (CRC-8/SMBUS) lets 11 through. Any run
of wrong bits that is no longer than the check is noticed by all of them.
"""

from waggle_tasks import errors
from waggle_tasks.protocol import checks

# With the highest term; 1 has no remainder.
_POLYNOMIALS = {'none': 0b1, 'crc3': 0b1011, 'crc4': 0b10011, 'crc8': 0x12F}
NAMES = (*_POLYNOMIALS,)


class CheckError(errors.WaggleError):
  """A check that there is not, or bits that are none."""


def width(name: str) -> int:
  """How many bits a check has.

  Args:
    name: One of `NAMES`.

  Raises:
    CheckError: if there is no such check.
  """
  checks.choice('check', name, NAMES, CheckError)
  return _POLYNOMIALS[name].bit_length() - 1


def append(bits: str, name: str) -> str:
  """Puts a check behind bits.

  Args:
    bits: At least one character of 0 and 1.
    name: One of `NAMES`.

  Raises:
    CheckError: if there is no such check, or `bits` are none.
  """
  num_bits = width(name)
  checks.bits('bits', bits, 1, None, CheckError)
  inverted = _remainder(int(bits, 2) << num_bits, name) ^ (2**num_bits - 1)
  return bits + f'{inverted:0{num_bits}b}' if num_bits else bits


def strip(bits: str, name: str) -> str | None:
  """Takes the check away from bits, where it holds.

  Args:
    bits: What came of `append`, or what was read in its place.
    name: One of `NAMES`.

  Returns:
    The bits before the check; None where it does not hold, and where there are
    no bits before it.

  Raises:
    CheckError: if there is no such check, or `bits` are none.
  """
  num_bits = width(name)
  checks.bits('bits', bits, 1, None, CheckError)
  data = bits[: len(bits) - num_bits]
  return data if data and append(data, name) == bits else None


def _remainder(value: int, name: str) -> int:
  polynomial = _POLYNOMIALS[name]
  size = polynomial.bit_length()
  while value.bit_length() >= size:
    value ^= polynomial << (value.bit_length() - size)
  return value
