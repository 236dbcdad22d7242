"""Tracks of somebody else's tracker, as CSV: when the target was where.

The first line names the columns, in any order, each with its unit: `time_s`
(or `time_ms`, `time_us`), `x_px` to the right, `y_px` down or `up_px`, and, who
knows it, `width_px`, how wide the target is. Lengths are all in `px`, or all in
`m` or `mm` across the line of sight. Other columns are left out; so are empty
lines and those that begin with #. Without names the columns are `time_s`,
`x_px` and `y_px`. A line without a place is a moment in which the target was
not seen.
"""

from collections.abc import Iterator, Sequence
import csv
import dataclasses
import math
import pathlib
from typing import Any

import numpy as np

from waggle_tasks.agents import tracks
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.video import recording_part, recordings, sources

SUFFIX = '.csv'
# Metres become the pixels that they are at the paper's distance; receivers find
# out how far away a dancer is by themselves.
DISTANCE_M = 1.3
_TIMES = {'time': 1.0, 'time_s': 1.0, 'time_ms': 1e-3, 'time_us': 1e-6}
_METRES = {'m': 1.0, 'mm': 1e-3}
_USUAL = 'time_s', 'x_px', 'y_px'
_MOST_PX = 1e6
_MOST_ROWS = 4_000_000


class TrackError(sources.RecordingError):
  """A file that is no track; it names the line and what is wrong with it."""


@dataclasses.dataclass(frozen=True)
class _Columns:
  """Which column is what, by its number, and its size in s or px.

  Attributes:
    time: The time.
    x: Right.
    y: Down; up where the size is negative.
    width: How wide the target is; None where no column says it.
  """

  time: tuple[int, float]
  x: tuple[int, float]
  y: tuple[int, float]
  width: tuple[int, float] | None


