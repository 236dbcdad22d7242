"""Reads run folders back: everything that a run has left behind."""

from collections.abc import Callable, Mapping
import dataclasses
import json
import pathlib
from typing import Any
import zipfile

import numpy as np

from waggle_tasks import errors
from waggle_tasks.agents import observer_agent, receiver, recogniser
from waggle_tasks.experiments.record import episode, story
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import (
  camera,
  clock,
  controls,
  frame,
  gestures,
  payload,
  timing,
)
from waggle_tasks.protocol.symbols import Symbol
from waggle_tasks.tasks import safety

TRACES, POSITIONS = 'traces.npz', 'positions.npz'
PAGE = 'index.html'  # Of any folder: made from the data beside it.


class ArchiveError(errors.WaggleError):
  """A run folder that is not one, or whose files are damaged."""


@dataclasses.dataclass(frozen=True, eq=False)
class Run:
  """A run as it was left behind.

  Attributes:
    folder: Where.
    config: config.json.
    result: result.json.
    provenance: provenance.json.
    events: By observer name, as in `episode.Rollout`.
    traces: By observer name, as in `episode.Rollout`.
    times_s: (T,) one time for each frame.
    positions_m: By vehicle name, (T, 3) true positions.
  """

  folder: pathlib.Path
  config: dict
  result: dict
  provenance: dict
  events: dict[str, tuple[episode.Event, ...]]
  traces: dict[str, traces_lib.Trace]
  times_s: np.ndarray
  positions_m: dict[str, np.ndarray]

  @property
  def scenario(self) -> dict:
    """The fields of the scenario."""
    return self.config['scenario']

  @property
  def agreement(self) -> agreement_lib.Agreement:
    """What both sides knew."""
    return read_agreement(self.config)

  @property
  def sent(self) -> tuple[story.Sent, ...]:
    """What the performer flew."""
    scene = self.scenario
    bits = payload.Payload.from_bits(
      scene['payload'], payload.Units(**scene['units'])
    )
    known = self.agreement
    performance = controls.perform(
      scene['control'], bits, scene['seed'], known.codebook, known.pauses,
      scene['stop_s'],
    )  # fmt: skip
    return story.sent(performance, self.end_s)

  @property
  def end_s(self) -> float:
    """When the episode ended."""
    return float(self.times_s[-1])


def load(folder: pathlib.Path) -> Run:
  """Reads a run folder.

  Raises:
    ArchiveError: naming the file that is missing or damaged.
    TraceError: the same, of the traces.
  """
  config = read_json(folder / 'config.json')
  result = read_json(folder / 'result.json')
  names = [each['observer'] for each in result['outcomes']]
  positions_m = _positions(folder / POSITIONS)
  return Run(
    folder,
    config,
    result,
    read_json(folder / 'provenance.json'),
    read_events(folder / 'events.jsonl', names, read_agreement(config).units),
    traces_lib.load(folder / TRACES),
    positions_m.pop('times_s'),
    positions_m,
  )


def read_json(path: pathlib.Path) -> dict:
  """Reads a JSON object.

  Raises:
    ArchiveError: if there is none.
  """
  try:
    value = json.loads(path.read_text(encoding='utf-8'))
  except FileNotFoundError:
    raise ArchiveError(
      f'{path.parent} is not a run folder: it has no {path.name}'
    ) from None
  except (OSError, ValueError) as error:
    raise ArchiveError(f'{path} cannot be read: {error}') from None
  if not isinstance(value, dict):
    raise ArchiveError(f'{path} must hold a JSON object')
  return value


def read_agreement(config: Mapping) -> agreement_lib.Agreement:
  """What both sides know, by a run's configuration."""
  scene = config['scenario']
  codebook = gestures.Codebook(
    tuple(
      gestures.Gesture(
        Symbol(each['symbol']),
        tuple(map(tuple, each['corners_m'])),
        each['duration_s'],
      )
      for each in scene['codebook']['gestures']
    )
  )
  pauses, units = (
    timing.Timing(**scene['pauses']),
    payload.Units(**scene['units']),
  )
  tolerance = clock.Tolerance(**scene['tolerance'])
  # A run of before these could be chosen had what is the default now.
  usual = agreement_lib.Agreement
  seen = camera.Camera.of(
    scene.get('camera_width_px', camera.Camera.columns),
    scene.get('camera_height_px', camera.Camera.rows),
    scene.get('camera_fovy_deg', camera.FOVY_DEG),
  )
  return agreement_lib.Agreement(
    codebook, pauses, tolerance, units, seen,
    scene.get('rate_hz', usual.rate_hz),
    scene.get('hover_height_m', usual.hover_height_m),
  )  # fmt: skip


def read_events(
  path: pathlib.Path,
  names: list[str],
  units: payload.Units = payload.Units(),
) -> dict[str, tuple[episode.Event, ...]]:
  """Reads an event log.

  Args:
    path: events.jsonl.
    names: The observers, also those without events.
    units: The agreed fields of the payload.

  Raises:
    ArchiveError: naming the line that is damaged.
  """
  events: dict[str, list[episode.Event]] = {name: [] for name in names}
  try:
    lines = path.read_text(encoding='utf-8').splitlines()
  except OSError as error:
    raise ArchiveError(f'{path} cannot be read: {error.strerror}') from None
  for number, line in enumerate(lines, 1):
    try:
      row = json.loads(line)
      make = _MAKERS[row.pop('kind')]
      events[row.pop('observer')].append(make(row, units))
    except (ValueError, KeyError, TypeError) as error:
      raise ArchiveError(
        f'{path} is damaged in line {number}: {error}'
      ) from None
  return {name: tuple(each) for name, each in events.items()}


def _event(row: dict[str, Any], units: payload.Units) -> receiver.Event:
  row['symbol'], row['state'] = Symbol(row['symbol']), frame.State(row['state'])
  if row['message'] is not None:
    row['message'] = payload.Payload.from_bits(row['message'], units)
  if row['recognition'] is not None:
    scores = dict(row['recognition'])
    for field in ('symbol', 'best'):
      scores[field] = Symbol(scores[field])
    row['recognition'] = recogniser.Recognition(**scores)
  return receiver.Event(**row)


def _navigation(
  row: dict[str, Any], units: payload.Units
) -> observer_agent.Navigation:
  row['deed'] = observer_agent.Deed(row['deed'])
  row['target_m'] = tuple(row['target_m'])
  row['payload'] = payload.Payload.from_bits(row['payload'], units)
  return observer_agent.Navigation(**row)


# By the `kind` of a line, see `writer.event_lines`.
_MAKERS: dict[str, Callable[[dict[str, Any], payload.Units], episode.Event]] = {
  'event': _event,
  'navigation': _navigation,
  'refusal': lambda row, _: safety.Refusal(**row),
}


def save_positions(path: pathlib.Path, rollout: episode.Rollout) -> None:
  """Writes every vehicle's way; equal ways give equal bytes."""
  arrays: dict[str, Any] = {'times_s': rollout.times_s, **rollout.positions_m}
  np.savez_compressed(path, **arrays)


def _positions(path: pathlib.Path) -> dict[str, np.ndarray]:
  try:
    with path.open('rb') as file, np.load(file, allow_pickle=False) as arrays:
      return dict(arrays)
  except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
    raise ArchiveError(f'{path} must be a file of positions: {error}') from None
