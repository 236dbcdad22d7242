"""Flies one case of a sweep and makes its row."""

from collections.abc import Callable, Sequence
from typing import Any

from waggle_tasks import fidelity
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.episodes import evaluator, low_level
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import episode, verdicts
from waggle_tasks.experiments.studies import (
  case_rows,
  job_progress,
  replay_flight,
  sweep_cases,
)


def fly(
  report: Callable[[float], None],
  case: sweep_cases.Sample,
  receiver_name: str,
  identity: str,
  replays: int,
) -> case_rows.SweepRow:
  """Runs a case; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    receiver_name: The receiver.
    identity: See `identity.of`.
    replays: How many times the images are shown again, see `replay_flight`;
      0 to fly with receivers.

  Returns:
    Its row.
  """
  if replays:
    shown = replay_flight.fly(case.scene, receiver_name, replays, report)
    passed = all(each.right for each in shown[-1])
    return told(case, receiver_name, identity, *shown, passed)
  if case.scene.fidelity != fidelity.PIXELS:
    return _without_pictures(case, receiver_name, identity)
  onlookers = [job_progress.reporter(report)]
  rollout = rollout_lib.run(case.scene, receiver_name, onlookers)
  verdict = evaluator.evaluate(case.scene, rollout)
  return row(case, receiver_name, identity, rollout, verdict)


def _without_pictures(
  case: sweep_cases.Sample, receiver_name: str, identity: str
) -> case_rows.SweepRow:
  """A row of a level of fidelity on which nothing is flown."""
  verdict, events = low_level.run(case.scene, receiver_name)
  poses = case.scene.poses()
  exposures = [
    case_rows.Exposure.of(each, poses[each.observer], **_reading(seen))
    for each, seen in zip(verdict.outcomes, events, strict=True)
  ]
  return told(
    case, receiver_name, identity, low_level.RENDERER, case.scene.episode_s,
    exposures, verdict.passed,
  )  # fmt: skip


def row(
  case: sweep_cases.Sample,
  receiver_name: str,
  identity: str,
  rollout: episode.Rollout,
  verdict: verdicts.Verdict,
) -> case_rows.SweepRow:
  """A case's row, from its episode."""
  poses = case.scene.poses()
  exposures = [
    case_rows.Exposure.of(
      each, poses[each.observer], **_reading(rollout.events[each.observer])
    )
    for each in verdict.outcomes
  ]
  return told(
    case, receiver_name, identity, rollout.renderer, rollout.times_s[-1],
    exposures, verdict.passed,
  )  # fmt: skip


def told(
  case: sweep_cases.Sample,
  receiver_name: str,
  identity: str,
  renderer: str,
  simulated_s: float,
  exposures: Sequence[case_rows.Exposure],
  passed: bool,
) -> case_rows.SweepRow:
  """A case's row, from what became of its observers.

  Args:
    case: The case.
    receiver_name: The receiver.
    identity: See `identity.of`.
    renderer: The GL renderer.
    simulated_s: How long the episode was.
    exposures: What became of each observer, or replay.
    passed: Whether no check of any observer failed.
  """
  return case_rows.SweepRow(
    case=case.name,
    cell=dict(case.cell),
    repeat=case.repeat,
    identity=identity,
    receiver=receiver_name,
    renderer=renderer,
    simulated_s=round(float(simulated_s), 3),
    passed=passed,
    outcomes=tuple(exposures),
    scenario=dict(case.values),
  )


def _reading(events: Sequence[episode.Event]) -> dict[str, Any]:
  """How much it saw, and from where it believes that it saw its message."""
  seen = [event for event in events if isinstance(event, receiver.Event)]
  message = next((event for event in seen if event.message), None)
  return {
    'events': len(seen),
    'seen_angle_deg': message and message.view_angle_deg,
    'seen_distance_m': message and message.distance_m,
  }
