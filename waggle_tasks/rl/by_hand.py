"""A language and a listener that nobody had to learn, for `Dance`.

The language is that of levels: up, down, and then a level for each digit. The
listener compares a track with every dance there is, at any time and size, by
least squares.
"""

import math

import numpy as np

from waggle_tasks.rl import needs, signals

_START = 1.0, -1.0
# What is compared: no tracker's error, nothing lost, from one place.
_CLEAN = {'error_m': 0.0, 'lost_share': 0.0}


def heights(payloads: int, strokes: int) -> np.ndarray:
  """What is danced for each payload, (payloads, strokes) from -1 to 1.

  Raises:
    LearningError: if there are too few strokes for START and a digit.
  """
  digits = strokes - len(_START)
  if digits < 1:
    raise needs.LearningError(
      f'`strokes` must be {len(_START) + 1} at least, for START and a level:'
      f' got {strokes}'
    )
  base = math.ceil(payloads ** (1 / digits) - 1e-9)
  powers = base ** np.arange(digits)[::-1]
  numbers = np.arange(payloads)[:, None] // powers % base
  levels = numbers / (base - 1) * 2 - 1 if base > 1 else 0.0 * numbers
  return np.hstack([np.tile(_START, (payloads, 1)), levels])


def read(
  tracks: np.ndarray,  # (B, frames, 2)
  told: np.ndarray,  # (payloads, strokes)
  channel: signals.Channel,
) -> np.ndarray:
  """Which payload each track fits best, (B,)."""
  clean = signals.Channel(channel.strokes, **_CLEAN)
  whole = clean.paths(told, np.zeros(len(told)))  # (payloads, frames)
  seen, places = tracks[:, :, 1], tracks[:, :, 0] * tracks[:, :, 1]
  best = np.full((len(tracks), len(told)), -np.inf)
  for late in range(round(signals.MOST_WAIT_S * signals.RATE_HZ) + 1):
    moved = np.zeros_like(whole)
    moved[:, late:] = whole[:, : whole.shape[1] - late]
    alike = np.maximum(places @ moved.T, 0.0)
    energy = seen @ (moved**2).T
    best = np.maximum(best, alike**2 / np.maximum(energy, 1e-12))
  return best.argmax(1)


def understood(
  payloads: int, channel: signals.Channel, seed: int = 0, rounds: int = 64
) -> float:
  """The share of payloads that is understood so."""
  rng = np.random.default_rng(seed)
  told = heights(payloads, channel.strokes)
  meant = np.tile(np.arange(payloads), rounds)
  found = read(channel.tracks(told[meant], rng), told, channel)
  return float((found == meant).mean())
