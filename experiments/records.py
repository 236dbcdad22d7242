"""Run folders: what an episode leaves behind, whole or not at all."""

from collections.abc import Iterator, Mapping
import contextlib
import dataclasses
import enum
import itertools
import json
import os
import pathlib
import shutil
from typing import Any

import numpy as np

from waggle_tasks import errors, scenario
from waggle_tasks.experiments import (
  archive,
  episode,
  files,
  provenance,
  verdicts,
)
from waggle_tasks.experiments import traces as traces_lib
from waggle_tasks.experiments.pages import run_page
from waggle_tasks.protocol import payload


class OutputError(errors.WaggleError):
  """A folder that exists already or cannot be written."""


class TakenError(OutputError):
  """A name that exists, or that somebody else is about to write."""


def to_json(value: object) -> Any:  # noqa: ANN401
  """Turns configurations, events and arrays into what JSON can hold."""
  match value:
    case payload.Payload():
      return value.bits
    case enum.Enum():
      return str(value)
    case np.ndarray() | np.generic():
      return value.tolist()
    case Mapping():
      return {str(key): to_json(each) for key, each in value.items()}
    case list() | tuple():
      return [to_json(each) for each in value]
    case None | str() | bool() | int() | float():
      return value
    case set() | frozenset():
      return sorted((to_json(each) for each in value), key=repr)
    case pathlib.PurePath():
      return str(value)
    case bytes():
      return value.hex()
    case type():
      return value.__qualname__
  if dataclasses.is_dataclass(value):
    fields = {
      field.name: to_json(getattr(value, field.name))
      for field in dataclasses.fields(value)
    }
    return fields
  # Of one's own, such as a layout that is a plain class.
  return {
    'type': getattr(value, '__qualname__', type(value).__qualname__),
    **to_json(getattr(value, '__dict__', {})),
  }


def config(scene: scenario.Scenario, receiver_name: str) -> dict[str, Any]:
  """A run's configuration: every field of its scenario, and its receiver."""
  fields = to_json(scene)
  if not isinstance(scene.layout, str):
    fields['layout'] = {type(scene.layout).__name__: fields['layout']}
  return {'receiver': receiver_name, 'scenario': fields}


def event_lines(rollout: episode.Rollout) -> Iterator[str]:
  """The event log: one JSON object a line, in order of time and observer."""
  rows = [
    (event.time_s, name, event)
    for name, events in rollout.events.items()
    for event in events
  ]
  rows.sort(key=lambda row: row[0])  # Stable: observers keep their order.
  for _, name, event in rows:
    yield event_line(name, event)


def event_line(name: str, event: episode.Event) -> str:
  """An observer's event as a line of the event log."""
  kind = type(event).__name__.lower()
  return dumps({'observer': name, 'kind': kind, **to_json(event)})


def dumps(value: object) -> str:
  """One line of JSON; NaN and infinity are refused."""
  return json.dumps(to_json(value), allow_nan=False)


@contextlib.contextmanager
def new_folder(path: pathlib.Path) -> Iterator[pathlib.Path]:
  """A folder that appears under its name only once it is complete.

  Its name is claimed before the work: of two who ask for it at once, one gets
  it, and the other is refused.

  Args:
    path: Where it should be; its parents are made.

  Yields:
    A hidden folder beside it to write into. It is renamed when the block
    ends, and removed when the block raises.

  Raises:
    OutputError: if `path` exists, is being written or cannot be written.
  """
  check_free(path)
  draft = files.draft_of(path)
  made = [parent for parent in draft.parents if not parent.exists()]
  try:
    with files.claimed(path):
      check_free(path)
      shutil.rmtree(draft, ignore_errors=True)  # Of one that was killed.
      try:
        draft.mkdir()
        yield draft
        os.rename(draft, path)
      finally:
        shutil.rmtree(draft, ignore_errors=True)
  except files.ClaimedError:
    raise TakenError(
      f'`output` must not be in use: another run is writing {path}'
    ) from None
  except BrokenPipeError:  # Of who read what was printed.
    raise
  except OSError as error:
    raise _refused(path, error) from None
  finally:
    for parent in made:  # The innermost first; those in use stay.
      with contextlib.suppress(OSError):
        parent.rmdir()


