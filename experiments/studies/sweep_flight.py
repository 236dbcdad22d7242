"""Flies one case of a sweep and makes its row."""

from collections.abc import Callable, Sequence
import math
from typing import Any

from waggle_tasks.agents import receiver
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import episode, verdicts
from waggle_tasks.experiments.studies import (
  case_rows,
  job_progress,
  sweep_cases,
)


def fly(
  report: Callable[[float], None],
  case: sweep_cases.Sample,
  receiver_name: str,
  identity: str,
) -> case_rows.SweepRow:
  """Runs a case; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    receiver_name: The receiver.
    identity: See `identity.of`.

  Returns:
    Its row.
  """
  onlookers = [job_progress.reporter(report)]
  rollout = rollout_lib.run(case.scene, receiver_name, onlookers)
  verdict = evaluator.evaluate(case.scene, rollout)
  return row(case, receiver_name, identity, rollout, verdict)


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
    exposure(
      each, poses[each.observer], **_reading(rollout.events[each.observer])
    )
    for each in verdict.outcomes
  ]
  return whole(
    case, receiver_name, identity, rollout.renderer, rollout.times_s[-1],
    exposures, verdict.passed,
  )  # fmt: skip


def whole(
  case: sweep_cases.Sample,
  receiver_name: str,
  identity: str,
  renderer: str,
  simulated_s: float,
  exposures: Sequence[case_rows.Exposure],
  passed: bool,
) -> case_rows.SweepRow:
  """A case's row, from its exposures."""
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


def exposure(
  outcome: verdicts.Outcome, pose: layouts.Pose, **more: object
) -> case_rows.Exposure:
  """What became of one observer, and where it stood, seen from the performer.

  Args:
    outcome: What became of it.
    pose: Where it stood.
    **more: What else is told of it, or told otherwise.
  """
  x_m, y_m, _ = pose.position_m
  told: dict[str, Any] = {
    **vars(outcome),
    'true_angle_deg': round(math.degrees(math.atan2(x_m, -y_m)), 6),
    'true_distance_m': round(math.hypot(x_m, y_m), 6),
    'right': outcome.decoded == outcome.expected,
    'wrong': outcome.wrong,
    'unauthorised': outcome.unauthorised,
    'stages': tuple(each.partition(':')[0] for each in outcome.failures),
  }
  return case_rows.Exposure(**told | more)


def _reading(events: Sequence[episode.Event]) -> dict[str, Any]:
  """How much it saw, and from where it believes that it saw its message."""
  seen = [event for event in events if isinstance(event, receiver.Event)]
  message = next((event for event in seen if event.message), None)
  return {
    'events': len(seen),
    'seen_angle_deg': message and message.view_angle_deg,
    'seen_distance_m': message and message.distance_m,
  }
