"""Lets pairs of vehicles learn a language of their own, and draws how.

A speaker gets a payload and chooses the heights of a dance; a listener gets the
track of that dance, from a place, at a time and with a tracker's errors that
are drawn, and says the payload. Both know nothing at first, and learn from what
is understood. Prints the share of payloads that is understood, for each seed,
beside that of a language that was made by hand. --output keeps the curves and
draws them.
"""

from collections.abc import Sequence
import json
import pathlib
import sys
from typing import TYPE_CHECKING

from absl import flags
import tqdm

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import files, table
from waggle_tasks.experiments.record import folders
from waggle_tasks.experiments.results import learning_figure
from waggle_tasks.protocol import checks

if TYPE_CHECKING:
  from waggle_tasks.rl import learners

_PAYLOADS = flags.DEFINE_integer(
  'payloads', 8, 'How many payloads there are to tell apart, 2 to 1024.'
)
_STROKES = flags.DEFINE_integer(
  'strokes', 3, 'How many strokes a dance has, 3 to 16.'
)
_SEEDS = flags.DEFINE_integer('seeds', 5, 'How many pairs learn, 1 to 100.')
_UPDATES = flags.DEFINE_integer(
  'updates', 1000, 'How often they learn, of 512 dances each.'
)
_OUTPUT = flags.DEFINE_string(
  'output', None,
  'Folder to put curves.json, dance.svg and dance.png in; needs matplotlib.',
)  # fmt: skip

_HEADER = 'pair', 'after a tenth', 'after a half', 'in the end'


def main(argv: Sequence[str]) -> int:
  """Trains, prints the table and draws; returns the exit status."""
  del argv
  from waggle_tasks.rl import by_hand, learners, signals

  error = errors.WaggleError
  payloads = checks.integer('payloads', _PAYLOADS.value, 2, 1024, error)
  strokes = checks.integer('strokes', _STROKES.value, 3, 16, error)
  seeds = checks.integer('seeds', _SEEDS.value, 1, 100, error)
  numbers = learners.Numbers(updates=_UPDATES.value)
  if _OUTPUT.value is not None:
    folders.check_writable(pathlib.Path(_OUTPUT.value))
  channel = signals.Channel(strokes)
  curves = [
    learners.train(payloads, channel, numbers, seed)
    for seed in tqdm.tqdm(range(seeds), desc='pairs')
  ]
  usual = by_hand.understood(payloads, channel)
  print(table.render(_HEADER, [_row(curve) for curve in curves]))
  print(f'\nmade by hand: {usual:.3f}')
  if _OUTPUT.value is not None:
    folder = pathlib.Path(_OUTPUT.value)
    drawn = learning_figure.draw(curves, usual, folder)
    print(*drawn, _keep(curves, usual, folder), sep='\n')
  return 0


def _row(curve: 'learners.Curve') -> tuple[str, ...]:
  """The share that a pair understood, at three times."""
  last = len(curve.right) - 1
  shares = [curve.right[k] for k in (last // 10, last // 2, last)]
  return (f'seed {curve.seed}', *(f'{share:.3f}' for share in shares))


def _keep(
  curves: Sequence['learners.Curve'], by_hand: float, folder: pathlib.Path
) -> pathlib.Path:
  """Writes the curves as JSON."""
  data = {
    'format': 1,
    'by_hand': by_hand,
    'pairs': [
      {
        'seed': curve.seed,
        'episodes': curve.episodes.astype(int).tolist(),
        'understood': curve.right.tolist(),
        'heights': curve.means.tolist(),
      }
      for curve in curves
    ],
  }
  text = json.dumps(data, indent=2) + '\n'
  return files.replace(folder / 'curves.json', text.encode())


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
