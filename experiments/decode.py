"""Reads a dance again: from a run's raw captures, or from any video.

FOLDER is a run folder made with `waggle broadcast --raw`: every observer's
images go to one receiver or several (--receiver=A --receiver=B), side by side;
exit status 1 when the run's own receiver gives other events than it gave
online, byte for byte. VIDEO is an ordinary recording, read by the timestamps
of its container, whatever its size and rate, or a folder of numbered pictures
(PNG, JPEG) with --fps: the camera must stand still and begin with the target
hovering near the middle, or at --anchor. The extra [video] reads more kinds of
it. Exit status 1 when no message is found, 2 on bad input.
"""

from collections.abc import Sequence
import contextlib
import dataclasses
import math
import pathlib
import sys
from typing import Any

from absl import flags

from waggle_tasks import errors
from waggle_tasks.agents import receivers
from waggle_tasks.experiments import launch
from waggle_tasks.experiments.flags import config_flag, receiver_flag
from waggle_tasks.experiments.record import (
  archive,
  capture,
  folders,
  reader,
  told,
)
from waggle_tasks.experiments.video import annotated, picture_folder, recordings
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera, checks

ARGUMENTS = 'FOLDER|VIDEO'

_RECEIVER = flags.DEFINE_multi_string('receiver', None, '')
# absl adds a sentence to the help of a flag that may be given again.
flags.FLAGS['receiver'].help = (
  "How images are read; may be given again. Unset, the run's own; of a video"
  f" klt, or {receiver_flag.JOINT} for another language than the paper's."
  f' {receiver_flag.RULE}'
)
_ROI = flags.DEFINE_string(
  'roi', None, 'Part of the picture: left,top,width,height in pixels.'
)
_ANCHOR = flags.DEFINE_string(
  'anchor', None, 'Where the target hovers first: x,y in pixels.'
)
_START = flags.DEFINE_float('start', 0.0, 'First moment, s of the recording.')
_END = flags.DEFINE_float('end', None, 'Last moment, s of the recording.')
_SPEED = flags.DEFINE_float(
  'speed', 1.0, 'Seconds of the dance in a second of the recording.'
)
_FPS = flags.DEFINE_float(
  'fps', None, 'Pictures a second, where pictures have no times of their own.'
)
_FOCAL_PX = flags.DEFINE_float(
  'focal_px', None, 'Focal length of the camera, in pixels.'
)
_FOVY_DEG = flags.DEFINE_float(
  'fovy_deg',
  None,
  'Vertical field of view of the whole picture, in degrees. Unset, and without'
  f' --focal_px, {camera.FOVY_DEG:g}.',
)
_CONFIG = config_flag.define(
  'the dance is in the language that was agreed on there. Unset, in that of the'
  ' paper.'
)
_ANNOTATE = flags.DEFINE_string(
  'annotate', None, 'Video to write that shows what the receiver saw.'
)


class DecodeError(errors.WaggleError):
  """Something to decode, or a choice about it, that is not valid."""


def main(argv: Sequence[str]) -> int:
  """Decodes a run folder or a video and returns the exit status."""
  if len(argv) != 2:
    raise flags.Error(f'takes one {ARGUMENTS}: got {argv[1:]}')
  path = pathlib.Path(argv[1])
  if path.is_dir() and not picture_folder.found(path):
    return _folder(path)
  return _video(path)


def _folder(folder: pathlib.Path) -> int:
  """Replays every capture of a run."""
  given = [
    flag for flag in (_ROI, _ANCHOR, _START, _END, _SPEED, _FPS, _FOCAL_PX,
                      _FOVY_DEG, _CONFIG, _ANNOTATE)
    if flag.present
  ]  # fmt: skip
  if given:
    raise DecodeError(f'`{given[0].name}` is about a video: {folder} is none')
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
      said = _said(each)
      if each.name == own:
        other = reader.differences(each, folder, path.stem)
        status = status or int(bool(other))
        said += f'; {other or "the same events as online, byte for byte"}'
      print(f'{each.name}: {said}')
    print()
  return status


