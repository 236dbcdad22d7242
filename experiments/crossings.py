"""Flies random crossings of vehicles that avoid each other, and counts.

Vehicles begin at random places of a square and all go to random others at
once, in MuJoCo, by the ideal controller and by the law of `--safety=avoid`;
nothing is drawn. For each number of vehicles it prints how many crossings there
were, how many pairs touched, in how many crossings somebody was caught and had
not arrived after a minute, how many vehicles arrived, the least distance of
two, how much longer than alone they flew in the mean, and when the last one
arrived.
Exit status 0 when nobody touched and all arrived, 1 otherwise.
"""

from collections.abc import Sequence
import concurrent.futures
import itertools
import multiprocessing
import sys
from typing import TYPE_CHECKING

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.episodes import crossing_rows
from waggle_tasks.experiments.flags import engine_flag
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import checks

if TYPE_CHECKING:
  from waggle_tasks.experiments.episodes import crossing

_VEHICLES = flags.DEFINE_list(
  'vehicles', ['5', '8', '12', '16', '20'], 'Numbers of them.'
)
_COUNT = flags.DEFINE_integer(
  'count', 1000, 'How many crossings in all, shared among these numbers.'
)
_SEED = flags.DEFINE_integer('seed', 0, 'Seed of the first crossing of each.')
engine_flag.define_workers()

_CHUNK = 10  # Crossings that a process flies before it is asked again.


def main(argv: Sequence[str]) -> int:
  """Prints the table; returns the exit status."""
  del argv
  numbers = [_number(text) for text in _VEHICLES.value]
  if not numbers:
    raise errors.WaggleError('`vehicles` must be one number at least: got none')
  count = checks.integer(
    'count', _COUNT.value, len(numbers), 10**6, errors.WaggleError
  )
  seed = checks.integer('seed', _SEED.value, 0, 10**9, errors.WaggleError)
  shares = [
    count // len(numbers) + (k < count % len(numbers))
    for k in range(len(numbers))
  ]
  flown = _fly(numbers, shares, seed)
  rows = [crossing_rows.row(each) for each in flown]
  print(table.render(crossing_rows.HEADER, rows))
  every = itertools.chain.from_iterable(flown)
  good = all(c.arrived == c.vehicles and not c.contacts for c in every)
  return 0 if good else 1


def _number(text: str) -> int:
  """A number of vehicles.

  Raises:
    WaggleError: if the text is none, or there cannot be so many.
  """
  try:
    number = int(text)
  except ValueError:
    raise errors.WaggleError(
      f'`vehicles` must be an integer: got {text!r}'
    ) from None
  return checks.integer('vehicles', number, 2, 64, errors.WaggleError)


def _fly(
  numbers: Sequence[int], shares: Sequence[int], seed: int
) -> list[list['crossing.Crossing']]:
  """Flies so many crossings of each number of vehicles."""
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import crossing

  spawn = multiprocessing.get_context('spawn')
  with concurrent.futures.ProcessPoolExecutor(
    engine_flag.workers(), mp_context=spawn
  ) as pool:
    jobs = [
      [
        pool.submit(
          crossing.several, number,
          range(seed + first, seed + min(first + _CHUNK, share)),
        )
        for first in range(0, share, _CHUNK)
      ]
      for number, share in zip(numbers, shares, strict=True)
    ]  # fmt: skip
    return [[c for job in each for c in job.result()] for each in jobs]


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
