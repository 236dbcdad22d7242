"""Films of dances for the board: encoded as people's recordings are, and read.

Pictures are those of the simulator: codec, size, rate and light differ.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
import hashlib
import importlib.util
import os
import pathlib
import tempfile

import cv2
import numpy as np

from waggle_tasks.experiments.episodes import identity as identity_lib
from waggle_tasks.experiments.episodes import stopwatch, tape
from waggle_tasks.experiments.machine import files
from waggle_tasks.experiments.record import provenance, verdicts
from waggle_tasks.experiments.record import reader as reader_lib
from waggle_tasks.experiments.studies import (
  board_cases,
  board_tiers,
  case_rows,
  sweep_cases,
  sweep_flight,
)
from waggle_tasks.experiments.video import encoders, recordings
from waggle_tasks.protocol import camera

_AFTER_S = 6.0  # Of a film, after the dance: the final null and more.
_REPORT_PICTURES = 50
_ANY = 'klt'  # Whoever reads a dance, it is the same.
_ROOM = 'waggle_tasks.experiments.video.'

Change = Callable[[np.ndarray], np.ndarray]


def _same(image: np.ndarray) -> np.ndarray:
  return image


def _grey(image: np.ndarray) -> np.ndarray:
  return np.repeat(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)[..., None], 3, 2)


def _bright(image: np.ndarray) -> np.ndarray:
  """Half as bright again, white where there is no more."""
  return cv2.convertScaleAbs(image, alpha=1.5)


@dataclasses.dataclass(frozen=True)
class Kind:
  """One kind of film.

  Attributes:
    ending: Of its file, which chooses the codec, see `encoders`.
    scale: Its size by the camera's.
    rate_hz: Pictures a second; None for those of the camera.
    change: What happens to each picture.
  """

  ending: str
  scale: float = 1.0
  rate_hz: float | None = None
  change: Change = _same


KINDS: Mapping[str, Kind] = {
  'vp8': Kind('.webm'),
  'vp8, large': Kind('.webm', 1.5),
  'h264': Kind('.mp4'),
  'h264, small': Kind('.mp4', 0.5),
  'h264, 30 Hz': Kind('.mp4', rate_hz=30.0),
  'h264, 15 Hz': Kind('.mp4', rate_hz=15.0),
  'h264, grey': Kind('.mp4', change=_grey),
  'h264, bright': Kind('.mp4', change=_bright),
}


def can_be_made(
  cases: Sequence[sweep_cases.Sample],
) -> tuple[list[sweep_cases.Sample], list[str]]:
  """The cases of which films can be made here, and what cannot be, and why."""
  films = [c for c in cases if _is_film(c) and missing(c)]
  kept = [case for case in cases if case not in films]
  names = dict.fromkeys(case.cell[board_cases.SCENE] for case in films)
  return kept, [f'{", ".join(names)}: {missing(films[0])}'] if films else []


def _is_film(case: sweep_cases.Sample) -> bool:
  return case.cell[board_cases.TIER] == board_tiers.RECORDINGS


def missing(case: sweep_cases.Sample) -> str:
  """Why the film of a case cannot be made here; empty where it can."""
  kind = KINDS[case.cell[board_cases.SCENE]]
  if kind.ending == '.mp4' and importlib.util.find_spec('av') is None:
    return "films in .mp4 need PyAV: pip install 'waggle-tasks[video]'"
  return ''


class Films:
  """Makes films and reads them, see `board_study.Films`."""

  read: Callable[..., case_rows.SweepRow]

  def __init__(self) -> None:
    """Makes nothing yet."""
    self.read = read

  def sources(self) -> str:
    """A hash of the room that writes and reads films."""
    own = {
      name: value for name, value in provenance.source_hashes().items()
      if name.startswith(_ROOM)
    }  # fmt: skip
    return provenance.source_digest(own)[:16]

  def made(
    self, case: sweep_cases.Sample, folder: pathlib.Path
  ) -> pathlib.Path:
    """The film of a case, made if it is not there.

    Raises:
      VideoError: if it cannot be encoded.
    """
    name = case.cell[board_cases.SCENE]
    text = f'{_flown(case)} {name} {self.sources()}'
    number = hashlib.sha256(text.encode()).hexdigest()[:12]
    stem = name.replace(', ', '-').replace(' ', '-')
    language = case.cell[board_cases.LANGUAGE]
    path = folder / f'{language}-{stem}-{number}{KINDS[name].ending}'
    if not path.exists():
      folder.mkdir(parents=True, exist_ok=True)
      draft = folder / f'.draft-{path.name}'
      _write(draft, case, KINDS[name])
      os.replace(draft, path)
    return path


def _flown(case: sweep_cases.Sample) -> str:
  """What decides the pictures of a case's dance."""
  digest = provenance.source_digest(provenance.deciding_hashes())
  return identity_lib.of(case.scene, _ANY, digest)


