"""Coloured noise: smooth random signals as tables over time.

Each has mean zero and variance one at all times, and forgets at a rate. Tables
are drawn when an episode begins, so that a signal is known at any time.
"""

import itertools
import math

import numpy as np

STEP_S = 0.02  # As often as it is asked for.


def rows(duration_s: float) -> int:
  """How many rows a table of an episode has."""
  return math.ceil(duration_s / STEP_S) + 2


def at(table: np.ndarray, time_s: float) -> np.ndarray:
  """The row of a table (T, ...) for a time."""
  return table[min(max(round(time_s / STEP_S), 0), len(table) - 1)]


def first_order(
  rate_s: float, count: int, size: int, random_state: np.random.RandomState
) -> np.ndarray:
  """Gauss-Markov signals: white noise behind 1 / (s + rate).

  Args:
    rate_s: How fast they forget, in 1/s.
    count: How many rows.
    size: How many signals.
    random_state: What they are drawn from.

  Returns:
    (count, size).
  """
  kept = math.exp(-rate_s * STEP_S)
  drawn = random_state.standard_normal((count, size))
  drawn[1:] *= math.sqrt(1 - kept**2)
  for before, now in itertools.pairwise(drawn):
    now += kept * before
  return drawn


def second_order(
  rate_s: float, count: int, size: int, random_state: np.random.RandomState
) -> tuple[np.ndarray, np.ndarray]:
  """The same behind 1 / (s + rate)^2, with their slopes.

  Args:
    rate_s: How fast they forget, in 1/s; also the rms of their slopes.
    count: How many rows.
    size: How many signals.
    random_state: What they are drawn from.

  Returns:
    The signals and their slopes in 1/s, (count, size) each.
  """
  turn = rate_s * STEP_S
  step = math.exp(-turn) * np.array([[1 + turn, turn], [-turn, 1 - turn]])
  # In units of the rate, values and slopes have variance one and are apart.
  root = np.linalg.cholesky(np.eye(2) - step @ step.T)
  drawn = random_state.standard_normal((count, 2, size))
  drawn[1:] = root @ drawn[1:]
  for before, now in itertools.pairwise(drawn):
    now += step @ before
  return drawn[:, 0], rate_s * drawn[:, 1]
