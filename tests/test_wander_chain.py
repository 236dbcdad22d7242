"""Beliefs of a dancer that wanders, against a solver that knows no filter."""

import numpy as np

from waggle_tasks.agents import wander_chain

SLOTS = 5
BEFORE = np.array([0.05, 0.05, 0.05, 0.05])
CHANGE = np.array([0.006, 0.006, 0.01, 1e-4])


def seen(rng: np.random.Generator) -> wander_chain.Evidence:
  """What a stroke tells that is flown near a random pose."""
  times = np.linspace(0, 1, 12)
  path_m = np.stack([0 * times, 0.1 * times**2], axis=1)
  rate_mps = np.stack([0 * times, 0.2 * times], axis=1)
  places_m = path_m + rng.normal(0, 0.01, 2) + rng.normal(0, 0.002, (12, 2))
  weights_s = rng.uniform(0, 0.08, 12)
  return wander_chain.Evidence.of(places_m, weights_s, path_m, rate_mps)


def drawn() -> tuple[list[wander_chain.Evidence], np.ndarray]:
  rng = np.random.default_rng(3)
  steps = rng.normal(0, 0.004, (SLOTS - 1, 4)) * (1, 1, 1, 0)
  return [seen(rng) for _ in range(SLOTS)], steps


def solved(
  found: list[wander_chain.Evidence], steps: np.ndarray
) -> tuple[np.ndarray, float]:
  """Poses and cost by least squares over all of them at once."""
  rows, aims, cost = [], [], 0.0
  for slot, each in enumerate(found):
    root = np.linalg.cholesky(each.square + 1e-12 * np.eye(4)).T
    row = np.zeros((4, SLOTS, 4))
    row[:, slot] = root
    aim = np.linalg.solve(root.T, each.linear)
    rows.append(row)
    aims.append(aim)
    cost += float(each.rest - aim @ aim)
  first = np.zeros((4, SLOTS, 4))
  first[:, 0] = np.diag(1 / BEFORE)
  rows.append(first)
  aims.append(np.zeros(4))
  for slot, step in enumerate(steps):
    row = np.zeros((4, SLOTS, 4))
    row[:, slot + 1], row[:, slot] = np.diag(1 / CHANGE), -np.diag(1 / CHANGE)
    rows.append(row)
    aims.append(-step / CHANGE)
  matrix = np.concatenate(rows).reshape(-1, SLOTS * 4)
  aim = np.concatenate(aims)
  best, *_ = np.linalg.lstsq(matrix, aim, rcond=None)
  left = float(((matrix @ best - aim) ** 2).sum())
  return best.reshape(SLOTS, 4), cost + left


def test_a_filter_and_least_squares_tell_the_same() -> None:
  found, steps = drawn()
  poses, cost = solved(found, steps)
  beliefs = wander_chain.Beliefs.before(()).seen(found[0])
  for each, step in zip(found[1:], steps, strict=True):
    beliefs = beliefs.moved(step).seen(each)
  np.testing.assert_allclose(beliefs.mean, poses[-1], atol=1e-6)
  stacked = wander_chain.Evidence(
    np.array([each.square for each in found]),
    np.array([each.linear for each in found]),
    np.array([each.rest for each in found]),
  )
  smoothed = wander_chain.smooth(stacked, steps)
  np.testing.assert_allclose(smoothed, poses, atol=1e-6)
  np.testing.assert_allclose(beliefs.cost, cost, rtol=1e-6)


def test_many_words_cost_what_each_of_them_does() -> None:
  found, _ = drawn()
  both = wander_chain.Evidence(
    np.stack([found[0].square, found[1].square]),
    np.stack([found[0].linear, found[1].linear]),
    np.stack([found[0].rest, found[1].rest]),
  )
  together = wander_chain.Beliefs.before((2,)).seen(both)
  for number in (0, 1):
    alone = wander_chain.Beliefs.before(()).seen(found[number])
    np.testing.assert_allclose(together.mean[number], alone.mean)
    np.testing.assert_allclose(together.cost[number], alone.cost)


def test_what_was_not_seen_tells_nothing() -> None:
  nothing = wander_chain.Evidence(np.zeros((4, 4)), np.zeros(4), np.zeros(()))
  before = wander_chain.Beliefs.before(())
  after = before.seen(nothing)
  np.testing.assert_allclose(after.mean, before.mean)
  np.testing.assert_allclose(after.covariance, before.covariance)
  assert float(after.cost) == 0.0
