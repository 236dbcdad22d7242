"""The alphabet: four motions, one stillness, and what was not understood."""

import enum


class Symbol(enum.StrEnum):
  """A visual event (paper, Table 1), or UNKNOWN for a rejected motion."""

  NULL = 'NULL'
  START = 'START'
  ZERO = '0'
  ONE = '1'
  END = 'END'
  UNKNOWN = 'UNKNOWN'


MOTIONS = (Symbol.START, Symbol.ZERO, Symbol.ONE, Symbol.END)
BITS = (Symbol.ZERO, Symbol.ONE)
