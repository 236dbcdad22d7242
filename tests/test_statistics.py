"""Intervals and tests, against values worked out by hand or printed."""

from collections.abc import Sequence

import numpy as np
import pytest

from waggle_tasks.experiments.results import intervals

# Of the paper's Table 2: correct messages and receivers of each broadcast.
CORRECT = (3, 3, 3, 3, 1, 2, 4, 3, 3, 0, 3, 3, 1, 3, 3, 3, 3)
EXPOSURES = (3, 3, 3, 3, 1, 2, 4, 5, 3, 3, 3, 3, 3, 3, 3, 3, 5)


@pytest.mark.parametrize(
  ('successes', 'trials', 'low', 'high'),
  [
    (13, 17, 0.5010, 0.9319),
    (5, 10, 0.1871, 0.8129),
    (1, 2, 0.0126, 0.9874),
    (44, 53, 0.7020, 0.9193),
    # No success, or no failure, leaves (1 - high)^n = 0.025.
    (0, 1, 0.0, 0.975),
    (0, 3, 0.0, 1 - 0.025 ** (1 / 3)),
    (3, 3, 0.025 ** (1 / 3), 1.0),
    (14, 14, 0.025 ** (1 / 14), 1.0),
  ],
)
def test_the_exact_interval_of_a_proportion(
  successes: int, trials: int, low: float, high: float
) -> None:
  interval = intervals.clopper_pearson(successes, trials)
  assert interval == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize('successes', range(8))
def test_failures_and_successes_are_treated_alike(successes: int) -> None:
  low, high = intervals.clopper_pearson(successes, 7)
  other = intervals.clopper_pearson(7 - successes, 7)
  assert (1 - high, 1 - low) == pytest.approx(other, abs=1e-9)
  assert low <= successes / 7 <= high


# Clopper and Pearson (1934), one-sided; for no event 1 - 0.05^(1/n), and the
# others solve P(X <= events) = 0.05.
@pytest.mark.parametrize(
  ('events', 'trials', 'limit'),
  [
    (0, 1, 0.95),
    (0, 60, 1 - 0.05 ** (1 / 60)),
    (0, 3000, 1 - 0.05 ** (1 / 3000)),
    (1, 10, 0.39416),
    (5, 10, 0.77756),
    (10, 10, 1.0),
  ],
)
def test_the_one_sided_upper_limit_of_a_proportion(
  events: int, trials: int, limit: float
) -> None:
  assert intervals.upper_limit(events, trials) == pytest.approx(limit, abs=1e-5)


def test_the_bootstrap_repeats_bit_for_bit() -> None:
  first = intervals.bootstrap_by_broadcast(CORRECT, EXPOSURES)
  np.random.random_sample()  # Its draws are its own, whatever others drew.
  assert intervals.bootstrap_by_broadcast(CORRECT, EXPOSURES) == first
  low, high = first
  assert low < 44 / 53 < high


def test_the_bootstrap_draws_whole_broadcasts() -> None:
  # Two broadcasts of 50: all of one are right, none of the other. Whole, they
  # give 0, 1/2 or 1, so the interval is everything; receiver by receiver the
  # share of 100 would stay within 0.4 to 0.6.
  assert intervals.bootstrap_by_broadcast([50, 0], [50, 50]) == (0.0, 1.0)


def test_the_bootstrap_weighs_a_broadcast_by_its_receivers() -> None:
  # The mean of the broadcasts' shares would be 1/2, and high above it.
  correct, exposures = [1] * 10 + [0] * 10, [1] * 10 + [9] * 10
  low, high = intervals.bootstrap_by_broadcast(correct, exposures)
  assert low < 0.1 < high < 0.35


@pytest.mark.parametrize(
  ('correct', 'share'), [([3, 1, 2], 1.0), ([0, 0, 0], 0.0)]
)
def test_the_bootstrap_of_equal_broadcasts_has_no_width(
  correct: Sequence[int], share: float
) -> None:
  interval = intervals.bootstrap_by_broadcast(correct, [3, 1, 2])
  assert interval == (share, share)


def test_the_bootstrap_matches_the_exact_binomial_for_single_receivers() -> (
  None
):
  # 100 broadcasts of one receiver: shares are binomial(100, 0.5) / 100, whose
  # 2.5 % and 97.5 % quantiles are 0.40 and 0.60.
  correct = [0, 1] * 50
  interval = intervals.bootstrap_by_broadcast(correct, [1] * 100)
  assert interval == pytest.approx((0.4, 0.6), abs=0.011)


@pytest.mark.parametrize(
  ('only_a', 'only_b', 'p'),
  [
    (0, 0, 1.0),
    (1, 0, 1.0),
    (3, 3, 1.0),
    (5, 0, 2 / 2**5),
    (6, 1, 2 * (1 + 7) / 2**7),
    (10, 2, 2 * (1 + 12 + 66) / 2**12),
  ],
)
def test_the_exact_p_value_of_pairs(only_a: int, only_b: int, p: float) -> None:
  assert intervals.mcnemar(only_a, only_b) == pytest.approx(p)
  assert intervals.mcnemar(only_b, only_a) == pytest.approx(p)
