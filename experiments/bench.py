"""Measures images, the loop and whole broadcasts on this machine.

Prints medians over repeats, ratios first: they depend least on the machine.
Everything is measured on one core with one drawing thread, but for the
throughput of two processes. `--check_events` measures nothing: it flies cases
with either camera and tells whether their event logs are equal. Exit status 0,
1 when they are not, 2 on bad input.
"""

from collections.abc import Sequence
import contextlib
import pathlib
import sys

from absl import flags

from waggle_tasks.experiments import launch

_REPEATS = flags.DEFINE_integer('repeats', 3, 'How often each part is run.')
_ONLY = flags.DEFINE_list(
  'only',
  [],
  'Only these parts: cameras, eyes, stages, receivers, realtime, languages,'
  ' dynamics, fidelities, learners, which takes the extra rl, observers,'
  ' memory, workers.',
)
_RECEIVER = flags.DEFINE_multi_string('receiver', None, '')
# absl adds a sentence to the help of a flag that may be given again.
flags.FLAGS['receiver'].help = (
  "A receiver to measure beside the paper's; may be given again. Unset, all"
  ' that have a name.'
)
_SIMULATED_S = flags.DEFINE_float(
  'simulated_s', None, 'Length of each broadcast, in s; unset, what is needed.'
)
_LONG = flags.DEFINE_boolean(
  'long', False, 'Whether memory is watched over whole broadcasts.'
)
_JSON = flags.DEFINE_string('json', None, 'New file for all numbers.')
_CHECK_EVENTS = flags.DEFINE_boolean(
  'check_events', False, 'Compare event logs instead.'
)
_SUITE = flags.DEFINE_string(
  'suite', None, 'Whose event logs; unset, those of the default broadcast.'
)


def main(argv: Sequence[str]) -> int:
  """Measures or checks what the flags ask for."""
  del argv  # All is in the flags.
  # Imported here, as processes that measure import this module when it is run
  # by itself, and must not load a GL stack before they are confined.
  from waggle_tasks.experiments.record import folders

  with contextlib.ExitStack() as stack:
    if _JSON.value is not None:
      stack.enter_context(folders.claimed(pathlib.Path(_JSON.value), 'json'))
    return _run()


def _run() -> int:
  """Does it, and leaves all numbers in the file whose name is claimed."""
  from waggle_tasks.experiments.bench_parts import answers, sections
  from waggle_tasks.experiments.machine import files
  from waggle_tasks.experiments.record import encoding

  here = answers.machine()
  if _CHECK_EVENTS.value:
    answer = answers.check_events(_SUITE.value)
  else:
    settings = sections.Settings(
      here['renderer'],
      _REPEATS.value,
      _SIMULATED_S.value,
      _LONG.value,
      tuple(_RECEIVER.value or ()),
    )
    answer = answers.measure(here, _ONLY.value, settings)
  if _JSON.value is not None:
    text = encoding.pretty({**here, **answer.found})
    files.put(pathlib.Path(_JSON.value), text)
  print(answer.text)
  return 0 if answer.passed else 1


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
