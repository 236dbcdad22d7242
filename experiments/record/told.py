"""Messages as people are told them: bits, of which many are cut, and text."""

from waggle_tasks.protocol import packets

_BITS = 16  # That are shown of many.


def short(bits: str) -> str:
  """Bits for a cell of a table, which shows the first of many."""
  return bits if len(bits) <= _BITS else f'{bits[:_BITS]}.. {len(bits)} bits'


def message(payload: str, data: str = '') -> str:
  """What is sent, in a line.

  Args:
    payload: The bits of a payload.
    data: Bits that are sent in its place; empty for none.
  """
  return in_full(short(data), data) if data else payload


def in_full(bits: str, data: str) -> str:
  """Bits with their text, if they are one that can be printed.

  Args:
    bits: What is shown of them.
    data: All of them.
  """
  text = packets.bits_text(data)
  said = '' if text is None or not text.isprintable() else f': {text!r}'
  return f'{bits}{said}'
