"""An alphabet as cameras see it from many sides, ready to be compared."""

import dataclasses
import functools

import numpy as np

from waggle_tasks.protocol import alphabets, levels, sights

_POINTS = 65  # Of a path.


@dataclasses.dataclass(frozen=True, eq=False)
class Shapes:
  """Paths in the picture, in metres at the distance of the dancer.

  Attributes:
    alphabet: What they are of.
    angles_rad: (V,) viewing angles, see `views.View`.
    start: (V, P, 2) START, right and down.
    strokes: (V, S, M, P, 2) by state and symbol.
    ends: (V, S, P, 2) END by state.
    after: (M,) the state after each symbol.
  """

  alphabet: levels.Levels | alphabets.Gestures
  angles_rad: np.ndarray
  start: np.ndarray
  strokes: np.ndarray
  ends: np.ndarray
  after: np.ndarray

  @property
  def start_s(self) -> float:
    """From the begin of START to that of the first stroke."""
    return self.alphabet.start.duration_s + self.alphabet.rest_s

  @property
  def slot_s(self) -> float:
    """From the begin of one stroke to that of the next."""
    return self.alphabet.slot_s

  @property
  def stroke_s(self) -> float:
    """How long a stroke takes."""
    return self.alphabet.slot_s - self.alphabet.rest_s

  @property
  def end_s(self) -> float:
    """How long END takes."""
    return self.alphabet.end(0).duration_s


def seen(
  alphabet: levels.Levels | alphabets.Gestures,
  angles_rad: np.ndarray,
  distance_m: float,
) -> Shapes:
  """The shapes of an alphabet.

  Args:
    alphabet: The alphabet.
    angles_rad: (V,) from where it may be seen; an alphabet that goes up and
      down alone looks the same from everywhere, and has one.
    distance_m: How far away the camera is: what comes nearer grows.
  """
  start, strokes, ends = _sampled(alphabet)
  if not any(np.any(each[..., ::2]) for each in (start, strokes, ends)):
    angles_rad = np.zeros(1)
  after = np.array([alphabet.after(k) for k in range(alphabet.size)])
  start, strokes, ends = (
    sights.project(each, angles_rad, distance_m)
    for each in (start, strokes, ends)
  )
  return Shapes(alphabet, angles_rad, start, strokes, ends, after)


@functools.cache
def _sampled(
  alphabet: levels.Levels | alphabets.Gestures,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
  """START (P, 3), strokes (S, M, P, 3) and ENDs (S, P, 3) as they are flown."""
  states, size = range(alphabet.states), range(alphabet.size)
  start = alphabets.sample(alphabet.start, _POINTS)
  strokes = np.array(
    [
      [alphabets.sample(alphabet.stroke(i, k), _POINTS) for k in size]
      for i in states
    ]
  )
  ends = np.array([alphabets.sample(alphabet.end(i), _POINTS) for i in states])
  return start, strokes, ends


def at(paths: np.ndarray, shares: np.ndarray) -> np.ndarray:
  """Points of paths (..., P, 2) at shares (T,) of their time: (..., T, 2).

  Before its begin a path rests there, after its end there.
  """
  last = paths.shape[-2] - 1
  places = np.clip(shares, 0.0, 1.0) * last
  low = np.minimum(places.astype(int), last - 1)
  part = (places - low)[:, None]
  return paths[..., low, :] * (1 - part) + paths[..., low + 1, :] * part
