"""What receivers saw, frame by frame: the evidence behind their events."""

from collections.abc import Mapping, Sequence
import dataclasses
import math
import pathlib
from typing import Any
import zipfile

import numpy as np

from waggle_tasks import errors
from waggle_tasks.agents import klt, observer_agent, segmenter


class TraceError(errors.WaggleError):
  """A file of traces that cannot be read."""


@dataclasses.dataclass(frozen=True, eq=False)
class TracedMotion:
  """One motion as a receiver cut it out of its track.

  Attributes:
    confirmed_s: Time of the event that it became.
    begin_s: When it began.
    end_s: When it came to rest.
    path_px: (K, 2) the track in between, x right and y down.
    width_px: How wide the target is, where the tracker knows.
  """

  confirmed_s: float
  begin_s: float
  end_s: float
  path_px: np.ndarray
  width_px: float | None = None


@dataclasses.dataclass(frozen=True, eq=False)
class Trace:
  """What one receiver saw in each of the T images that it took.

  Attributes:
    times_s: (T,) times of the images.
    centre_px: (T, 2) the target, x right and y down.
    speed_px_s: (T,) its image speed.
    support: (T,) features that survived the checks.
    quality: (T,) their share of those that were followed.
    valid: (T,) whether the support was enough.
    motions: What was cut out, in order.
  """

  times_s: np.ndarray
  centre_px: np.ndarray
  speed_px_s: np.ndarray
  support: np.ndarray
  quality: np.ndarray
  valid: np.ndarray
  motions: tuple[TracedMotion, ...] = ()

  @classmethod
  def of(
    cls, tracks: Sequence[klt.Track], motions: Sequence[TracedMotion]
  ) -> 'Trace':
    """The trace of a receiver's tracks, one for each image."""
    rows = [
      (t.time_s, *t.centre_px, t.speed_px_s, t.support, t.quality, t.valid)
      for t in tracks
    ]
    table = np.array(rows, float).reshape(-1, 7).T
    return cls(
      table[0], table[1:3].T, table[3], table[4], table[5],
      table[6].astype(bool), tuple(motions),
    )  # fmt: skip


class Tracer:
  """Notes the tracks of a team while it works."""

  def __init__(self, count: int) -> None:
    """Makes a tracer.

    Args:
      count: How many agents the team has.
    """
    self._tracks: list[list[klt.Track]] = [[] for _ in range(count)]
    self._motions: list[list[TracedMotion]] = [[] for _ in range(count)]
    self._noted_s = [-math.inf] * count

  def note(self, team: observer_agent.Team) -> None:
    """Takes what each receiver saw in this frame, if it took an image."""
    for number, (tracks, motions, agent) in enumerate(
      zip(self._tracks, self._motions, team.agents, strict=True)
    ):
      if not agent.read_s > self._noted_s[number]:
        continue  # While it navigates, an agent reads no more.
      self._noted_s[number] = agent.read_s
      track, segment = agent.receiver.track, agent.receiver.segment
      if track is not None:
        tracks.append(track)
      if segment is not None:
        motions.append(_motion(agent.read_s, segment))

  def traces(self) -> tuple[Trace, ...]:
    """The traces so far, in the order of the team's agents."""
    return tuple(map(Trace.of, self._tracks, self._motions))


def _motion(confirmed_s: float, segment: segmenter.Segment) -> TracedMotion:
  return TracedMotion(
    confirmed_s, segment.begin_s, segment.end_s, segment.path_px,
    segment.width_px,
  )  # fmt: skip


def save(path: pathlib.Path, traces: Mapping[str, Trace]) -> None:
  """Writes traces by observer name; equal traces give equal bytes."""
  arrays = {}
  for name, trace in traces.items():
    for field in dataclasses.fields(Trace)[:-1]:
      arrays[f'{name}.{field.name}'] = getattr(trace, field.name)
    motions = trace.motions
    arrays[f'{name}.motion_s'] = np.array(
      [(m.confirmed_s, m.begin_s, m.end_s) for m in motions]
    ).reshape(-1, 3)
    widths_px = [m.width_px for m in motions]
    arrays[f'{name}.motion_width_px'] = np.array(widths_px, float)  # Or NaN.
    lengths = [len(m.path_px) for m in motions]
    arrays[f'{name}.motion_lengths'] = np.array(lengths, int)
    arrays[f'{name}.motion_px'] = np.concatenate(
      [np.empty((0, 2)), *(m.path_px for m in motions)]
    )
  np.savez_compressed(path, **arrays)


def load(path: pathlib.Path) -> dict[str, Trace]:
  """Reads what `save` wrote.

  Raises:
    TraceError: if the file is missing, damaged or something else.
  """
  try:
    with path.open('rb') as file, np.load(file, allow_pickle=False) as opened:
      arrays = dict(opened)
    names = dict.fromkeys(key.rpartition('.')[0] for key in arrays)
    return {name: _read(arrays, name) for name in names}
  except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
    raise TraceError(f'{path} must be a file of traces: {error}') from None


def _read(arrays: Mapping[str, np.ndarray], name: str) -> Trace:
  fields = [field.name for field in dataclasses.fields(Trace)[:-1]]
  ends = np.cumsum(arrays[f'{name}.motion_lengths'])
  paths_px = np.split(arrays[f'{name}.motion_px'], ends)[:-1]
  motions = [
    TracedMotion(
      float(confirmed_s), float(begin_s), float(end_s), path_px,
      None if np.isnan(width_px) else float(width_px),
    )
    for (confirmed_s, begin_s, end_s), path_px, width_px in zip(
      arrays[f'{name}.motion_s'], paths_px,
      arrays[f'{name}.motion_width_px'], strict=True,
    )
  ]  # fmt: skip
  values: dict[str, Any] = {f: arrays[f'{name}.{f}'] for f in fields}
  return Trace(**values, motions=tuple(motions))
