"""Plain text tables."""

from collections.abc import Sequence


def render(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
  """Aligns columns: the first to the left, the others to the right.

  Args:
    header: A title for each column.
    rows: As many cells each.
  """
  widths = [
    max(len(cell) for cell in column)
    for column in zip(header, *rows, strict=True)
  ]
  rule = ['-' * width for width in widths]
  return '\n'.join(
    '  '.join(
      cell.ljust(width) if index == 0 else cell.rjust(width)
      for index, (cell, width) in enumerate(zip(row, widths, strict=True))
    ).rstrip()
    for row in (header, rule, *rows)
  )


def number(value: float | None, digits: int = 2, scale: float = 1.0) -> str:
  """A number with a fixed number of digits, or a dash."""
  return '-' if value is None else f'{value * scale:.{digits}f}'
