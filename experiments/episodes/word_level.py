"""An episode of words alone: whether each frame is read, from a measured table.

The share of frames that is read is not known, but estimated from few: it is
drawn from what those few leave open, once for every world. That of a condition
is drawn by Jeffreys' prior (Brown, Cai and DasGupta 2001,
doi:10.1214/ss/1009213286), that of each cell by its own frames and one more,
which was read as often as others of the condition.
"""

from collections.abc import Sequence
import dataclasses
import math

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import ladder_table
from waggle_tasks.experiments.record import verdicts
from waggle_tasks.protocol import checks

_STREAM = 19  # Of a seed: what is drawn here is drawn by nobody else.
_PRIOR = 0.5
_COUNTS = 'read', 'sent'
_LEAST = 1e-6  # Of a share, which is never quite none or all.


@dataclasses.dataclass(frozen=True)
class Watching:
  """From where dances are watched, evenly, and what disturbs it.

  Attributes:
    condition: One of `ladder_table.CONDITIONS`, or 'perfect': everything is
      read.
    near_m: The least distance...
    far_m: ...and the largest one.
    aside_deg: How far to the side watchers are at most, 0 to 90 degrees.
  """

  condition: str = ladder_table.CALM
  near_m: float = 0.6
  far_m: float = 3.0
  aside_deg: float = 75.0

  def __post_init__(self) -> None:
    known = (*ladder_table.CONDITIONS, 'perfect')
    error = ladder_table.LadderError
    checks.choice('condition', self.condition, known, error)
    limits = {
      'near_m': (0.1, 10.0),
      'far_m': (self.near_m, 10.0),
      'aside_deg': (0.0, 90.0),
    }
    checks.settle_numbers(self, limits, error)


class Channel:
  """Says for many watchers of many worlds whether a frame is read."""

  def __init__(
    self,
    watching: Watching,
    worlds: int,
    rng: np.random.Generator,
    table: ladder_table.Table | None = None,
  ) -> None:
    """Draws how well frames are read in each world.

    Args:
      watching: From where.
      worlds: How many worlds there are.
      rng: What is drawn from.
      table: What was measured; None for that of the package.

    Raises:
      LadderError: if nothing was measured there.
    """
    self._shares = np.ones((worlds, 1))
    if watching.condition == 'perfect':
      return
    known = table or ladder_table.read()
    cells = known.inside(
      watching.condition, watching.near_m, watching.far_m, watching.aside_deg
    )
    self._shares = shares(cells, known, worlds, rng)

  @property
  def share(self) -> np.ndarray:
    """(W,) of frames that are read in each world, in the mean."""
    return self._shares.mean(axis=1)

  def read(
    self, watchers: int, rng: np.random.Generator, kept: np.ndarray
  ) -> np.ndarray:
    """(K, N) whether each of the watchers reads a frame, in K of the worlds.

    Args:
      watchers: How many each world has.
      rng: What is drawn from.
      kept: (K,) which worlds.
    """
    shape = len(kept), watchers
    if self._shares.shape[1] == 1 and (self._shares == 1).all():
      return np.ones(shape, bool)
    places = rng.integers(self._shares.shape[1], size=shape, dtype=np.int32)
    chance = np.take_along_axis(self._shares[kept], places, axis=1)
    return rng.random(shape, np.float32) < chance


def shares(
  cells: Sequence[ladder_table.Cell],
  table: ladder_table.Table,
  count: int,
  rng: np.random.Generator,
) -> np.ndarray:
  """(N, C) what share of the frames of cells may be read, drawn N times.

  Args:
    cells: Cells of one condition.
    table: Where they are from.
    count: How many times.
    rng: What is drawn from.
  """
  alike = [c for c in table.cells if c.condition == cells[0].condition]
  read, sent = (sum(getattr(c, name) for c in alike) for name in _COUNTS)
  usual = rng.beta(read + _PRIOR, sent - read + _PRIOR, (count, 1))
  usual = usual.clip(_LEAST, 1 - _LEAST)
  own, all_ = (np.array([getattr(c, n) for c in cells]) for n in _COUNTS)
  return rng.beta(own + usual, all_ - own + 1 - usual)


def read(
  scene: scenario.Scenario, table: ladder_table.Table | None = None
) -> list[verdicts.Outcome]:
  """What becomes of every observer of a scenario.

  Raises:
    LadderError: if the table does not tell of the scenario.
  """
  known, performance = table or ladder_table.read(), scene.performance
  _check(scene, known)
  condition = ladder_table.condition_of(scene)
  out = []
  for number, (name, pose) in enumerate(scene.poses().items()):
    if name == 'performer':
      continue
    rng = np.random.default_rng([scene.seed, number, _STREAM])
    x_m, y_m, _ = pose.position_m
    about = known.about(
      condition, math.hypot(x_m, y_m), math.degrees(math.atan2(x_m, -y_m))
    )
    weights, cells = zip(*about, strict=True)
    cell = cells[rng.choice(len(cells), p=np.array(weights) / sum(weights))]
    share = float(shares([cell], known, 1, rng)[0, 0])
    tries = np.flatnonzero(rng.random(scene.repeat) < share)
    black = scene.control == 'black_input' and number == scene.black_observer
    expected = None if black or not performance.message else scene.payload
    outcome = verdicts.Outcome(name, expected)
    if expected is not None:
      if len(tries):
        end_s = _read_s(performance.said_s, cell, int(tries[0]), scene, rng)
        outcome = verdicts.Outcome(
          name, expected, expected, end_s=end_s, final_null_s=end_s
        )
      else:
        why = f'a frame is read in {cell.read} of {cell.sent} cases here'
        outcome = verdicts.Outcome(
          name, expected, failures=(f'message: none, {why}',)
        )
    out.append(outcome)
  return out


def _read_s(
  said_s: float,
  cell: ladder_table.Cell,
  frame: int,
  scene: scenario.Scenario,
  rng: np.random.Generator,
) -> float:
  """When a frame of a dance is read."""
  late_s = rng.choice(cell.late_s) if cell.late_s else 0.0
  slots = scene.performance.schedule.slots
  round_s = (slots[-1].end_s - said_s) / max(scene.repeat - 1, 1)
  return round(float(said_s + frame * round_s + late_s), 3)


def _check(scene: scenario.Scenario, table: ladder_table.Table) -> None:
  """Refuses what the table does not tell of."""
  if scene.language != table.language or scene.bits:
    raise ladder_table.LadderError(
      f'`language` must be {table.language!r}, with payloads and its own code,'
      f" at fidelity 'symbols': got {scene.language!r}"
      f'{" with bits" if scene.bits else ""}'
    )
  known: Sequence[str] = ('none', 'no_send', 'black_input')
  checks.choice('control', scene.control, known, ladder_table.LadderError)
