"""Whether receivers see the same events with either camera."""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import itertools

import cv2

from waggle_tasks import suites
from waggle_tasks.entities import optics
from waggle_tasks.experiments.bench_parts import loops
from waggle_tasks.experiments.episodes import rollout
from waggle_tasks.experiments.machine import table
from waggle_tasks.experiments.record import writer
from waggle_tasks.experiments.studies import job_progress, pool


@dataclasses.dataclass(frozen=True)
class Logs:
  """The event logs of one case with either camera.

  Attributes:
    case: Its name.
    events: How many events it has with the incremental camera.
    difference: The first line of the event log that differs, in both; None
      when the logs are equal.
  """

  case: str
  events: int
  difference: tuple[str, str] | None


def compare(cases: Sequence[suites.Case], workers: int) -> Iterator[Logs]:
  """Runs cases with either camera, behind a bar of simulated seconds.

  The provenance of a message is part of its event: equal logs also mean that
  every picture before it was equal, bit for bit.

  Args:
    cases: The cases.
    workers: How many processes.

  Yields:
    The logs of each case when it is over.
  """
  jobs = [
    pool.Job(f'{case.name} {camera}', _fly, (case, camera))
    for case in cases
    for camera in optics.CAMERAS
  ]
  logs: dict[str, dict[str, list[str]]] = {case.name: {} for case in cases}
  lengths_s = {job.name: job.arguments[0].scene.episode_s for job in jobs}
  news = pool.run(jobs, workers)
  for done in job_progress.shown(news, lengths_s, lambda *_: 'events'):
    case, camera = done.job.arguments
    found = logs[case.name]
    found[camera] = done.value
    if len(found) == len(optics.CAMERAS):
      one, other = (found[camera] for camera in optics.CAMERAS)
      yield Logs(case.name, len(one), difference(one, other))


def report(found: Sequence[Logs]) -> str:
  """Whether logs are equal, case by case."""
  rows = [
    (each.case, str(each.events), 'differ' if each.difference else 'equal')
    for each in found
  ]
  lines = [table.render(('case', 'events', 'event logs'), rows), '']
  for each in found:
    if each.difference:
      one, other = (line or 'nothing' for line in each.difference)
      lines += [
        f'{each.case}, incremental: {one}',
        f'{each.case}, full: {other}',
      ]
  equal = sum(each.difference is None for each in found)
  lines.append(f'{equal} of {len(found)} event logs are equal.')
  return '\n'.join(lines)


def difference(
  one: Sequence[str], other: Sequence[str]
) -> tuple[str, str] | None:
  """The first pair of lines that differ; a line that is missing is empty."""
  pairs = itertools.zip_longest(one, other, fillvalue='')
  return next((pair for pair in pairs if pair[0] != pair[1]), None)


def _fly(
  report: Callable[[float], None], case: suites.Case, camera: str
) -> list[str]:
  """The event log of a case; called in a worker."""
  cv2.setNumThreads(1)  # Workers share the cores.
  scene = dataclasses.replace(case.scene, camera=camera)
  onlookers = [job_progress.reporter(report)]
  return list(writer.event_lines(rollout.run(scene, loops.RECEIVER, onlookers)))
