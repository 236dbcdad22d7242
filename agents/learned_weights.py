"""The weights that come with the package, and the languages that they know.

Each file says what `python -m waggle_tasks.experiments.train_learned` made. Its
SHA-256 stands here, so that other weights are other sources: results tell them
apart, and a file that was changed or cut is refused.
"""

import dataclasses
import functools
import hashlib
import io
import pathlib

import numpy as np

from waggle_tasks.agents import group, network
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import languages


@dataclasses.dataclass(frozen=True)
class Trained:
  """What was trained for one language.

  Attributes:
    language: What is spoken; its code and its pauses do not matter.
    digest: SHA-256 of the file.
  """

  language: languages.Language
  digest: str


TRAINED = {
  'paper': Trained(
    agreement_lib.Agreement().spoken,
    'b81a431cf43b52577769abcb7e1a515942a1422b4340ca74de343923831a0b20',
  ),
  'swift': Trained(
    languages.LANGUAGES['swift'],
    '48d05dad033bd0680fb0bf45c7d058a206a55eafc1224f324f6ae0c28c076d71',
  ),
}


def path(name: str) -> pathlib.Path:
  """Where the weights of a language lie."""
  return pathlib.Path(__file__).with_name(f'learned_{name}.npz')


def of(agreement: agreement_lib.Agreement) -> network.Network:
  """The network that was trained for what is spoken.

  Raises:
    ReceiverError: if there is none, or its file is not as it was made.
  """
  spoken = agreement.spoken
  for name, each in TRAINED.items():
    known = each.language
    if (known.alphabet, known.confirm_s) == (spoken.alphabet, spoken.confirm_s):
      return _read(name)
  raise group.ReceiverError(
    f'`language` must be one of {[*TRAINED]}, with its own gestures and rests,'
    " for the receiver 'learned', which knows what it was trained on: choose"
    " the receiver 'joint', which reads every language"
  )


@functools.cache
def _read(name: str) -> network.Network:
  file = path(name)
  try:
    data = file.read_bytes()
  except OSError as error:
    raise group.ReceiverError(
      f'`{file.name}` must be beside the receiver: {error}'
    ) from None
  if hashlib.sha256(data).hexdigest() != TRAINED[name].digest:
    raise group.ReceiverError(
      f'`{file.name}` must be the file that comes with this version: its'
      ' SHA-256 is another'
    )
  with np.load(io.BytesIO(data)) as arrays:
    return network.Network.of(arrays)
