"""The measured table below the levels without pictures, and how it is read."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
import functools
import itertools
import json
import pathlib
from typing import Any

import numpy as np

from waggle_tasks import errors, plain
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.experiments.record import encoding

PATH = pathlib.Path(__file__).with_name('ladder.json')
CALM, NOISE, MOCAP = 'calm', 'noise', 'mocap'
DROPS, BLACKOUTS = 'drop30', 'blackouts'
CONDITIONS = CALM, NOISE, MOCAP, DROPS, BLACKOUTS
# What those of the conditions are that a scenario may have in part.
NOISE_SIGMA = 10.0
# A tracker tells where a target rested from one that has left that place for
# so long (`agents.ghost`).
LAG_S = 0.16
_SAME = 1e-6


class LadderError(errors.WaggleError):
  """A table that cannot be read, or does not tell of a scenario."""


@dataclasses.dataclass(frozen=True)
class Track:
  """The errors of a tracker in one broadcast; x right and y down, in pixels.

  An error is a share of how far the target is from its place of rest, as it
  turns another side to the camera, and a first-order autoregression.

  Attributes:
    bias_px: Of x and y, the error at its place of rest.
    slope: By how much the errors of x and of y grow with y from there.
    spread_px: Standard deviations of what is left.
    memory: How much of that is left in the next image, -1 to 1.
    lost: Share of images, in which it could be seen, without the target.
    run: How many such images follow each other, in the mean.
    moved_px: How far it had moved `LAG_S` before the tracker found it.
  """

  bias_px: tuple[float, float]
  slope: tuple[float, float]
  spread_px: tuple[float, float]
  memory: tuple[float, float]
  lost: float
  run: float
  moved_px: float


@dataclasses.dataclass(frozen=True)
class Cell:
  """What was measured at one place in one condition.

  Attributes:
    condition: One of `CONDITIONS`.
    distance_m: Where the observer stood...
    angle_deg: ...and how far to the side, degrees from the front.
    sent: Frames.
    read: How many were read rightly.
    wrong: How many were read wrongly.
    late_s: How long after its last motion each frame was read.
    tracks: The tracker's errors in each broadcast in which it found a target.
  """

  condition: str
  distance_m: float
  angle_deg: float
  sent: int
  read: int
  wrong: int
  late_s: tuple[float, ...]
  tracks: tuple[Track, ...]


@dataclasses.dataclass(frozen=True)
class Table:
  """All that was measured.

  Attributes:
    command: The command that made it.
    language: What was spoken.
    receiver: Who read it.
    sources: SHA-256 of the sources of what was measured.
    renderer: What drew the pictures.
    cells: The cells.
  """

  command: str
  language: str
  receiver: str
  sources: str
  renderer: str
  cells: tuple[Cell, ...]

  @functools.cached_property
  def _index(self) -> dict[tuple[str, float, float], Cell]:
    return {(c.condition, c.distance_m, c.angle_deg): c for c in self.cells}

  @functools.cached_property
  def distances_m(self) -> list[float]:
    """Those that were measured, in order."""
    return sorted({cell.distance_m for cell in self.cells})

  @functools.cached_property
  def angles_deg(self) -> list[float]:
    """Those that were measured, in order."""
    return sorted({cell.angle_deg for cell in self.cells})

  def about(
    self, condition: str, distance_m: float, angle_deg: float
  ) -> list[tuple[float, Cell]]:
    """The cells about a place, each with its weight; they sum to 1.

    Args:
      condition: One of `CONDITIONS`.
      distance_m: How far an observer is from the performer.
      angle_deg: From where it looks; to either side it is the same.

    Raises:
      LadderError: if the place lies outside of what was measured.
    """
    near = _between('distance_m', distance_m, self.distances_m)
    aside = _between('bearing_deg', abs(angle_deg), self.angles_deg)
    out = []
    for (away_m, one), (to_deg, other) in itertools.product(near, aside):
      if (weight := one * other) > _SAME:
        if (condition, away_m, to_deg) not in self._index:
          raise LadderError(
            f'`condition` {condition!r} was not measured at {away_m:g} m and'
            f' {to_deg:g} degrees'
          )
        out.append((weight, self._index[condition, away_m, to_deg]))
    return out

  def inside(
    self, condition: str, near_m: float, far_m: float, aside_deg: float
  ) -> list[Cell]:
    """The cells of a condition that lie within distances and an angle.

    Raises:
      LadderError: if there are none.
    """
    found = [
      cell
      for cell in self.cells
      if cell.condition == condition
      and near_m - _SAME <= cell.distance_m <= far_m + _SAME
      and cell.angle_deg <= aside_deg + _SAME
    ]
    if not found:
      raise LadderError(
        f'`near_m` and `far_m` must hold one of the distances'
        f' {self.distances_m} that were measured in {condition!r}: got'
        f' {near_m:g} to {far_m:g} m'
      )
    return found


def _between(
  field: str, value: float, known: Sequence[float]
) -> Iterator[tuple[float, float]]:
  """Those of some values about one, and their weights."""
  if not known or not known[0] - _SAME <= value <= known[-1] + _SAME:
    limits = f'{known[0]:g} to {known[-1]:g}' if known else 'measured'
    raise LadderError(
      f'`{field}` must be {limits} below fidelity'
      f' {"pixels"!r}, for which nothing else was measured: got {value:g}'
    )
  place = float(np.interp(value, known, range(len(known))))
  low = min(int(place), max(len(known) - 2, 0))
  yield known[low], 1 - (place - low)
  if low + 1 < len(known):
    yield known[low + 1], place - low


@functools.lru_cache(maxsize=4)
def read(path: pathlib.Path = PATH) -> Table:
  """The table of a file.

  Raises:
    LadderError: if there is none, or it is damaged.
  """
  try:
    found = encoding.unstamped(json.loads(path.read_text('utf-8')), path)
    return plain.from_plain(Table, found)
  except (OSError, ValueError, errors.WaggleError) as error:
    raise LadderError(f'{path} must be a table of a ladder: {error}') from None


def text(table: Table) -> str:
  """A table as its file has it: a line for each cell."""
  whole: Mapping[str, Any] = encoding.stamped(table)
  lines = [encoding.dumps(cell) for cell in whole['cells']]
  head = encoding.pretty({**whole, 'cells': []}).rstrip()
  body = ',\n    '.join(lines)
  return head.removesuffix('[]\n}') + f'[\n    {body}\n  ]\n}}\n'


def condition_of(scene: scenario_lib.Scenario) -> str:
  """Which measured condition a scenario is, for the level of words.

  Raises:
    LadderError: if it is none.
  """
  sensor, found = scene.sensor, []
  if sensor.noise_sigma == NOISE_SIGMA:
    found.append(NOISE)
  if scene.drift.performer_hover == MOCAP:
    found.append(MOCAP)
  if sensor.dropped_share == 0.3:
    found.append(DROPS)
  black = sensor.blackout_length_s, sensor.blackout_every_s
  if black == (2.0, 10.0):
    found.append(BLACKOUTS)
  quiet = dataclasses.replace(
    sensor, noise_sigma=0.0, dropped_share=0.0, blackout_length_s=0.0
  )
  known = sensor.noise_sigma in (0.0, NOISE_SIGMA)
  known &= sensor.dropped_share in (0.0, 0.3)
  known &= not sensor.blackout_length_s or BLACKOUTS in found
  if len(found) > 1 or not known or not quiet.is_clean:
    raise LadderError(
      f'the scenario must be one of the conditions {CONDITIONS}, as `waggle'
      " link` has them, at fidelity 'symbols': got another, or several at once"
    )
  return found[0] if found else CALM
