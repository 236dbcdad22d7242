"""Many worlds of vehicles that choose a site by dancing, side by side."""

from collections.abc import Callable

import numpy as np

from waggle_tasks.experiments.episodes import (
  colony_swarm,
  ladder_table,
  word_level,
)

_NOBODY = -1  # The site of a vehicle that has none.


class _Worlds:
  """All worlds that have not chosen yet.

  Attributes:
    sites: (K, N) int8 which site each vehicle is for.
    measures: (K, N) float32 what it takes the value of its site for.
    left: (K, N) int32 for how many steps it dances still, in `list`.
    kept: (K,) which of all worlds these are.
  """

  def __init__(
    self,
    swarm: colony_swarm.Swarm,
    worlds: int,
    rng: np.random.Generator,
    table: ladder_table.Table | None,
  ) -> None:
    self.swarm, self.rng = swarm, rng
    shape = worlds, swarm.vehicles
    self.sites = np.full(shape, _NOBODY, np.int8)
    self.measures = np.zeros(shape, np.float32)
    self.left = np.zeros(shape, np.int32)
    self.kept = np.arange(worlds)
    self.channel = word_level.Channel(swarm.watching, worlds, rng, table)
    self.frames = 0

  def others(self) -> np.ndarray:
    """(K, N) whom each vehicle watches: any other one."""
    count = self.sites.shape[1]
    ahead = self.rng.integers(1, count, size=self.sites.shape, dtype=np.int32)
    return (np.arange(count, dtype=np.int32) + ahead) % count

  def chance(self) -> np.ndarray:
    """(K, N) evenly drawn from 0 to 1."""
    return self.rng.random(self.sites.shape, np.float32)

  def heard(self, dances: np.ndarray, site: np.ndarray) -> np.ndarray:
    """(K, N) the site that each reads of who it watches; -1 for none.

    Args:
      dances: (K, N) whether there is a frame to be read.
      site: (K, N) what it says.
    """
    self.frames += int(np.count_nonzero(dances))
    vehicles = self.sites.shape[1]
    read = dances & self.channel.read(vehicles, self.rng, self.kept)
    out = np.where(read, site, np.int8(_NOBODY))
    if self.swarm.wrong:
      count = len(self.swarm.qualities)
      false = read & (self.chance() < self.swarm.wrong)
      away = self.rng.integers(1, count, size=site.shape, dtype=np.int8)
      out = np.where(false, (site + away) % count, out).astype(np.int8)
    return out

  def visit(self, comes: np.ndarray, site: np.ndarray) -> None:
    """Those who come to a site measure it.

    Args:
      comes: (K, N) who.
      site: (K, N) where.
    """
    swarm, visited = self.swarm, site[comes]
    error = self.rng.normal(0.0, swarm.noise, len(visited))
    measured = swarm.values[visited] * np.exp(error)
    self.sites[comes] = visited
    self.measures[comes] = measured
    self.left[comes] = np.maximum(np.rint(measured), 1)

  def keep(self, these: np.ndarray) -> None:
    """Drops all other worlds, (K,)."""
    self.sites, self.measures = self.sites[these], self.measures[these]
    self.left, self.kept = self.left[these], self.kept[these]

  def counts(self) -> np.ndarray:
    """(K, S) how many vehicles are for each site."""
    sites = range(len(self.swarm.qualities))
    return np.stack([(self.sites == k).sum(axis=1) for k in sites], axis=1)


def run(
  swarm: colony_swarm.Swarm,
  worlds: int,
  seed: int,
  table: ladder_table.Table | None = None,
  report: Callable[[float], None] = lambda done_s: None,
) -> colony_swarm.Choice:
  """Lets worlds choose.

  Args:
    swarm: What each world is.
    worlds: How many there are.
    seed: Of all that is drawn.
    table: What was measured; None for that of the package.
    report: Told now and then how many seconds are done.

  Raises:
    LadderError: if the table does not tell of how dances are watched.
  """
  rng = np.random.default_rng(seed)
  state = _Worlds(swarm, worlds, rng, table)
  step = _value if swarm.model == 'value' else _list
  chosen, steps = np.full(worlds, _NOBODY), np.full(worlds, swarm.steps)
  shares: list[np.ndarray] = []
  for number in range(1, swarm.steps + 1):
    step(state)
    counts = state.counts()
    if state.kept[0] == 0:
      shares.append(counts[0] / swarm.vehicles)
    whole = swarm.vehicles
    if swarm.model == 'list':  # Of those who dance; but never of a few.
      whole = np.maximum(counts.sum(axis=1), swarm.vehicles / 2)
    done = counts.max(axis=1) >= swarm.quorum * whole - 1e-9
    if done.any():
      chosen[state.kept[done]] = counts[done].argmax(axis=1)
      steps[state.kept[done]] = number
      state.keep(~done)
      if not len(state.kept):
        break
    if number % 100 == 0:
      report(number * swarm.step_s)
  return colony_swarm.Choice(
    chosen, steps, np.array(shares), state.channel.share, state.frames
  )


def _value(state: _Worlds) -> None:
  """A step of Pais et al. 2013, as agents by Reina et al. 2015."""
  swarm, rate = state.swarm, state.swarm.rate
  sites, chance = state.sites, state.chance()
  free = sites == _NOBODY
  other = state.others()
  theirs = np.take_along_axis(sites, other, axis=1)
  vigour = np.take_along_axis(state.measures, other, axis=1) * rate
  # Who is free watches a dance, whose vigour is how often it is danced; who is
  # not is stopped by who dances for another site.
  recruits = free & (theirs != _NOBODY) & (state.chance() < vigour)
  stops = ~free & (theirs != _NOBODY) & (theirs != sites)
  stops &= state.chance() < swarm.stop * rate
  heard = state.heard(recruits | stops, theirs)
  # Without a dance, the sites are found by their values, one after another.
  edges = np.concatenate([[0.0], np.cumsum(swarm.values * rate)])
  found = np.searchsorted(edges, chance, side='right') - 1
  finds = free & (found < len(swarm.qualities))
  comes = free & (finds | (heard != _NOBODY))
  where = np.where(finds, found, heard).astype(np.int8)
  tires = ~free & (chance * np.maximum(state.measures, 1e-9) < rate)
  leaves = tires | (stops & (heard != _NOBODY))
  sites[leaves] = _NOBODY
  state.visit(comes, where)


def _list(state: _Worlds) -> None:
  """A step of List, Elsholtz and Seeley 2009."""
  swarm, sites = state.swarm, state.sites
  free = sites == _NOBODY
  theirs = np.take_along_axis(sites, state.others(), axis=1)
  follows = free & (state.chance() < swarm.follow)
  heard = state.heard(follows & (theirs != _NOBODY), theirs)
  count = len(swarm.qualities)
  each = max(swarm.found / count, 1e-12)
  found = np.minimum(state.chance() / each, count).astype(np.int8)
  finds = free & ~follows & (found < count)
  state.left[~free] -= 1
  sites[~free & (state.left <= 0)] = _NOBODY
  comes = finds | (heard != _NOBODY)
  state.visit(comes, np.where(finds, found, heard))