class TrackFile:
  """A track that was read to its end.

  Attributes:
    count: How many lines there were.
    length_s: From the first to the last.
    seen: In what share of them the target was seen.
  """

  def __init__(self, path: pathlib.Path, focal_px: float) -> None:
    """Reads a file.

    Args:
      path: The file.
      focal_px: Focal length of the camera, which tells what a metre is.

    Raises:
      TrackError: naming the line that is none of a track.
    """
    files.check_text(str(path.absolute()), TrackError)
    self._path, self._focal_px = path, focal_px
    rows = []
    try:
      with path.open(encoding='utf-8-sig', newline='') as file:
        for row in self._rows(csv.reader(file, strict=True)):
          rows.append(row)
          if len(rows) > _MOST_ROWS:
            raise TrackError(f'{path} must have at most {_MOST_ROWS} places')
    except csv.Error as error:
      raise TrackError(f'{path} is no CSV: {error}') from None
    except UnicodeDecodeError as error:
      raise TrackError(f'{path} is no text: {error}') from None
    except OSError as error:
      raise TrackError(f'{path} cannot be read: {error.strerror}') from None
    if len(rows) < 2:
      raise TrackError(f'{path} must have at least 2 places: got {len(rows)}')
    self._table = np.array(rows)  # Time, x, y and width.
    self._table[:, 0] -= self._table[0, 0]
    self.count, self.length_s = len(rows), float(self._table[-1, 0])
    self.seen = float(np.isfinite(self._table[:, 1]).mean())

  def places(
    self, part: recording_part.RecordingPart
  ) -> Iterator[tuple[np.ndarray, float]]:
    """Reads a part.

    Yields:
      Each place as `tracks.place` makes it, and its time in seconds of the
      dance; those too near to the one before are left out.

    Raises:
      RecordingError: if the part lies outside of the track, or is too long.
    """
    begin_s, end_s = part.start_s, part.end_s
    end_s = self.length_s if end_s is None else min(end_s, self.length_s)
    if begin_s > self.length_s:
      raise recordings.RecordingError(
        f'`start` must lie in the track, {self.length_s:.2f} s long: got'
        f' {begin_s:g}'
      )
    recordings.check_length(self._path, end_s - begin_s)
    last_s, near_s = -math.inf, recordings.NEAR_S / part.speed
    for time_s, *place in self._table.tolist():
      if begin_s - 1e-6 <= time_s <= end_s + 1e-6 and time_s >= last_s + near_s:
        last_s = time_s
        yield tracks.place(*place), time_s * part.speed

  def _rows(self, reader: Any) -> Iterator[list[float]]:  # noqa: ANN401
    """Times in s with places and widths in pixels, of a `csv.reader`."""
    columns, last_s = None, -math.inf
    for cells in reader:
      where = f'{self._path}, line {reader.line_num}:'
      if not any(map(str.strip, cells)) or cells[0].lstrip().startswith('#'):
        continue
      if columns is None:
        named = not _is_number(cells[0])
        columns = self._columns(cells if named else _USUAL, where)
        if named:
          continue
      row = _read(cells, columns, where)
      if row[0] <= last_s:
        raise TrackError(
          f'{where} the time must be later than {last_s:.6g} s, that of the'
          f' line before: got {row[0]:.6g} s'
        )
      last_s = row[0]
      yield row

  def _columns(self, cells: Sequence[str], where: str) -> _Columns:
    """What the columns are, by their names."""
    names = [cell.strip().lower() for cell in cells]
    scales = {'px': 1.0} | {
      unit: size * self._focal_px / DISTANCE_M for unit, size in _METRES.items()
    }

    def find(stem: str) -> tuple[int, float, str] | None:
      found = [
        (number, scale, unit)
        for number, name in enumerate(names)
        for unit, scale in scales.items()
        if name == f'{stem}_{unit}' or (unit == 'px' and name == stem)
      ]
      if len(found) > 1:
        raise TrackError(
          f'{where} only one column may say where it is:'
          f' got {" and ".join(names[each[0]] for each in found)}'
        )
      return found[0] if found else None

    times = [k for k, name in enumerate(names) if name in _TIMES]
    x, y, up, width = (find(stem) for stem in ('x', 'y', 'up', 'width'))
    down = y or up
    if len(times) != 1 or x is None or down is None or (y and up):
      raise TrackError(
        f'{where} columns must be one time ({", ".join(_TIMES)}), one x (x_px,'
        f' x_m, x_mm) and one y or up with its unit: got {", ".join(names)}'
      )
    units = {each[2] for each in (x, down, width) if each}
    if len(units) > 1:
      raise TrackError(
        f'{where} all places must be in one unit: got'
        f' {", ".join(sorted(units))}'
      )
    sign = 1 if y else -1
    return _Columns(
      (times[0], _TIMES[names[times[0]]]),
      x[:2],
      (down[0], sign * down[1]),
      width[:2] if width else None,
    )


def _read(cells: Sequence[str], columns: _Columns, where: str) -> list[float]:
  """Time, x, y and width of a line."""

  def number(what: str, column: tuple[int, float], most: float) -> float:
    place, scale = column
    text = cells[place].strip() if place < len(cells) else ''
    if not text or text.lower() == 'nan':
      return math.nan
    if not _is_number(text) or not abs(float(text)) * abs(scale) <= most:
      raise TrackError(
        f'{where} {what} must be a number, at most {most / abs(scale):g}: got'
        f' {text!r}'
      )
    return float(text) * scale

  time_s = number('the time', columns.time, 1e12)
  x_px = number('x', columns.x, _MOST_PX)
  y_px = number('y', columns.y, _MOST_PX)
  width_px = math.nan
  if columns.width:
    width_px = number('the width', columns.width, _MOST_PX)
  if math.isnan(time_s):
    raise TrackError(f'{where} there must be a time')
  if math.isnan(x_px) != math.isnan(y_px):
    raise TrackError(
      f'{where} x and y must both be there, or neither where the target was not'
      ' seen'
    )
  if width_px <= 0:
    raise TrackError(f'{where} the width must be positive: got {width_px:g}')
  return [time_s, x_px, y_px, width_px]


def _is_number(text: str) -> bool:
  try:
    float(text)
  except ValueError:
    return False
  return True