def _write(path: pathlib.Path, case: sweep_cases.Sample, kind: Kind) -> None:
  """Flies a dance and films it."""
  seen = tape.record(case.scene, lambda time_s: None)[0]
  last_s = case.scene.performance.end_s + _AFTER_S
  rate_hz = kind.rate_hz or case.scene.rate_hz
  size = case.scene.agreement.camera.size
  width, height = (2 * round(kind.scale * side / 2) for side in size)
  encoder = encoders.make(path, (width, height), rate_hz)
  for image in _at_rate(seen.play(), rate_hz, last_s):
    scaled = cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA)
    encoder.write(np.ascontiguousarray(kind.change(scaled)))
  encoder.close()


def _at_rate(
  stream: tape.Stream, rate_hz: float, last_s: float
) -> Iterator[np.ndarray]:
  """The latest image at each tick, until some time."""
  count, last = 0, None
  for image, time_s in stream:
    while last is not None and count / rate_hz < time_s - 1e-6:
      yield last
      count += 1
    if time_s > last_s:
      return
    last = image.copy()
  if last is not None:
    yield last


def read(
  report: Callable[[float], None],
  case: sweep_cases.Sample,
  identity: str,
  name: str,
  data: bytes,
) -> case_rows.SweepRow:
  """Shows a film to a receiver, as `waggle decode` does; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    identity: See `identity.of`.
    name: Of the film's file.
    data: What it holds.

  Returns:
    The case's row.

  Raises:
    RecordingError: if it cannot be decoded.
  """
  with tempfile.TemporaryDirectory() as home:
    path = pathlib.Path(home, name)
    files.replace(path, data)
    with recordings.Recording(path) as recording:
      work = _reader(case, recording)
      watch = stopwatch.watch(work.receiver)
      work.receiver = watch
      for number, (image, time_s) in enumerate(
        recording.frames(recordings.RecordingPart())
      ):
        work.take(image, time_s)
        if number % _REPORT_PICTURES == 0:
          report(time_s)
  expected, kind = case.scene.payload, case.cell[board_cases.SCENE]
  failures = () if work.message == expected else (
    f'decoding: read {work.message or "nothing"}; film {kind}',
  )  # fmt: skip
  outcome = verdicts.Outcome(
    'observer_1', expected, work.message, failures=failures
  )
  exposure = case_rows.Exposure.of(
    outcome, case.scene.poses()['observer_1'], unauthorised=outcome.wrong,
    events=len(work.events), read_ms=watch.median_ms,
  )  # fmt: skip
  return sweep_flight.told(
    case, case.receiver, identity, 'film', work.last_s, [exposure],
    not failures,
  )  # fmt: skip


def _reader(
  case: sweep_cases.Sample, recording: recordings.Recording
) -> reader_lib.Reader:
  """A receiver that knows the film's camera."""
  agreed = case.scene.agreement
  zoom = recording.height / agreed.camera.rows
  seen = camera.Camera(
    recording.width, recording.height, agreed.camera.focal_px * zoom
  )
  agreed = dataclasses.replace(agreed, camera=seen)
  return reader_lib.Reader(case.receiver, agreed)