def _video(path: pathlib.Path) -> int:
  """Reads a recording."""
  spoken = _language()
  usual = 'klt' if spoken.language is None else receiver_flag.JOINT
  names = list(dict.fromkeys(_RECEIVER.value or [usual]))
  # Their counts were checked.
  roi: Any = _numbers(_ROI, 4, int)
  anchor: Any = _numbers(_ANCHOR, 2, float)
  part = recordings.RecordingPart(
    _START.value, _END.value, roi, anchor, _SPEED.value
  )
  with contextlib.ExitStack() as stack:
    recording = stack.enter_context(recordings.Recording(path, _FPS.value))
    focal_px = _focal_px(recording.height)
    seen = camera.Camera(recording.width, recording.height, focal_px)
    agreed = dataclasses.replace(spoken, camera=seen)
    readers = [reader.Reader(name, agreed) for name in names]
    film = None
    if _ANNOTATE.value is not None:
      stack.enter_context(
        folders.claimed(pathlib.Path(_ANNOTATE.value), 'annotate')
      )
      film = annotated.AnnotatedFilm(pathlib.Path(_ANNOTATE.value), readers[0])
      stack.enter_context(film)
    for image, time_s in recording.frames(part):
      for each in readers:
        each.take(image, time_s)
      if film:
        film.take(image, time_s)
  print(
    f'{path}: {recording.width} x {recording.height}, focal length'
    f' {focal_px:.0f} px, {readers[0].chain.images} pictures to'
    f' {readers[0].last_s:.2f} s'
  )
  print(reader.report(readers))
  if recording.note:
    print(recording.note)
  gap_s = readers[0].longest_gap_s
  known = [receivers.describe(name, agreed).max_gap_s for name in names]
  if gap_s > min(filter(None, known), default=math.inf) + 1e-6:
    print(f'Pictures are missing: {gap_s:.2f} s lie between two of them.')
  for each in readers:
    print(f'{each.name}: {_said(each)}')
  if film and film.problem:
    raise DecodeError(film.problem)  # Last: what was read is not lost.
  return 0 if all(each.message for each in readers) else 1


def _said(work: reader.Reader) -> str:
  """What a reader made of all images."""
  if work.message is None:
    return 'no message'
  if work.agreement.packets is None:
    return f'message {work.message}'
  return f'message {told.in_full(work.message, work.message)}'


def _language() -> agreement_lib.Agreement:
  """What the dancer and its audience knew."""
  if _CONFIG.value is None:
    return agreement_lib.Agreement()
  return archive.read_config(config_flag.path(_CONFIG.value)).agreement


def _numbers(
  flag: flags.FlagHolder, count: int, kind: type[int] | type[float]
) -> tuple[float, ...] | None:
  """The numbers of a flag such as '10,20', or None when it was not given."""
  if flag.value is None:
    return None
  try:
    numbers = tuple(map(kind, flag.value.split(',')))
  except ValueError:
    numbers = ()
  if len(numbers) != count or not all(map(math.isfinite, numbers)):
    raise DecodeError(
      f'`{flag.name}` must be {count} numbers with commas between them: got'
      f' {flag.value!r}'
    )
  return numbers


def _focal_px(height: int) -> float:
  """The focal length of the flags for a picture of some height."""
  if _FOCAL_PX.value is not None and _FOVY_DEG.value is not None:
    raise DecodeError('`focal_px` and `fovy_deg` say the same: give one')
  if _FOCAL_PX.value is not None:
    checks.number('focal_px', _FOCAL_PX.value, 1.0, 1e5, DecodeError)
    return _FOCAL_PX.value
  fovy_deg = camera.FOVY_DEG if _FOVY_DEG.value is None else _FOVY_DEG.value
  checks.number('fovy_deg', fovy_deg, 1.0, 170.0, DecodeError)
  return camera.focal_length_px(height, fovy_deg)


if __name__ == '__main__':
  sys.exit(launch.run(__name__))
