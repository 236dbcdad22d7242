"""What published models say of very many vehicles: rates, and their limits."""

from collections.abc import Sequence
import math

import numpy as np
from scipy import integrate

from waggle_tasks.experiments.episodes import colony_swarm

_LONGEST = 1000.0  # Units of time.


def critical_stop(value: float) -> float:
  """The rate of stop signals from which two equal sites are no deadlock.

  sigma* = 4 alpha gamma rho / (rho - alpha)^2 (Seeley et al. 2012,
  doi:10.1126/science.1210361), with the rates of Pais et al. 2013, where
  gamma = rho = v and alpha = 1/v: 4 v^3 / (v^2 - 1)^2.

  Args:
    value: Of both sites, more than 1.
  """
  if value <= 1:
    raise colony_swarm.ColonyError(
      f'`value` must be more than 1 for a deadlock to be broken: got {value!r}'
    )
  return 4 * value**3 / (value**2 - 1) ** 2


def flow(
  shares: np.ndarray, values: np.ndarray, stop: float, read: float = 1.0
) -> np.ndarray:
  """By how much shares (S,) of a swarm change in a unit of time, (S,).

  Equation 1 of Pais et al. 2013, for any number of sites. Dances and stop
  signals are frames, of which a share is read.

  Args:
    shares: Of the swarm, by site.
    values: Of the sites, (S,).
    stop: Rate of the stop signal.
    read: Share of frames that is read.
  """
  free, all_ = 1 - shares.sum(), shares.sum()
  come = values * free + read * values * shares * free
  go = shares / values + read * stop * shares * (all_ - shares)
  return come - go


def course(
  values: np.ndarray,
  stop: float,
  times: Sequence[float] | np.ndarray,
  read: float = 1.0,
  begin: Sequence[float] | None = None,
) -> np.ndarray:
  """The shares of an endless swarm, (T, S), at times in units; see `flow`."""
  start = np.zeros(len(values)) if begin is None else np.array(begin, float)
  found = integrate.solve_ivp(
    lambda _, shares: flow(shares, values, stop, read),
    (0.0, float(max(times))), start, t_eval=times, rtol=1e-8, atol=1e-10,
  )  # fmt: skip
  return found.y.T


def quorum_s(swarm: colony_swarm.Swarm, read: float = 1.0) -> float:
  """When an endless swarm without noise has a quorum; infinite if never.

  Args:
    swarm: The swarm, of the model `value`.
    read: Share of frames that is read.
  """

  def reached(_: float, shares: np.ndarray) -> float:
    return float(shares.max()) - swarm.quorum

  reached.terminal = True  # type: ignore[attr-defined]
  found = integrate.solve_ivp(
    lambda _, shares: flow(shares, swarm.values, swarm.stop, read),
    (0.0, _LONGEST), np.zeros(len(swarm.qualities)), events=reached, rtol=1e-8,
    atol=1e-10,
  )  # fmt: skip
  (events,) = found.t_events
  return float(events[0]) * swarm.unit_s if len(events) else math.inf


def list_shares(swarm: colony_swarm.Swarm, read: float = 1.0) -> np.ndarray:
  """The shares (S,) for which an endless swarm of `list` dances at rest.

  Without noise: whoever finds a site of value q dances for q steps, so that
  f_j = u q_j ((1 - lambda) pi_j + lambda read f_j), u the share that is free.

  Args:
    swarm: The swarm, of the model `list`.
    read: Share of frames that is read.
  """
  values = np.maximum(np.rint(swarm.values), 1)
  alone = (1 - swarm.follow) * swarm.found / len(values)
  low, high = 0.0, 1.0
  for _ in range(200):  # The larger u is, the more dance: halve.
    free = (low + high) / 2
    kept = 1 - free * values * swarm.follow * read
    if (kept <= 0).any() or (free * values * alone / kept).sum() > 1 - free:
      high = free
    else:
      low = free
  return low * values * alone / (1 - low * values * swarm.follow * read)
