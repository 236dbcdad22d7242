"""Trains the network of the receiver `learned`, and writes its weights.

Windows of tracks are drawn, see `studies.learned_tracks`; nothing is flown and
nothing is rendered. Takes the names of languages: paper, swift. The same seed,
steps and versions make the same file. What is printed last of each is its
SHA-256, which stands in `waggle_tasks.agents.learned_weights`, so that other
weights are other sources.
"""

from collections.abc import Sequence
import hashlib
import io
import pathlib
import sys
import time

from absl import flags
import numpy as np

from waggle_tasks.agents import group, learned_weights
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import folders
from waggle_tasks.experiments.studies import learned_tracks, learned_training
from waggle_tasks.protocol import checks

ARGUMENTS = '[LANGUAGE ...]'

_OUTPUT = flags.DEFINE_string(
  'output', '.', 'Folder to write learned_LANGUAGE.npz into.'
)
_SEED = flags.DEFINE_integer('seed', 0, 'Of all that is drawn.', lower_bound=0)
_STEPS = flags.DEFINE_integer(
  'steps', 9000, 'How many batches it learns from.', lower_bound=1
)


def main(argv: Sequence[str]) -> int:
  """Trains, prints how well windows are read and writes the weights."""
  names = argv[1:] or [*learned_weights.TRAINED]
  for name in names:
    checks.choice(
      'language', name, [*learned_weights.TRAINED], group.ReceiverError
    )
  folder = pathlib.Path(_OUTPUT.value)
  folders.check_writable(folder)
  for name in names:
    _train(name, folder)
  return 0


def _train(name: str, folder: pathlib.Path) -> None:
  spoken = learned_weights.TRAINED[name].language
  tracks = learned_tracks.Tracks(spoken.alphabet, spoken.confirm_s)
  begin_s = time.process_time()
  found = learned_training.train(
    tracks, _SEED.value, _STEPS.value,
    lambda step, loss: print(f'{name}: step {step}, loss {loss:.4f}'),
  )  # fmt: skip
  minutes = (time.process_time() - begin_s) / 60
  print(
    f'{name}: seed {_SEED.value}, {_STEPS.value} steps in {minutes:.1f} min of'
    f' a core; {learned_training.score(found, tracks, _SEED.value + 1)}'
  )
  file = io.BytesIO()
  np.savez(file, **found.arrays())  # type: ignore[arg-type]
  data = file.getvalue()
  path = files.replace(folder / learned_weights.path(name).name, data)
  print(f'{path}: {len(data)} bytes, {hashlib.sha256(data).hexdigest()}')


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
