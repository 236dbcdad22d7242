"""Lets vehicles learn a language, or to read one, and draws how.

--game=dance: pairs learn a language of their own. A speaker gets a payload and
chooses the heights of a dance; a listener gets the track of that dance, from a
place, at a time and with a tracker's errors that are drawn, and says the
payload. --game=read: readers learn what dances of swift mean, from such tracks.
All know nothing at first, and learn from what they earn. Prints the share of
payloads that is understood, for each seed, beside that of what was made by
hand. --output keeps the curves and draws them.
"""

from collections.abc import Callable, Sequence
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
from waggle_tasks.protocol import checks

if TYPE_CHECKING:
  from waggle_tasks.rl import curve

_GAME = flags.DEFINE_enum(
  'game', 'dance', ['dance', 'read'], 'What is learned.'
)
_PAYLOADS = flags.DEFINE_integer(
  'payloads', None,
  'Of dance: how many payloads there are to tell apart, 2 to 1024; unset, 8.',
)  # fmt: skip
_STROKES = flags.DEFINE_integer(
  'strokes', None,
  'Of dance: how many strokes a dance has, 3 to 16; unset, 3.',
)  # fmt: skip
_SEEDS = flags.DEFINE_integer('seeds', 5, 'How many of them learn, 1 to 100.')
_UPDATES = flags.DEFINE_integer(
  'updates', None,
  'How often they learn; unset, 1000 times of 512 dances in dance, and 2500'
  ' times of 256 dances in read.',
)  # fmt: skip
_OUTPUT = flags.DEFINE_string(
  'output', None,
  'Folder to put curves.json and a picture in, .svg and .png, of the name of'
  ' the game; needs matplotlib.',
)  # fmt: skip

_HEADER = 'learner', 'after a tenth', 'after a half', 'in the end'


def main(argv: Sequence[str]) -> int:
  """Trains, prints the table and draws; returns the exit status."""
  del argv
  error = errors.WaggleError
  seeds = checks.integer('seeds', _SEEDS.value, 1, 100, error)
  train, by_hand = _dance() if _GAME.value == 'dance' else _read()
  if _OUTPUT.value is not None:
    folders.check_writable(pathlib.Path(_OUTPUT.value))
  curves = [train(seed) for seed in tqdm.tqdm(range(seeds), desc=_GAME.value)]
  usual = by_hand()
  print(table.render(_HEADER, [_row(each) for each in curves]))
  print(f'\nmade by hand: {usual:.3f}')
  if _OUTPUT.value is not None:
    from waggle_tasks.experiments.results import learning_figure

    folder = pathlib.Path(_OUTPUT.value)
    drawn = learning_figure.draw(_GAME.value, curves, usual, folder)
    print(*drawn, _keep(curves, usual, folder), sep='\n')
  return 0


_Game = tuple[
  Callable[[int], 'curve.Curve'], Callable[[], float]
]  # How a seed learns, and how well what was made by hand does.


def _dance() -> _Game:
  """Pairs that learn a language of their own."""
  from waggle_tasks.rl import by_hand, learners, signals

  error = errors.WaggleError
  payloads = checks.integer('payloads', _or(_PAYLOADS, 8), 2, 1024, error)
  strokes = checks.integer('strokes', _or(_STROKES, 3), 3, 16, error)
  numbers = learners.Numbers(updates=_or(_UPDATES, 1000))
  channel = signals.Channel(strokes)

  def train(seed: int) -> 'curve.Curve':
    return learners.train(payloads, channel, numbers, seed)

  return train, lambda: by_hand.understood(payloads, channel)


def _read() -> _Game:
  """Readers that learn what dances mean."""
  from waggle_tasks.experiments.episodes import tracks_by_hand
  from waggle_tasks.rl import glimpses, readers

  for flag in (_PAYLOADS, _STROKES):
    if flag.value is not None:
      raise flags.Error(
        f'--{flag.name} must not be given with --game=read, whose language has'
        ' its own'
      )
  seen = glimpses.Glimpses()
  numbers = readers.Numbers(updates=_or(_UPDATES, readers.Numbers.updates))
  return (
    lambda seed: readers.train(seen, numbers, seed),
    lambda: tracks_by_hand.share(seen),
  )


def _or(flag: flags.FlagHolder[int | None], usual: int) -> int:
  return usual if flag.value is None else flag.value


def _row(each: 'curve.Curve') -> tuple[str, ...]:
  """The share that was understood, at three times."""
  last = len(each.right) - 1
  shares = [each.right[k] for k in (last // 10, last // 2, last)]
  return (f'seed {each.seed}', *(f'{share:.3f}' for share in shares))


def _keep(
  curves: Sequence['curve.Curve'],
  by_hand: float,
  folder: pathlib.Path,
) -> pathlib.Path:
  """Writes the curves as JSON."""
  data = {
    'format': 2,
    'game': _GAME.value,
    'by_hand': by_hand,
    'learners': [
      {
        'seed': each.seed,
        'episodes': each.episodes.astype(int).tolist(),
        'understood': each.right.tolist(),
        **({} if each.means is None else {'heights': each.means.tolist()}),
      }
      for each in curves
    ],
  }
  text = json.dumps(data, indent=2) + '\n'
  return files.replace(folder / 'curves.json', text.encode())


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
