"""How vehicles with rotors flew: tilt, thrusts, air and estimate."""

from collections.abc import Mapping
import dataclasses
import pathlib
from typing import Any
import zipfile

import numpy as np

from waggle_tasks import errors

NAME = 'flights.npz'  # In a run folder.


class FlownError(errors.WaggleError):
  """A file of flights that cannot be read."""


@dataclasses.dataclass(frozen=True, eq=False)
class Flown:
  """How one vehicle flew, in T frames.

  Attributes:
    tilt_rad: (T,) how far it was from level.
    thrusts_n: (T, 4) thrusts of its rotors.
    air_mps: (T, 3) world velocity of the air where it was.
    error_m: (T, 3) how far from itself it took itself to be.
    told_m: (T, 3) where it was told to be, before its drift.
  """

  tilt_rad: np.ndarray
  thrusts_n: np.ndarray
  air_mps: np.ndarray
  error_m: np.ndarray
  told_m: np.ndarray


def save(path: pathlib.Path, flights: Mapping[str, Flown]) -> None:
  """Writes flights by vehicle name; equal flights give equal bytes."""
  arrays: dict[str, Any] = {
    f'{name}.{field.name}': getattr(flown, field.name)
    for name, flown in flights.items()
    for field in dataclasses.fields(Flown)
  }
  np.savez_compressed(path, **arrays)


def load(path: pathlib.Path) -> dict[str, Flown]:
  """Reads what `save` wrote; nothing where there is no file.

  Raises:
    FlownError: if the file is damaged or something else.
  """
  if not path.exists():
    return {}
  try:
    with path.open('rb') as file, np.load(file, allow_pickle=False) as opened:
      arrays = dict(opened)
    names = dict.fromkeys(key.rpartition('.')[0] for key in arrays)
    fields = [field.name for field in dataclasses.fields(Flown)]
    return {
      name: Flown(*(arrays[f'{name}.{field}'] for field in fields))
      for name in names
    }
  except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
    raise FlownError(f'{path} must be a file of flights: {error}') from None
