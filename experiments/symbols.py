"""Flies MoCom's timelines and shows how many of their symbols are read.

Each message is danced in MoCom's four motions before an observer in front, at
the distances that MoCom tells of; every gesture lasts 7.1 to 8.4 s and every
gap 1.8 to 3.3 s, drawn each by itself. All receivers see the same images.
Prints for each the share of motions that it named rightly and of nulls that it
confirmed, beside what is published of other data. The exit status is 1 when a
message was read that was not flown. See docs/recordings.md.
"""

from collections.abc import Sequence
import sys

from absl import flags
import numpy as np
import tqdm

from waggle_tasks.agents import receivers
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import fitting
from waggle_tasks.experiments.studies import mocom_flights
from waggle_tasks.protocol import checks, mocom
from waggle_tasks.protocol import payload as payload_lib

_RECEIVER = flags.DEFINE_multi_string('receiver', None, '')
flags.FLAGS['receiver'].help = (
  'Who reads; may be given again. Unset, all of'
  f' {", ".join(receivers.RECEIVERS)} but learned, with nulls that the gaps'
  ' hold.'
)
_MESSAGES = flags.DEFINE_integer(
  'messages', 2, 'Messages of drawn timelines at each distance, 1 to 64.'
)
_SEED = flags.DEFINE_integer('seed', 0, 'Of payloads and timelines.')
_EVEN = flags.DEFINE_boolean(
  'even', True,
  'Whether one more message at each distance has gestures and gaps of the'
  ' agreed lengths, without which no frame can be read as a whole.',
)  # fmt: skip

_DISTANCES_M = 0.9, 1.2, 1.5
_TOLD = (
  'Those are shares of data that are not here, by networks that were trained,\n'
  "MoCom's of flights of a real vehicle. Here all is rendered, by one still\n"
  'camera in front and ideal flight, nothing was trained, and motions are\n'
  'found in the whole film.'
)


def main(argv: Sequence[str]) -> int:
  """Flies the messages and returns the exit status."""
  del argv
  checks.integer('messages', _MESSAGES.value, 1, 64, payload_lib.PayloadError)
  checks.integer('seed', _SEED.value, 0, 2**31 - 1, payload_lib.PayloadError)
  names = _RECEIVER.value or [
    fitting.fitted(name, mocom.AGREEMENT)
    for name in receivers.RECEIVERS
    if name != 'learned'  # Of other gestures.
  ]
  names = list(dict.fromkeys(names))
  for name in names:
    receivers.make(name, mocom.AGREEMENT)
  scenes = _scenes()
  nothing = mocom_flights.Count()
  counts = {name: [nothing] * (len(_DISTANCES_M) + 1) for name in names}
  for column, scene in tqdm.tqdm(scenes, desc='messages'):
    for name, events in mocom_flights.read(scene, names).items():
      counts[name][column] += mocom_flights.count(scene, events)
  print(table.render(_HEADER, [_row(n, each) for n, each in counts.items()]))
  print()
  published = [
    [each.source, each.eye, *(f'{share} % {of}' for share, of in pairs)]
    for each in mocom.PUBLISHED
    for pairs in [list(zip(each.shares, each.of, strict=True))]
  ]
  print(table.render(['published', 'seen with', '', '', ''], published))
  print(f'\n{_TOLD}')
  wrong = sum(each.wrong for row in counts.values() for each in row)
  print(f'\nwrong messages: {wrong}')
  return int(wrong > 0)


def _scenes() -> list[tuple[int, mocom_flights.Timeline]]:
  """All that is flown, each with the column that it counts in."""
  rng = np.random.RandomState(_SEED.value)
  out = []
  for column, distance_m in enumerate(_DISTANCES_M):
    for number in range(_MESSAGES.value + _EVEN.value):
      drawn = number < _MESSAGES.value
      bits = payload_lib.Payload.from_int(int(rng.randint(64))).bits
      seed = int(rng.randint(2**31 - 1))
      scene = mocom_flights.scene(bits, distance_m, seed, drawn)
      out.append((column if drawn else len(_DISTANCES_M), scene))
  return out


_HEADER = [
  'receiver', *(f'{d:g} m' for d in _DISTANCES_M), 'motions', 'nulls',
  'messages', 'even: motions', 'messages',
]  # fmt: skip


def _row(name: str, counts: Sequence[mocom_flights.Count]) -> list[str]:
  """What a receiver read."""
  *drawn, even = counts
  total = sum(drawn, mocom_flights.Count())
  return [
    name,
    *(_share(each.motions_read, each.motions) for each in drawn),
    f'{total.motions_read}/{total.motions}',
    f'{total.nulls_read}/{total.nulls}' if total.nulls_read else '-',
    f'{total.messages_read}/{total.messages}',
    f'{even.motions_read}/{even.motions}',
    f'{even.messages_read}/{even.messages}',
  ]


def _share(part: int, whole: int) -> str:
  return f'{100 * part / whole:.1f} %'


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
