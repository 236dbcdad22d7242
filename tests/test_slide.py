"""Slow ways to and fro are as slow and as near as they say."""

import math

import numpy as np
import pytest

from waggle_tasks import errors
from waggle_tasks.tasks import drift, slide


def test_a_slow_way_is_as_fast_as_it_says_and_comes_back() -> None:
  way = slide.Slide(0.02, math.radians(1), np.random.RandomState(0))
  times_s = np.arange(4.0, 44.0, 0.02)
  place, rate, _ = np.array([way.at(each) for each in times_s]).swapaxes(0, 1)
  assert np.linalg.norm(rate[:, :3], axis=1).max() == pytest.approx(
    0.02, rel=1e-4
  )
  assert np.abs(rate[:, 3]).max() == pytest.approx(math.radians(1), rel=1e-4)
  # From one end to the other it is one straight line.
  far = np.ptp(place[:, :3], axis=0)
  assert np.linalg.norm(far) == pytest.approx(2 * slide.reach(0.02), rel=1e-3)
  assert np.linalg.matrix_rank(place[:, :3], tol=1e-9) == 1
  np.testing.assert_allclose(place[:1000], place[1000:], atol=1e-9)


def test_a_slow_way_begins_at_rest_and_its_rates_are_its_own() -> None:
  way = slide.Slide(0.02, 0.01, np.random.RandomState(3))
  np.testing.assert_array_equal(way.at(0.0)[:2], 0)
  times_s = np.linspace(0, 5, 2001)
  place, rate, more = np.array([way.at(t) for t in times_s]).swapaxes(0, 1)
  slope = np.gradient(place, times_s, axis=0)
  np.testing.assert_allclose(slope[5:-5], rate[5:-5], atol=1e-5)
  slope = np.gradient(rate, times_s, axis=0)
  np.testing.assert_allclose(slope[5:-5], more[5:-5], atol=2e-4)


def test_observers_alone_go_slow_ways_each_its_own() -> None:
  chosen = drift.Drift(observer_slide_mps=0.02, observer_turn_dps=1.0)
  random_state = np.random.RandomState(0)
  ways = [chosen.observer(random_state).at(7.0)[0] for _ in range(2)]
  assert np.abs(ways[0] - ways[1]).max() > 1e-3
  assert not np.any(chosen.performer(random_state).at(7.0))
  still = drift.Drift()
  drawn = np.random.RandomState(0)
  assert still.observer(drawn).way is None
  assert drawn.uniform() == np.random.RandomState(0).uniform()


def test_vehicles_keep_clear_of_each_other_s_slow_ways() -> None:
  near_m = drift.Drift(observer_slide_mps=0.02).near_m
  assert near_m == pytest.approx(4 * slide.reach(0.02))
  with pytest.raises(errors.WaggleError, match='`observer_slide_mps` must be'):
    drift.Drift(observer_slide_mps=0.03)
