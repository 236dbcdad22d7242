"""When the pictures of a folder were taken, as a file beside them says."""

import csv
import math
import pathlib

from waggle_tasks.experiments.video import sources

NAME = 'times.csv'
_HEADER = 'picture', 'time_s'


def read(folder: pathlib.Path) -> dict[str, float] | None:
  """Times in seconds by the names of pictures; None without such a file.

  Each line is a picture's name and its time; the first may be the names of
  these columns, `picture,time_s`.

  Raises:
    RecordingError: naming the line that says no such thing.
  """
  path = folder / NAME
  if not path.is_file():
    return None
  times_s: dict[str, float] = {}
  try:
    with path.open(encoding='utf-8-sig', newline='') as file:
      rows = [
        ([cell.strip() for cell in cells], number)
        for number, cells in enumerate(csv.reader(file, strict=True), 1)
        if any(map(str.strip, cells))
      ]
  except (OSError, ValueError, csv.Error) as error:
    raise sources.RecordingError(f'{path} cannot be read: {error}') from None
  for cells, number in rows:
    if number == 1 and tuple(cells) == _HEADER:
      continue
    where = f'{path}, line {number}:'
    if len(cells) != 2 or not _is_time(cells[1]):
      raise sources.RecordingError(
        f'{where} there must be the name of a picture and its time in s, with a'
        f' comma between them: got {",".join(cells)!r}'
      )
    if cells[0] in times_s:
      raise sources.RecordingError(f'{where} {cells[0]} has a time already')
    times_s[cells[0]] = float(cells[1])
  return times_s


def _is_time(text: str) -> bool:
  try:
    return math.isfinite(float(text))
  except ValueError:
    return False
