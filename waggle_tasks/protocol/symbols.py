"""The alphabet: four motions, one stillness, and what was not understood.

Levels are an alphabet of their own, of numbers: a stroke to one is LEVEL.
"""

import enum


class Symbol(enum.StrEnum):
  """A visual event (paper, Table 1), a level, or what was not understood."""

  NULL = 'NULL'
  START = 'START'
  ZERO = '0'
  ONE = '1'
  END = 'END'
  LEVEL = 'LEVEL'
  UNKNOWN = 'UNKNOWN'


MOTIONS = (Symbol.START, Symbol.ZERO, Symbol.ONE, Symbol.END)
BITS = (Symbol.ZERO, Symbol.ONE)