@contextlib.contextmanager
def next_folder(stem: str) -> Iterator[tuple[pathlib.Path, pathlib.Path]]:
  """The first of runs/STEM-1, runs/STEM-2, ... that nobody has or claims.

  Args:
    stem: How it begins.

  Yields:
    Its draft, as `new_folder` does, and the folder.

  Raises:
    OutputError: if it cannot be written.
  """
  with contextlib.ExitStack() as stack:
    for number in itertools.count(1):
      path = pathlib.Path('runs', f'{stem}-{number}')
      with contextlib.suppress(TakenError):
        draft = stack.enter_context(new_folder(path))
        break
    yield draft, path


@contextlib.contextmanager
def claimed(path: pathlib.Path, field: str) -> Iterator[None]:
  """Keeps the name of a new file until it is written.

  Args:
    path: The file.
    field: The flag that names it.

  Raises:
    OutputError: if it exists, its folder does not, or somebody writes it.
  """
  with contextlib.ExitStack() as stack:
    try:
      if path.absolute().parent.is_dir():
        stack.enter_context(files.claimed(path))
    except files.ClaimedError:
      raise TakenError(
        f'`{field}` must not be in use: another run is writing {path}'
      ) from None
    except OSError as error:
      raise OutputError(
        f'`{field}` must be writable: {path}: {error.strerror}'
      ) from None
    if os.path.lexists(path) or not path.absolute().parent.is_dir():
      raise OutputError(
        f'`{field}` must be a new file in a folder that exists: got'
        f' {str(path)!r}'
      )
    yield


def check_free(path: pathlib.Path) -> None:
  """Refuses an output folder that exists or cannot be made, before work.

  Raises:
    OutputError: naming the folder and the reason.
  """
  if path.name in ('', '..'):
    raise OutputError(f'`output` must end in a name: got {path}')
  if os.path.lexists(path):
    raise TakenError(f'`output` must not exist yet: {path} does')
  check_writable(path)


def check_writable(folder: pathlib.Path) -> None:
  """Refuses a folder that cannot be written, or made, before work.

  Raises:
    OutputError: naming the folder that is in the way.
  """
  there = [folder.absolute(), *folder.absolute().parents]
  first = next(path for path in there if os.path.lexists(path))
  if not first.is_dir() or not os.access(first, os.W_OK | os.X_OK):
    raise OutputError(f'`output` must be writable: {first} is not')


def write_run(
  folder: pathlib.Path,
  scene: scenario.Scenario,
  receiver_name: str,
  rollout: episode.Rollout,
  verdict: verdicts.Verdict,
  origin: provenance.Provenance,
) -> None:
  """Writes the files of a run; all but provenance.json repeat bit for bit."""
  result = {
    'passed': verdict.passed,
    'correct': verdict.correct,
    'simulated_s': round(float(rollout.times_s[-1]), 2),
  }
  texts = {
    'config.json': pretty(config(scene, receiver_name)),
    'events.jsonl': ''.join(f'{line}\n' for line in event_lines(rollout)),
    'result.json': pretty({**result, 'outcomes': verdict.outcomes}),
    'provenance.json': pretty(origin),
  }
  for name, text in texts.items():
    (folder / name).write_text(text, encoding='utf-8')
  traces_lib.save(folder / archive.TRACES, rollout.traces)
  archive.save_positions(folder / archive.POSITIONS, rollout)
  run_page.write(folder)


def pretty(value: object) -> str:
  """A JSON file for people to read."""
  return json.dumps(to_json(value), indent=2, allow_nan=False) + '\n'


def _refused(path: pathlib.Path, error: OSError) -> OutputError:
  return OutputError(f'`output` must be writable: {path}: {error.strerror}')
