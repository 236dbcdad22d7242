"""Intervals and tests for suites of broadcasts.

The broadcast is the experimental unit: its observers share a performer and a
scene (paper, section 'Controls and supplemental suite').
"""

from collections.abc import Sequence
import functools

import numpy as np
from scipy import special

LEVEL = 0.95
_RESAMPLES = 10_000


@functools.cache  # Large maps ask for the same few again and again.
def clopper_pearson(successes: int, trials: int) -> tuple[float, float]:
  """The exact 95 % interval of a proportion (Clopper and Pearson 1934).

  Args:
    successes: At most `trials`.
    trials: At least 1.
  """
  tail = (1 - LEVEL) / 2
  low = 1 - _limit(trials - successes, trials, tail)
  return low, _limit(successes, trials, tail)


@functools.cache
def upper_limit(events: int, trials: int) -> float:
  """The exact one-sided 95 % upper limit of a proportion.

  It is Clopper and Pearson's; for no event 1 - 0.05^(1/trials), about three
  in `trials`.

  Args:
    events: At most `trials`.
    trials: At least 1.
  """
  return _limit(events, trials, 1 - LEVEL)


def _limit(events: int, trials: int, tail: float) -> float:
  """The proportion of which so few events have the probability `tail`."""
  if events == trials:
    return 1.0
  return float(special.bdtri(events, trials, tail))


def bootstrap_by_broadcast(
  correct: Sequence[int], exposures: Sequence[int]
) -> tuple[float, float]:
  """A 95 % percentile interval of the share of receivers that were correct.

  Whole broadcasts are drawn with replacement, 10,000 times from a fixed seed,
  so that receivers of one broadcast stay together (Efron and Tibshirani 1993,
  chapter 13).

  Args:
    correct: For each broadcast, how many receivers were correct.
    exposures: For each broadcast, how many there were.
  """
  draw = np.random.RandomState(0).randint(
    len(correct), size=(_RESAMPLES, len(correct))
  )
  shares = np.sum(np.asarray(correct)[draw], axis=1) / np.sum(
    np.asarray(exposures)[draw], axis=1
  )
  low, high = np.quantile(shares, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
  return float(low), float(high)


def mcnemar(only_a: int, only_b: int) -> float:
  """The exact two-sided p value of paired outcomes (McNemar 1947).

  Args:
    only_a: Pairs in which only the first succeeded.
    only_b: Pairs in which only the second did.
  """
  if only_a + only_b == 0:
    return 1.0
  tail = special.bdtr(min(only_a, only_b), only_a + only_b, 0.5)
  return min(1.0, 2 * float(tail))
