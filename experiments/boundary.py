"""Shows that a receiver's events come from its own images and times alone.

Two experiments on one scenario. In the first, a second world differs in all
that a receiver could have peeked at: another payload, other positions of all
vehicles, another dance, and so other images for everybody; each receiver works
in that world beside teammates that see it, but is itself given the images that
it had in the first. Its events must not change. In the second, two observers'
images are swapped: their events must swap. Exit status 0 when both hold, 1
when not.
"""

from collections.abc import Sequence
import dataclasses
import sys
from typing import Any

from absl import flags
import tqdm

from waggle_tasks import errors
from waggle_tasks.agents import receiver, receivers
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import receiver_flag, scenario_flags
from waggle_tasks.experiments.machine import table
from waggle_tasks.protocol import checks

scenario_flags.define()
_RECEIVER = receiver_flag.define()
_OTHER = flags.DEFINE_string(
  'other_payload', '110101', 'Six bits that the other world sends.'
)
_SWAP = flags.DEFINE_list('swap', ['1', '2'], 'Two observers, by number.')


class SwapError(errors.WaggleError):
  """Observers that cannot be swapped."""


def main(argv: Sequence[str]) -> int:
  """Runs both experiments and returns the exit status."""
  del argv
  scene = scenario_flags.read()
  receivers.make(_RECEIVER.value, scene.agreement)
  other = dataclasses.replace(
    scene, payload=_OTHER.value, jitter_m=0.01, seed=scene.seed + 1
  )
  if other.payload == scene.payload:
    raise SwapError(
      f'`other_payload` must differ from `payload`: got {other.payload}'
    )
  swap = _swap(scene.observers)
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import boundary_worlds

  frames = scene.agreement.frames(scene.episode_s)
  with tqdm.tqdm(total=frames, desc='frames') as bar:
    own, foreign, swapped = boundary_worlds.experiment(
      scene, other, _RECEIVER.value, swap, bar.update
    )
  expected = list(own)
  expected[swap[0]], expected[swap[1]] = own[swap[1]], own[swap[0]]
  rows = [
    (
      name,
      _message(own[k]),
      str(len(own[k])),
      'yes' if own[k] == foreign[k] else 'NO',
      _message(swapped[k]),
      'yes' if swapped[k] == expected[k] else 'NO',
    )
    for k, name in enumerate(layouts.names(scene.observers))
  ]
  header = (
    'observer', 'message', 'events', f'same under {other.payload}',
    'message, swapped', 'swapped',
  )  # fmt: skip
  print(table.render(header, rows))
  holds = own == foreign and swapped == expected
  print('The boundary holds.' if holds else 'The boundary is BROKEN.')
  return 0 if holds else 1


def _swap(observers: int) -> tuple[int, int]:
  # Words that are no numbers are refused by the check below.
  numbers: list[Any] = [int(n) if n.isdecimal() else n for n in _SWAP.value]
  if len(numbers) != 2 or numbers[0] == numbers[1]:
    raise SwapError(f'`swap` must name two observers: got {_SWAP.value}')
  one, other = (
    checks.integer('swap', number, 1, observers, SwapError)
    for number in numbers
  )
  return one - 1, other - 1


def _message(events: Sequence[receiver.Event]) -> str:
  return next((e.message.bits for e in events if e.message), '-')


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
