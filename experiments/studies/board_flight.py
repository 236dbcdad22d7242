"""Flies one case of a board and makes its row."""

from collections.abc import Callable
import dataclasses

from waggle_tasks.agents import observer_agent
from waggle_tasks.experiments.episodes import acquired, evaluator, stopwatch
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.studies import (
  case_rows,
  job_progress,
  sweep_cases,
  sweep_flight,
)


def fly(
  report: Callable[[float], None], case: sweep_cases.Sample, identity: str
) -> case_rows.SweepRow:
  """Runs a case; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    identity: See `identity.of`.

  Returns:
    Its row, with what its receivers took and when they held the dancer.
  """
  scene, name = case.scene, case.receiver
  team = observer_agent.Team(scene.observers, name, scene.agreement)
  watches = stopwatch.put(team)
  onlookers = [job_progress.reporter(report)]
  rollout = rollout_lib.run(scene, name, onlookers, team)
  verdict = evaluator.evaluate(scene, rollout)
  row = sweep_flight.row(case, name, identity, rollout, verdict)
  outcomes = tuple(
    dataclasses.replace(
      each,
      read_ms=watch.median_ms,
      acquired_s=acquired.acquired_s(scene, rollout, each.observer),
    )
    for each, watch in zip(row.outcomes, watches, strict=True)
  )
  return dataclasses.replace(row, outcomes=outcomes)
