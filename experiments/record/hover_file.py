"""Logs of hover as files: a table with a header, or numpy's arrays."""

from collections.abc import Mapping
import pathlib
from typing import Any
import zipfile
import zlib

import numpy as np

from waggle_tasks.experiments.machine import files
from waggle_tasks.tasks import hover, hover_log

POSITION, ATTITUDE = 'position_m', 'roll_pitch_yaw_deg'
# By array: its columns in a table.
COLUMNS: Mapping[str, tuple[str, ...]] = {
  'time_s': ('time_s',),
  POSITION: ('x_m', 'y_m', 'z_m'),
  ATTITUDE: ('roll_deg', 'pitch_deg', 'yaw_deg'),
}
ABOUT = (
  f'a CSV file with the columns {",".join(sum(COLUMNS.values(), ()))}, or an'
  f' .npz file with time_s (T,), {POSITION} (T, 3) and {ATTITUDE} (T, 3)'
)


def read(path: pathlib.Path) -> hover.Spectrum:
  """The hover that a log has, to be flown.

  Args:
    path: A log, see `ABOUT`; at least 20 s of a vehicle that hovers.

  Raises:
    LogError: naming the file and what is wrong with it.
  """
  files.check_text(str(path), hover_log.LogError)
  if not path.is_file():
    raise hover_log.LogError(f'`hover_log` must be {ABOUT}: {path} is no file')
  try:
    columns = _arrays(path) if path.suffix == '.npz' else _table(path)
    return hover_log.spectrum(**columns)
  except hover.HoverError as error:
    raise hover_log.LogError(f'`hover_log` {path}: {error}') from None


def _arrays(path: pathlib.Path) -> dict[str, np.ndarray]:
  try:
    with path.open('rb') as file, zipfile.ZipFile(file):
      file.seek(0)
      archive: Any = np.load(file)
      columns = {name: archive[name] for name in archive.files}
  except (OSError, ValueError, EOFError, zipfile.error, zlib.error) as error:
    raise hover_log.LogError(f'it cannot be read: {error}') from None
  _check_names([*columns], [*COLUMNS])
  return columns


def _table(path: pathlib.Path) -> dict[str, np.ndarray]:
  try:
    header, *lines = path.read_text(encoding='utf-8-sig').splitlines() or ['']
  except (OSError, ValueError) as error:  # Of bytes that are no text.
    raise hover_log.LogError(f'it cannot be read: {error}') from None
  names = [name.strip() for name in header.split(',')]
  _check_names(names, [name for each in COLUMNS.values() for name in each])
  if not any(map(str.strip, lines)):
    raise hover_log.LogError('it must have lines of numbers: got none')
  try:
    rows = np.loadtxt(lines, delimiter=',', ndmin=2)
  except ValueError as error:
    raise hover_log.LogError(f'it cannot be read: {error}') from None
  if rows.shape[1] != len(names):
    raise hover_log.LogError(
      f'each line must have {len(names)} numbers, as the first line has names:'
      f' got {rows.shape[1]}'
    )
  by_name = dict(zip(names, rows.T, strict=True))
  columns = {
    array: np.stack([by_name[name] for name in members], axis=1)
    for array, members in COLUMNS.items()
  }
  return {**columns, 'time_s': columns['time_s'][:, 0]}


def _check_names(names: list[str], wanted: list[str]) -> None:
  """Refuses columns that are missing, not known, or there twice."""
  if sorted(names) != sorted(wanted):
    missing = [name for name in wanted if name not in names]
    strange = [name for name in names if name not in wanted]
    raise hover_log.LogError(
      f'its columns must be {wanted}: {missing or "none"} missing,'
      f' {strange or "none"} not known, {len(names)} in all'
    )
