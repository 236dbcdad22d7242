"""Shows a dance in MuJoCo's own viewer, where there is a display.

Observers read and fly as in `waggle broadcast`; nothing is kept. The window can
be turned, zoomed and closed at any moment. Exit status 0, or 2 on bad input and
where there is no display.
"""

from collections.abc import Sequence
import os
import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import (
  config_flag,
  foresight,
  receiver_flag,
  scenario_flags,
)
from waggle_tasks.experiments.studies import live
from waggle_tasks.experiments.video import window
from waggle_tasks.protocol import checks

scenario_flags.define()
_RECEIVER = receiver_flag.define()
_CONFIG = config_flag.define(
  'its scenario and its receiver are shown. Flags that are given beside it'
  ' change what it says.'
)
_SPEED = flags.DEFINE_float(
  'speed', 1.0, 'Simulated seconds in a second, 0.01 to 100.'
)


def main(argv: Sequence[str]) -> int:
  """Shows the scenario of the flags and returns the exit status."""
  del argv
  speed = checks.number('speed', _SPEED.value, 0.01, 100.0, errors.WaggleError)
  scene, receiver_name = config_flag.chosen(_CONFIG, _RECEIVER)
  foresight.tell([scene], receiver_name)
  window.check_display(os.environ, sys.platform)
  # Imported here: help needs no simulator.
  from waggle_tasks.experiments.episodes import rollout

  with live.onlookers(scene, wanted=True) as lines:
    shown = window.Window(speed, scene.hover_height_m)
    try:
      rollout.run(scene, receiver_name, [*lines, shown])
    except window.ClosedError:
      pass
    finally:
      shown.close()
  return 0


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
