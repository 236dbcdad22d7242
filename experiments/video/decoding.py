"""Receivers at work on a recording: pictures, a camera, or a track."""

from collections.abc import Sequence
import contextlib
import dataclasses
import math
import pathlib

from waggle_tasks.agents import receivers, tracks
from waggle_tasks.experiments.record import folders, reader, told
from waggle_tasks.experiments.video import (
  annotated,
  live_camera,
  recordings,
  rests,
  track_file,
)
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera as camera_lib


@dataclasses.dataclass(frozen=True)
class Decoded:
  """What was read, and what people should know of it.

  Attributes:
    heading: What it was read from.
    readers: The receivers, with all that they confirmed.
    notes: What should be said of the recording.
    problem: Why the annotated film is none; empty when it is, or was not asked.
  """

  heading: str
  readers: tuple[reader.Reader, ...]
  notes: tuple[str, ...] = ()
  problem: str = ''


def opened(
  path: pathlib.Path | None, camera: int | None, fps: float | None
) -> recordings.Recording:
  """Opens a recording, or without a path a camera of this machine.

  Raises:
    RecordingError: if there is none that can be read.
  """
  if path is not None:
    return recordings.Recording(path, fps)
  if fps is not None:
    raise recordings.RecordingError(
      '`fps` must not be given of a camera, whose pictures come with the time'
    )
  source = live_camera.LiveCamera(camera or 0)
  return recordings.Recording(pathlib.Path(f'camera {camera}'), None, source)


def pictures(
  recording: recordings.Recording,
  part: recordings.RecordingPart,
  names: Sequence[str],
  spoken: agreement_lib.Agreement,
  seen: camera_lib.Camera,
  annotate: pathlib.Path | None = None,
) -> Decoded:
  """Shows a recording to receivers; of a camera, until Ctrl-C.

  Args:
    recording: It.
    part: What is read of it.
    names: The receivers.
    spoken: What both sides know...
    seen: ...but for the camera.
    annotate: Where a film goes that shows what the first receiver saw.

  Raises:
    WaggleError: if a receiver is not known, or the recording cannot be read.
  """
  agreed = dataclasses.replace(spoken, camera=seen)
  readers = tuple(reader.Reader(name, agreed) for name in names)
  still, notes, film = rests.Rests(), [], None
  if recording.live and part.end_s is None:
    part = dataclasses.replace(
      part, end_s=part.start_s + recordings.MAX_LENGTH_S
    )
  with contextlib.ExitStack() as stack:
    if annotate is not None:
      stack.enter_context(folders.claimed(annotate, 'annotate'))
      film = annotated.AnnotatedFilm(annotate, readers[0])
      stack.enter_context(film)
    try:
      for image, time_s in recording.frames(part):
        still.picture(image, time_s)
        for each in readers:
          each.take(image, time_s)
        if film:
          film.take(image, time_s)
    except KeyboardInterrupt:
      if not recording.live:
        raise
      notes.append('Interrupted: this is what was read until then.')
  heading = (
    f'{recording.name}: {recording.width} x {recording.height}, focal length'
    f' {seen.focal_px:.0f} px, {readers[0].chain.images} pictures to'
    f' {readers[0].last_s:.2f} s'
  )
  if recording.note:
    notes.append(recording.note)
  gap_s = readers[0].longest_gap_s
  known = [receivers.describe(name, agreed).max_gap_s for name in names]
  if gap_s > min(filter(None, known), default=math.inf) + 1e-6:
    notes.append(
      f'Pictures are missing: {gap_s:.2f} s lie between two of them.'
    )
  notes += _unread(readers, still, 'film')
  return Decoded(
    heading, readers, tuple(notes), (film.problem or '') if film else ''
  )


def track(
  path: pathlib.Path,
  part: recordings.RecordingPart,
  names: Sequence[str],
  spoken: agreement_lib.Agreement,
  seen: camera_lib.Camera,
) -> Decoded:
  """Shows a track to the stages of receivers that need no pictures.

  Args:
    path: The file.
    part: What is read of it.
    names: The receivers, of `tracks.READERS`.
    spoken: What both sides know...
    seen: ...but for the camera.

  Raises:
    WaggleError: if a receiver reads no tracks, or the file is none.
  """
  agreed = dataclasses.replace(spoken, camera=seen)
  readers = tuple(reader.Reader(name, agreed, tracks.make) for name in names)
  file, still = track_file.TrackFile(path, seen.focal_px), rests.Rests()
  for place, time_s in file.places(part):
    still.place(place, time_s, seen.zoom)
    for each in readers:
      each.take(place, time_s)
  heading = (
    f'{path}: {readers[0].chain.images} places to {readers[0].last_s:.2f} s,'
    f' focal length {seen.focal_px:.0f} px, the target seen in'
    f' {100 * file.seen:.1f} %'
  )
  return Decoded(heading, readers, tuple(_unread(readers, still, 'track')))


def _unread(
  readers: Sequence[reader.Reader], still: rests.Rests, what: str
) -> list[str]:
  """Why nothing could be read, of those who read nothing."""
  reasons = [
    still.reason(what, rests.need_s(each.name, each.agreement))
    for each in readers
    if each.message is None
  ]
  return [f'Note: {why}.' for why in dict.fromkeys(filter(None, reasons))]


def said(work: reader.Reader) -> str:
  """What a reader made of all it saw."""
  if work.message is None:
    return 'no message'
  if work.agreement.packets is None:
    return f'message {work.message}'
  return f'message {told.in_full(work.message, work.message)}'
