"""Swarms that choose a site, case by case, by the engine of sweeps."""

from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
import hashlib
import itertools
import pathlib
from typing import Any

import numpy as np

from waggle_tasks import errors, plain
from waggle_tasks.experiments.episodes import (
  colony_swarm,
  colony_worlds,
  ladder_table,
)
from waggle_tasks.experiments.record import encoding, provenance
from waggle_tasks.experiments.studies import batch, pool
from waggle_tasks.protocol import checks

FIGURES = 'colony.svg', 'colony.png'
_FILES = 'summary.txt', 'index.html', *FIGURES
_MOST_CELLS, _MOST_WORLDS = 20_000, 1_000_000
_BATCH = 2_000_000  # Vehicles of all worlds that are stepped at once.
# Quantiles of the time to a quorum: its median and the middle half.
QUANTILES = 0.25, 0.5, 0.75


@dataclasses.dataclass(frozen=True)
class Case:
  """Worlds of one kind.

  Attributes:
    swarm: What each of them is.
    worlds: How many there are.
    seed: Of this study.
  """

  swarm: colony_swarm.Swarm
  worlds: int
  seed: int

  def identity(self, sources: str) -> str:
    """A SHA-256 of all that decides what they choose.

    Args:
      sources: Digest of this project's sources.
    """
    table = hashlib.sha256(ladder_table.PATH.read_bytes()).hexdigest()
    parts = plain.to_plain(self), sources, table, provenance.versions()
    return hashlib.sha256(encoding.dumps(parts).encode()).hexdigest()

  @property
  def drawn(self) -> int:
    """The seed of its own: others have others."""
    text = encoding.dumps(plain.to_plain(self))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], 'big')


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
  """What the worlds of a case chose.

  Attributes:
    identity: See `Case.identity`.
    case: The case.
    best: How many chose the best site...
    other: ...another one...
    none: ...and none in time.
    quantiles_s: `QUANTILES` of the time to a quorum, of those that chose; empty
      for none.
    read: Share of frames that could be read, in the mean of worlds...
    read_low: ...in the worst world...
    read_high: ...and in the best one.
    frames: Frames that were watched, in all worlds.
    course: Every tenth of the way, the shares of the swarm for each site, in
      the first world.
  """

  identity: str
  case: Case
  best: int
  other: int
  none: int
  quantiles_s: tuple[float, ...]
  read: float
  read_low: float
  read_high: float
  frames: int
  course: tuple[tuple[float, ...], ...]


def cases(
  base: colony_swarm.Swarm,
  factors: Mapping[str, Sequence[Any]],
  worlds: int,
  seed: int,
) -> list[Case]:
  """Every combination of factors.

  Args:
    base: What they change.
    factors: Fields of a swarm, or of how it is watched, and their values;
      'ratio' makes two sites of the qualities 1 and that.
    worlds: Of each case.
    seed: Of the study.

  Raises:
    WaggleError: if one breaks a rule.
  """
  error = colony_swarm.ColonyError
  checks.integer('worlds', worlds, 1, _MOST_WORLDS, error)
  checks.integer('seed', seed, 0, 2**32 - 1, error)
  for name, values in factors.items():
    if not values or len({*values}) < len(values):
      raise error(
        f'`{name}` must be given once each, and one the least: got {[*values]}'
      )
  out = [
    Case(_swarm(base, dict(zip(factors, picked, strict=True))), worlds, seed)
    for picked in itertools.product(*factors.values())
  ]
  if len(out) > _MOST_CELLS:
    raise error(f'there must be at most {_MOST_CELLS} cases: got {len(out)}')
  for each in out:  # Refuses what was not measured, before anything is done.
    one = dataclasses.replace(each.swarm, vehicles=2, longest_s=1e6)
    one = dataclasses.replace(one, longest_s=one.step_s)
    colony_worlds.run(one, 1, 0)
  return out


def _swarm(
  base: colony_swarm.Swarm, picked: Mapping[str, Any]
) -> colony_swarm.Swarm:
  known = {field.name for field in dataclasses.fields(base.watching)}
  own = {n: v for n, v in picked.items() if n not in known and n != 'ratio'}
  watching = {name: v for name, v in picked.items() if name in known}
  if 'ratio' in picked:
    own['qualities'] = (1.0, picked['ratio'])
  try:
    return dataclasses.replace(
      base, watching=dataclasses.replace(base.watching, **watching), **own
    )
  except errors.WaggleError as error:
    cell = ' '.join(f'{name}={value}' for name, value in picked.items())
    raise colony_swarm.ColonyError(f'case {cell}: {error}') from None


def choose(report: Callable[[float], None], case: Case, identity: str) -> Row:
  """Lets the worlds of a case choose; called in a worker."""
  most = max(_BATCH // case.swarm.vehicles, 1)
  parts = [
    colony_worlds.run(case.swarm, count, case.drawn + number, report=report)
    for number, count in enumerate(_batches(case.worlds, most))
  ]
  chosen = np.concatenate([part.chosen for part in parts])
  steps = np.concatenate([part.steps for part in parts])[chosen >= 0]
  read = np.concatenate([part.read for part in parts])
  times_s = steps * case.swarm.step_s
  quantiles_s = np.quantile(times_s, QUANTILES) if len(steps) else ()
  return Row(
    identity=identity,
    case=case,
    best=int((chosen == 0).sum()),
    other=int((chosen > 0).sum()),
    none=int((chosen < 0).sum()),
    quantiles_s=tuple(round(float(each), 3) for each in quantiles_s),
    read=round(float(read.mean()), 6),
    read_low=round(float(read.min()), 6),
    read_high=round(float(read.max()), 6),
    frames=sum(part.frames for part in parts),
    course=_course(parts[0].shares),
  )


def _batches(worlds: int, most: int) -> Iterator[int]:
  for begin in range(0, worlds, most):
    yield min(most, worlds - begin)


def _course(shares: np.ndarray) -> tuple[tuple[float, ...], ...]:
  rows = np.linspace(0, len(shares) - 1, 11).round().astype(int)
  return tuple(tuple(round(float(x), 4) for x in shares[row]) for row in rows)


def run(
  members: Sequence[Case],
  folder: pathlib.Path,
  engine: pool.Engine,
  command: str,
) -> list[Row]:
  """Lets all cases choose that a folder lacks; see `batch.run`."""
  digest = provenance.source_digest(provenance.deciding_hashes())
  jobs = {}
  for number, case in enumerate(members):
    identity = case.identity(digest)
    name = f'case {number}'
    jobs[identity] = batch.job(name, choose, case, identity)
  what = 'colony', _FILES
  return batch.run(jobs, Row, folder, engine, command, what)
