"""What an episode leaves behind, as the files of a run folder."""

from collections.abc import Callable, Iterator
import pathlib
from typing import Any

from waggle_tasks import plain, scenario
from waggle_tasks.experiments.record import (
  archive,
  encoding,
  episode,
  flown,
  provenance,
  verdicts,
)
from waggle_tasks.experiments.record import traces as traces_lib

Page = Callable[[pathlib.Path], object]  # Makes the page of a run folder.


def config(scene: scenario.Scenario, receiver_name: str) -> dict[str, Any]:
  """A run's configuration: every field of its scenario, and its receiver."""
  fields = plain.to_plain(scene)
  return encoding.stamped(archive.Flown(receiver_name, fields, scene.agreement))


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
  return encoding.dumps(
    {'observer': name, 'kind': kind, **plain.to_plain(event)}
  )


def write_run(
  folder: pathlib.Path,
  scene: scenario.Scenario,
  receiver_name: str,
  rollout: episode.Rollout,
  verdict: verdicts.Verdict,
  origin: provenance.Provenance,
) -> None:
  """Writes the files of a run; all but provenance.json repeat bit for bit."""
  simulated_s = round(float(rollout.times_s[-1]), 3)
  result = archive.Result(
    verdict.passed, verdict.correct, simulated_s, verdict.outcomes
  )
  texts = {
    'config.json': encoding.pretty(config(scene, receiver_name)),
    'events.jsonl': ''.join(f'{line}\n' for line in event_lines(rollout)),
    'result.json': encoding.pretty(encoding.stamped(result)),
    'provenance.json': encoding.pretty(encoding.stamped(origin)),
  }
  for name, text in texts.items():
    (folder / name).write_text(text, encoding='utf-8')
  traces_lib.save(folder / archive.TRACES, rollout.traces)
  archive.save_positions(folder / archive.POSITIONS, rollout)
  if rollout.flights:
    flown.save(folder / flown.NAME, rollout.flights)
