"""Random crossings as lines of a table; nothing here needs a simulator."""

from collections.abc import Sequence
import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
  from waggle_tasks.experiments.episodes import crossing

HEADER = (
  'vehicles', 'crossings', 'contacts', 'deadlocks', 'arrived', 'least m',
  'longer', 'last s',
)  # fmt: skip


def row(several: Sequence['crossing.Crossing']) -> list[str]:
  """A line of the table: all crossings of one number of vehicles."""
  vehicles = several[0].vehicles
  caught = sum(each.arrived < vehicles for each in several)
  slower = [each.slower for each in several if not math.isnan(each.slower)]
  last = [each.last_s for each in several if not math.isnan(each.last_s)]
  longer = sum(slower) / len(slower) - 1 if slower else math.nan
  return [
    str(vehicles),
    str(len(several)),
    str(sum(each.contacts for each in several)),
    str(caught),
    f'{sum(each.arrived for each in several)}/{vehicles * len(several)}',
    f'{min(each.least_m for each in several):.3f}',
    f'{longer:.1%}',
    f'{max(last):.1f}' if last else '-',
  ]
