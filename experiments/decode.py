"""Reads a dance again: from a run's raw captures, or from any recording.

FOLDER is a run folder made with `waggle broadcast --raw`: every observer's
images go to one receiver or several (--receiver=A --receiver=B), side by side;
exit status 1 when the run's own receiver gives other events than it gave
online, byte for byte. RECORDING is an ordinary video, read by the timestamps of
its container, whatever its size and rate (the extra [video] reads more kinds);
a folder of numbered pictures (PNG, JPEG) with --fps, or of any pictures with
their times in times.csv; the events of an event camera (.aedat4, with the extra
[events]); or a track, where another program saw the target (.csv: time_s, x_px,
y_px). With --camera it is a camera of this machine, until --end or Ctrl-C. A
camera must stand still and begin with the target hovering near the middle, or
at --anchor. Exit status 1 when no message is found, 2 on bad input. See
docs/recordings.md.
"""

from collections.abc import Sequence
import pathlib
import sys

from absl import flags

from waggle_tasks import errors
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import part_flags, receiver_flag
from waggle_tasks.experiments.record import (
  archive,
  capture,
  fitting,
  reader,
)
from waggle_tasks.experiments.video import (
  decoding,
  event_film,
  picture_folder,
  track_file,
)

ARGUMENTS = 'FOLDER|RECORDING'

_RECEIVER = flags.DEFINE_multi_string('receiver', None, '')
# absl adds a sentence to the help of a flag that may be given again.
flags.FLAGS['receiver'].help = (
  "How images are read; may be given again. Unset, the run's own; of a video"
  f" klt, or {receiver_flag.JOINT} for another language than the paper's, or"
  ' view_bank where pauses are short, and for tracks and events.'
  f' {receiver_flag.RULE}'
)
part_flags.define()
_CAMERA = flags.DEFINE_integer(
  'camera', None, 'Number of a camera of this machine, from 0, to read live.'
)
_ANNOTATE = flags.DEFINE_string(
  'annotate', None, 'Video to write that shows what the receiver saw.'
)
_OF_PICTURES = 'roi', 'anchor', 'fps', 'annotate'


class DecodeError(errors.WaggleError):
  """Something to decode, or a choice about it, that is not valid."""


def main(argv: Sequence[str]) -> int:
  """Decodes a run folder or a recording and returns the exit status."""
  if _CAMERA.value is not None:
    if len(argv) != 1:
      raise DecodeError(f'`camera` takes no {ARGUMENTS} beside it: {argv[1:]}')
    return _recording(None)
  if len(argv) != 2:
    raise flags.Error(f'takes one {ARGUMENTS}: got {argv[1:]}')
  path = pathlib.Path(argv[1])
  if path.is_dir() and not picture_folder.found(path):
    return _folder(path)
  if path.suffix.lower() == track_file.SUFFIX:
    return _track(path)
  return _recording(path)


def _folder(folder: pathlib.Path) -> int:
  """Replays every capture of a run."""
  _refuse((*part_flags.NAMES, 'annotate'), 'is about a recording', folder)
  config = archive.read_config(folder / 'config.json')
  agreement, own = config.agreement, config.receiver
  names = list(dict.fromkeys(_RECEIVER.value or [own]))
  status = 0
  for path in capture.paths(folder):
    readers = reader.replay(path, names, agreement)
    images, last_s = readers[0].chain.images, readers[0].last_s
    print(f'{path.stem}: {images} images to {last_s:.2f} s')
    print(reader.report(readers))
    for each in readers:
      said = decoding.said(each)
      if each.name == own:
        other = reader.differences(each, folder, path.stem)
        status = status or int(bool(other))
        said += f'; {other or "the same events as online, byte for byte"}'
      print(f'{each.name}: {said}')
    print()
  return status


def _track(path: pathlib.Path) -> int:
  """Reads what another tracker saw."""
  _refuse(_OF_PICTURES, 'is about pictures', path)
  spoken = part_flags.agreement()
  names = _names(fitting.usual(spoken, 'view_bank'))
  seen = part_flags.camera_of(spoken, *spoken.camera.size)
  found = decoding.track(path, part_flags.part(), names, spoken, seen)
  return _told(found)


def _recording(path: pathlib.Path | None) -> int:
  """Reads pictures: of a file, a folder, or with None of a camera."""
  spoken = part_flags.agreement()
  usual = fitting.usual(spoken)
  if path and path.suffix.lower() == event_film.SUFFIX:
    usual = fitting.of_events(spoken)
  film = None if _ANNOTATE.value is None else pathlib.Path(_ANNOTATE.value)
  with decoding.opened(path, _CAMERA.value, part_flags.fps()) as recording:
    seen = part_flags.camera_of(spoken, recording.width, recording.height)
    found = decoding.pictures(
      recording, part_flags.part(), _names(usual), spoken, seen, film
    )
  return _told(found)


def _names(usual: str) -> list[str]:
  return list(dict.fromkeys(_RECEIVER.value or [usual]))


def _refuse(names: Sequence[str], why: str, path: pathlib.Path) -> None:
  """Refuses flags that say nothing of what is read."""
  for name in names:
    if flags.FLAGS[name].present:
      raise DecodeError(f'`{name}` {why}: {path} is none')


def _told(found: decoding.Decoded) -> int:
  """Prints what was read and returns the exit status."""
  print(found.heading)
  print(reader.report(found.readers))
  for note in found.notes:
    print(note)
  for each in found.readers:
    print(f'{each.name}: {decoding.said(each)}')
  if found.problem:
    raise DecodeError(found.problem)  # Last: what was read is not lost.
  return 0 if all(each.message for each in found.readers) else 1


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
