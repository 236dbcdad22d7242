"""Reads run folders back: everything that a run has left behind."""

from collections.abc import Sequence
import dataclasses
import json
import pathlib
import typing
from typing import Any, TypeVar
import zipfile

import numpy as np

from waggle_tasks import errors, plain, scenario
from waggle_tasks.experiments.record import encoding, episode, moves, verdicts
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import controls, payload

TRACES, POSITIONS = 'traces.npz', 'positions.npz'
PAGE = 'index.html'  # Of any folder: made from the data beside it.

_Value = TypeVar('_Value')


class ArchiveError(errors.WaggleError):
  """A run folder that is not one, or whose files are damaged."""


@dataclasses.dataclass(frozen=True)
class Flown:
  """What was flown, as config.json has it.

  Attributes:
    receiver: How observers read.
    scenario: The scenario as plain data: its layout may be of a class that
      this machine does not have.
    agreement: What both sides knew.
  """

  receiver: str
  scenario: dict[str, Any]
  agreement: agreement_lib.Agreement


@dataclasses.dataclass(frozen=True)
class Result:
  """What came out, as result.json has it.

  Attributes:
    passed: Whether no check of any observer failed.
    correct: How many observers read what was sent to them.
    simulated_s: How long the episode was.
    outcomes: One for each observer.
  """

  passed: bool
  correct: int
  simulated_s: float
  outcomes: tuple[verdicts.Outcome, ...]


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
  config: Flown
  result: Result
  provenance: dict
  events: dict[str, tuple[episode.Event, ...]]
  traces: dict[str, traces_lib.Trace]
  times_s: np.ndarray
  positions_m: dict[str, np.ndarray]

  @property
  def scenario(self) -> dict:
    """The fields of the scenario."""
    return self.config.scenario

  @property
  def sent(self) -> tuple[moves.Sent, ...]:
    """What the performer flew."""
    scene = self.scenario
    bits = payload.Payload.from_bits(
      scene['payload'], payload.Units(**scene['units'])
    )
    performance = controls.perform(
      scene['control'], bits, scene['seed'], self.config.agreement,
      scene['stop_s'], scene.get('bits', ''), scene.get('repeat', 1),
    )  # fmt: skip
    return moves.sent(performance, self.config.agreement, self.end_s)

  @property
  def end_s(self) -> float:
    """When the episode ended."""
    return float(self.times_s[-1])


def load(folder: pathlib.Path) -> Run:
  """Reads a run folder.

  Raises:
    ArchiveError: naming the file that is missing or damaged.
    FormatError: if a newer program wrote it.
    TraceError: as ArchiveError, of the traces.
  """
  config = read_config(folder / 'config.json')
  result = read_result(folder / 'result.json')
  names = [each.observer for each in result.outcomes]
  positions_m = _positions(folder / POSITIONS)
  return Run(
    folder,
    config,
    result,
    read_json(folder / 'provenance.json'),
    read_events(folder / 'events.jsonl', names),
    traces_lib.load(folder / TRACES),
    positions_m.pop('times_s'),
    positions_m,
  )


def read_json(path: pathlib.Path) -> dict[str, Any]:
  """Reads a JSON object, without its format.

  Raises:
    ArchiveError: if there is none.
    FormatError: if a newer program wrote it.
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
  return encoding.unstamped(value, path)


def read_rows(path: pathlib.Path, kind: type[_Value]) -> list[_Value]:
  """Reads lines of results, as many as there are.

  Raises:
    ArchiveError: if there is no file, or a line is damaged.
    FormatError: if a newer program wrote one.
  """
  try:
    lines = path.read_text(encoding='utf-8').splitlines()
    tables = [json.loads(line) for line in lines]
  except (OSError, ValueError) as error:
    raise ArchiveError(f'{path} cannot be read: {error}') from None
  return rows(tables, kind, path)


def rows(
  tables: Sequence[Any], kind: type[_Value], path: pathlib.Path
) -> list[_Value]:
  """Makes rows of a file of the plain data of its lines.

  Raises:
    ArchiveError: naming the line and what is wrong with it.
    FormatError: if a newer program wrote one.
  """
  out = []
  for number, table in enumerate(tables, 1):
    place = f'{path}, line {number},'
    if isinstance(table, dict):
      table = encoding.unstamped(table, place)
    out.append(made(kind, table, place, 'row'))
  return out


def read_config(path: pathlib.Path) -> Flown:
  """Reads what was flown in a run.

  Args:
    path: Its config.json.

  Raises:
    ArchiveError: if there is none, or it is damaged.
    FormatError: if a newer program wrote it.
  """
  table = read_json(path)
  scene = table.get('scenario')
  if isinstance(scene, dict):  # An older program knew fewer fields.
    table['scenario'] = {**plain.to_plain(scenario.Scenario()), **scene}
  if 'agreement' not in table and isinstance(scene, dict):
    # Of the oldest format: the scenario had all of it, by the same names.
    names = [
      field.name for field in dataclasses.fields(agreement_lib.Agreement)
    ]
    table['agreement'] = {
      name: value for name, value in scene.items()
      if name in names and isinstance(value, dict)
    }  # fmt: skip
  return made(Flown, table, path)


def read_result(path: pathlib.Path) -> Result:
  """Reads what came out of a run, its result.json; see `read_config`."""
  return made(Result, read_json(path), path)


def read_scenario(path: pathlib.Path) -> scenario.Scenario:
  """Reads the scenario of a run, to fly it again.

  Args:
    path: Its config.json.

  Raises:
    ArchiveError: if there is none, or it cannot be made here.
    FormatError: if a newer program wrote it.
  """
  fields = read_config(path).scenario
  return made(scenario.Scenario, fields, path, 'scenario')


def made(
  kind: type[_Value], table: object, place: object, name: str = ''
) -> _Value:
  """A value of plain data from a file; an ArchiveError if damaged."""
  try:
    return plain.from_plain(kind, table, name)
  except plain.UnknownFieldError as error:
    raise ArchiveError(
      f'{place} holds what this program does not know; a newer one may have'
      f' written it: {error}'
    ) from None
  except errors.WaggleError as error:
    raise ArchiveError(f'{place} is damaged: {error}') from None


def read_events(
  path: pathlib.Path, names: Sequence[str]
) -> dict[str, tuple[episode.Event, ...]]:
  """Reads an event log.

  Args:
    path: events.jsonl.
    names: The observers, also those without events.

  Raises:
    ArchiveError: naming the line that is damaged.
  """
  events: dict[str, list[episode.Event]] = {name: [] for name in names}
  try:
    lines = path.read_text(encoding='utf-8').splitlines()
  except (OSError, ValueError) as error:
    raise ArchiveError(f'{path} cannot be read: {error}') from None
  for number, line in enumerate(lines, 1):
    place = f'{path}, line {number},'
    try:
      row = json.loads(line)
      own, kind = events[row.pop('observer')], row.pop('kind')
    except (ValueError, KeyError, TypeError, AttributeError) as error:
      raise ArchiveError(f'{place} is damaged: {error!r}') from None
    if not isinstance(kind, str) or kind not in _EVENTS:
      raise ArchiveError(
        f'{place} holds what this program does not know; a newer one may have'
        f' written it: `kind` must be one of {[*_EVENTS]}: got {kind!r}'
      )
    own.append(made(_EVENTS[kind], row, place, kind))
  return {name: tuple(each) for name, each in events.items()}


# By the `kind` of a line, see `writer.event_lines`.
_EVENTS: dict[str, type[episode.Event]] = {
  each.__name__.lower(): each for each in typing.get_args(episode.Event)
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
