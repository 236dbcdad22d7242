"""What an alphabet looks like from many sides, and how far apart it looks."""

import dataclasses
import functools
import itertools

import numpy as np

from waggle_tasks.protocol import alphabets, levels, schedule
from waggle_tasks.protocol.symbols import BITS, Symbol

# The widest angles from which a receiver may read, and their distance: the
# default observers'.
WIDEST_DEG = 85
DISTANCE_M = 1.3
_STEP_DEG = 5
_MOMENTS = 16  # Of a path.
_SAME_M = 1e-6
REST = 'rest'

Alphabet = levels.Levels | alphabets.Gestures


@dataclasses.dataclass(frozen=True)
class Separation:
  """The two symbols of an alphabet that look most alike.

  Attributes:
    distance_m: How far apart their strokes are in the picture, at the distance
      of the dancer: root mean square over the time that they take.
    symbols: Which two.
    angle_deg: The viewing angle at which they do, positive where the observer
      stands to the right; None if all are as far apart from everywhere.
  """

  distance_m: float
  symbols: tuple[str, str]
  angle_deg: float | None


def project(
  offsets_m: np.ndarray,  # (..., P, 3)
  angles_rad: np.ndarray,  # (V,)
  distance_m: float,
) -> np.ndarray:  # (V, ..., P, 2)
  """Paths in the picture: right and down, in m at the distance of the dancer.

  By the pinhole model, with a camera at the height of the hover point.

  Args:
    offsets_m: Right, up and away, from the hover point.
    angles_rad: From where they are seen.
    distance_m: How far away the camera is: what comes nearer grows.
  """
  angles = angles_rad.reshape(-1, *[1] * (offsets_m.ndim - 1))
  right, up, away = np.moveaxis(offsets_m, -1, 0)
  nearer_m = right * np.sin(angles) - away * np.cos(angles)
  across_m = right * np.cos(angles) + away * np.sin(angles)
  grown = distance_m / np.maximum(distance_m - nearer_m, 0.1 * distance_m)
  down_m = np.broadcast_to(-up, across_m.shape)
  return np.stack([across_m, down_m], axis=-1) * grown[..., None]


@functools.cache
def nearest(alphabet: Alphabet, widest_deg: int = WIDEST_DEG) -> Separation:
  """The two symbols that look most alike from any of many views.

  Strokes are compared that begin at one place. Where all begin at the hover
  point, so are END, a rest, and START: START tells a receiver the scale, so
  that what looks like a smaller one is as near as what looks like itself.
  Where strokes begin at many places, a rest is one of them, and END of some
  hardly moves: receivers count symbols, and know when it comes.

  Args:
    alphabet: The alphabet.
    widest_deg: The widest viewing angle to either side.
  """
  steps = range(_STEP_DEG, widest_deg + 1, _STEP_DEG)
  # Equal ones are told by the view that is nearest to the front.
  angles_deg = np.array([0, *(s * step for step in steps for s in (1, -1))])
  angles_rad = np.radians(angles_deg)
  found: dict[tuple[str, str], np.ndarray] = {}
  for state in range(alphabet.states):
    for pair, distances_m in _among(alphabet, state, angles_rad):
      found[pair] = np.minimum(found.get(pair, np.inf), distances_m)
  table = np.array([*found.values()])  # (pairs, V)
  views = table.min(axis=0)
  view = int(np.argmax(views <= views.min() + _SAME_M))
  first = int(np.argmax(table[:, view] <= views[view] + _SAME_M))
  alike = np.ptp(views) <= _SAME_M
  return Separation(
    float(views[view]), [*found][first],
    None if alike else float(angles_deg[view]),
  )  # fmt: skip


def _among(
  alphabet: Alphabet, state: int, angles_rad: np.ndarray
) -> list[tuple[tuple[str, str], np.ndarray]]:
  """How far apart every two strokes from one place are, in each view."""
  strokes: dict[str, schedule.Path] = {
    name_of(alphabet, symbol): alphabet.stroke(state, symbol)
    for symbol in range(alphabet.size)
  }
  at_home = alphabet.states == 1
  if at_home:
    strokes[Symbol.END.value] = alphabet.end(state)
  times_s = _times(max(path.duration_s for path in strokes.values()))
  seen = _seen(strokes, times_s, angles_rad)
  if at_home:
    seen[REST] = np.zeros_like(seen[Symbol.END.value])
  out = [
    (pair, _rms(seen[pair[0]] - seen[pair[1]]))
    for pair in itertools.combinations(seen, 2)
  ]
  if at_home:
    begun = {Symbol.START.value: alphabet.start, **strokes}
    shown = _seen(begun, _times(alphabet.start.duration_s), angles_rad)
    start = shown.pop(Symbol.START.value)
    out += [
      ((Symbol.START.value, name), _rms(start - _fitted(path, start)))
      for name, path in shown.items()
    ]
  return out


def name_of(alphabet: Alphabet, symbol: int) -> str:
  """What a symbol is called: its bit, or the number of its level."""
  is_bit = isinstance(alphabet, alphabets.Gestures)
  return BITS[symbol].value if is_bit else str(symbol)


def _times(length_s: float) -> np.ndarray:
  """The middles of equal parts of a time: their mean is that of all of it."""
  return (np.arange(_MOMENTS) + 0.5) * length_s / _MOMENTS


def _seen(
  paths: dict[str, schedule.Path], times_s: np.ndarray, angles_rad: np.ndarray
) -> dict[str, np.ndarray]:
  """Each path in the picture, (V, P, 2)."""
  return {
    name: project(alphabets.places(path, times_s), angles_rad, DISTANCE_M)
    for name, path in paths.items()
  }


def _fitted(
  paths: np.ndarray,  # (V, P, 2)
  wanted: np.ndarray,  # (V, P, 2)
) -> np.ndarray:
  """The paths at the size at which they are nearest to what is wanted."""
  power = np.maximum((paths**2).sum(axis=(1, 2)), 1e-12)
  along = (paths * wanted).sum(axis=(1, 2))
  return paths * np.maximum(along / power, 0.0)[:, None, None]


def _rms(apart_m: np.ndarray) -> np.ndarray:
  """Of differences (V, P, 2): (V,)."""
  return np.sqrt((apart_m**2).sum(axis=-1).mean(axis=-1))
