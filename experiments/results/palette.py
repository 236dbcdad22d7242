"""Colours that colour-blind readers can tell apart, the same everywhere.

The eight of Okabe and Ito, 'Color Universal Design' (2008),
jfly.uni-koeln.de/color. No colour stands alone: whatever wears one also has a
shape or a word.
"""

from waggle_tasks.protocol.symbols import Symbol

BLACK = '#000000'
ORANGE = '#e69f00'
SKY = '#56b4e9'
GREEN = '#009e73'
YELLOW = '#f0e442'
BLUE = '#0072b2'
VERMILLION = '#d55e00'
PURPLE = '#cc79a7'
GREY = '#8a929c'
WHITE = '#ffffff'

SYMBOLS = {
  Symbol.NULL: GREY,
  Symbol.START: BLUE,
  Symbol.ZERO: GREEN,
  Symbol.ONE: ORANGE,
  Symbol.END: PURPLE,
  Symbol.LEVEL: GREEN,
  Symbol.UNKNOWN: VERMILLION,
}
# Brightness above which black letters read better than white ones.
_BRIGHT = 140.0


def ink(fill: str) -> str:
  """Black or white, whichever reads better on a fill."""
  red, green, blue = rgb(fill)
  # Weights of ITU-R BT.709.
  bright = 0.2126 * red + 0.7152 * green + 0.0722 * blue
  return BLACK if bright > _BRIGHT else WHITE


def rgb(colour: str) -> tuple[int, int, int]:
  """Red, green and blue, 0 to 255, of a colour such as '#0072b2'."""
  red, green, blue = bytes.fromhex(colour[1:])
  return red, green, blue
