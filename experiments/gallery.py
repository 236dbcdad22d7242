"""Makes the pictures of the documentation.

From one default broadcast: composite.png is a picture of its composite video,
gestures.png the four gestures as the middle observer sees them: the performer
at equal times, and the track that the receiver made of it. With --sweep or
--rooms it flies nothing: envelope.png, and envelope.svg, are the maps of these
sweeps, and rooms.svg tells which part of this project imports which. With
--eyes it is eyes.png, what each camera that has a name sees.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags
import cv2

from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import receiver_flag
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.pages import rooms
from waggle_tasks.experiments.record import folders
from waggle_tasks.experiments.results import envelope, figures
from waggle_tasks.experiments.studies import case_rows

_OUTPUT = flags.DEFINE_string(
  'output', 'docs/gallery', 'Folder of the pictures; those in it are replaced.'
)

_RECEIVER = receiver_flag.define()
_SWEEP = flags.DEFINE_list('sweep', [], 'Draw the envelope of these folders.')
_ROOMS = flags.DEFINE_boolean('rooms', False, 'Draw the rooms of this project.')
_EYES = flags.DEFINE_boolean(
  'eyes', False, 'Draw what each camera sees; takes the extra video.'
)


def main(argv: Sequence[str]) -> int:
  """Flies the broadcast and writes the pictures; returns the exit status."""
  del argv
  folder = pathlib.Path(_OUTPUT.value)
  folders.check_writable(folder)
  if _SWEEP.value:
    print(*_envelope(folder, _SWEEP.value), sep='\n')
    return 0
  if _ROOMS.value:
    whole = rooms.draw(rooms.counts())
    print(files.replace(folder / 'rooms.svg', f'{whole}\n'))
    return 0
  # Imported here: to draw maps, no simulator is needed.
  from waggle_tasks.experiments.video import eye_shots, shots

  pictures = (
    {'eyes.png': eye_shots.take()}
    if _EYES.value
    else shots.take(_RECEIVER.value)
  )
  for name, picture in pictures.items():
    _, data = cv2.imencode('.png', picture[..., ::-1])
    print(files.replace(folder / name, data.tobytes()))
  return 0


def _envelope(
  folder: pathlib.Path, sweeps: Sequence[str]
) -> list[pathlib.Path]:
  rows = [
    row for name in sweeps for row in case_rows.read_sweep(pathlib.Path(name))
  ]
  folder.mkdir(parents=True, exist_ok=True)
  return figures.draw(envelope.panels(rows), folder)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
