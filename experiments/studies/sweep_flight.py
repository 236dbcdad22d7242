"""Flies one case of a sweep and keeps a line of it."""

from collections.abc import Callable, Sequence
import math
from typing import Any

from waggle_tasks import plain
from waggle_tasks.agents import receiver
from waggle_tasks.arenas import layouts
from waggle_tasks.experiments.episodes import evaluator
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import encoding, episode, verdicts
from waggle_tasks.experiments.studies import job_progress, sweep_cases


def fly(
  report: Callable[[float], None],
  case: sweep_cases.Case,
  receiver_name: str,
  identity: str,
) -> dict[str, Any]:
  """Runs a case; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case.
    receiver_name: The receiver.
    identity: See `identity.of`.

  Returns:
    The case's line of results.jsonl.
  """
  watchers = [job_progress.reporter(report)]
  rollout = rollout_lib.run(case.scene, receiver_name, watchers)
  verdict = evaluator.evaluate(case.scene, rollout)
  return row(case, receiver_name, identity, rollout, verdict)


def row(
  case: sweep_cases.Case,
  receiver_name: str,
  identity: str,
  rollout: episode.Rollout,
  verdict: verdicts.Verdict,
) -> dict[str, Any]:
  """A case's line of results.jsonl, from its episode."""
  poses = case.scene.poses()
  whole = {
    **head(case),
    'identity': identity,
    'receiver': receiver_name,
    'renderer': rollout.renderer,
    'simulated_s': round(float(rollout.times_s[-1]), 2),
    'passed': verdict.passed,
    'outcomes': [
      {
        **_exposure(each, poses[each.observer]),
        **_reading(rollout.events[each.observer]),
      }
      for each in verdict.outcomes
    ],
    'scenario': case.values,
  }
  return encoding.stamped(whole)


def head(case: sweep_cases.Case) -> dict[str, Any]:
  """The beginning of a case's line: its place in its sweep."""
  return {'case': case.name, 'cell': dict(case.cell), 'repeat': case.repeat}


def _exposure(outcome: verdicts.Outcome, pose: layouts.Pose) -> dict[str, Any]:
  """What became of one observer, and where it stood."""
  stages = [failure.partition(':')[0] for failure in outcome.failures]
  return {
    **plain.to_plain(outcome),
    **place(pose),
    'right': outcome.decoded == outcome.expected,
    'wrong': outcome.wrong,
    'unauthorised': outcome.unauthorised,
    'stages': stages,
  }


def place(pose: layouts.Pose) -> dict[str, Any]:
  """Where an observer stands, seen from the performer."""
  x_m, y_m, _ = pose.position_m
  return {
    'true_angle_deg': round(math.degrees(math.atan2(x_m, -y_m)), 6),
    'true_distance_m': round(math.hypot(x_m, y_m), 6),
  }


def _reading(events: Sequence[episode.Event]) -> dict[str, Any]:
  """How much it saw, and from where it believes that it saw its message."""
  seen = [event for event in events if isinstance(event, receiver.Event)]
  message = next((event for event in seen if event.message), None)
  return {
    'events': len(seen),
    'seen_angle_deg': message and message.view_angle_deg,
    'seen_distance_m': message and message.distance_m,
  }
