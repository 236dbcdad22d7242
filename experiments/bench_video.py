"""Times the same broadcast with and without its video and its report.

Prints the median of each over repeats, taken in turns, and their ratio; and
how large the video, the page and the raw captures of an observer are. Exit
status 0 when video and report at most double the time, 1 otherwise.
"""

from collections.abc import Sequence
import pathlib
import statistics
import sys
import tempfile
import time

from absl import flags

from waggle_tasks import scenario
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.pages import document, run_page
from waggle_tasks.experiments.record import capture, provenance, writer

_REPEATS = flags.DEFINE_integer(
  'repeats', 3, 'How often each is run.', lower_bound=1
)
_OBSERVERS = flags.DEFINE_integer('observers', 3, 'How many observers.')
_SIMULATED_S = flags.DEFINE_float(
  'simulated_s', None, 'Length of the broadcast, in s; unset, all of it.'
)

_MOST = 2.0  # Times as long with video and report.


def main(argv: Sequence[str]) -> int:
  """Measures, prints, and returns the exit status."""
  del argv
  scene = scenario.Scenario(
    observers=_OBSERVERS.value, duration_s=_SIMULATED_S.value
  )
  plain_s, filmed_s = [], []
  for _ in range(_REPEATS.value):
    plain_s.append(plain(scene))
    took_s, sizes = filmed(scene)
    filmed_s.append(took_s)
  ratio = statistics.median(filmed_s) / statistics.median(plain_s)
  rows = [
    ('run alone, s', f'{statistics.median(plain_s):.2f}'),
    ('with video and report, s', f'{statistics.median(filmed_s):.2f}'),
    ('times as long', f'{ratio:.2f}'),
    *((f'{name}, MB', f'{size / 1e6:.2f}') for name, size in sizes.items()),
  ]
  print(table.render((f'{scene.observers} observers', ''), rows))
  return 0 if ratio <= _MOST else 1


def plain(scene: scenario.Scenario) -> float:
  """Seconds that a run takes that leaves nothing."""
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import evaluator
  from waggle_tasks.experiments.episodes import rollout as rollout_lib

  began_s = time.perf_counter()
  evaluator.evaluate(scene, rollout_lib.run(scene, 'klt'))
  return time.perf_counter() - began_s


def filmed(scene: scenario.Scenario) -> tuple[float, dict[str, int]]:
  """Seconds that the same takes with video, data and page; their sizes.

  The raw captures are made in a run of their own.
  """
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import evaluator
  from waggle_tasks.experiments.episodes import rollout as rollout_lib
  from waggle_tasks.experiments.video import film

  with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    began_s = time.perf_counter()
    start = provenance.Start.now('')
    with film.Film(folder, scene) as camera:
      rollout = rollout_lib.run(scene, 'klt', [camera])
    verdict = evaluator.evaluate(scene, rollout)
    origin = start.end(rollout.renderer)
    writer.write_run(folder, scene, 'klt', rollout, verdict, origin)
    run_page.write(folder)
    took_s = time.perf_counter() - began_s
    with capture.Recorder(folder) as recorder:
      rollout_lib.run(scene, 'klt', [recorder])
    largest = max(path.stat().st_size for path in capture.paths(folder))
    return took_s, {
      'video': (folder / 'composite.webm').stat().st_size,
      'page': (folder / document.NAME).stat().st_size,
      'largest raw capture': largest,
    }


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
