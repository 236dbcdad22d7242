"""Flies one case at several levels of fidelity, and says what came of it."""

from collections.abc import Callable, Sequence
import dataclasses
import time

from waggle_tasks import fidelity, scenario
from waggle_tasks.agents import receiver
from waggle_tasks.experiments.episodes import (
  evaluator,
  ladder_row,
  rendered_tracks,
  track_level,
)
from waggle_tasks.experiments.studies import sweep_cases


def fly(
  report: Callable[[float], None],
  case: sweep_cases.Sample,
  identity: str,
  both: bool,
) -> ladder_row.Row:
  """Renders a case, and makes its tracks too; called in a worker.

  Args:
    report: Told now and then how many seconds are done.
    case: The case, of one observer.
    identity: See `ladder_row.Row`.
    both: Whether tracks are made too.
  """
  begin_s = time.process_time()
  (watched,), renderer = rendered_tracks.watch(
    case.scene, case.receiver, report
  )
  pixels_s = time.process_time() - begin_s
  tracks, tracks_s = None, 0.0
  if both:
    scene = dataclasses.replace(case.scene, fidelity=fidelity.TRACKS)
    begin_s = time.process_time()
    (events,) = track_level.read(scene, case.receiver)
    tracks_s = time.process_time() - begin_s
    tracks, _ = message(events)
  read, read_s = message(watched.events)
  said_s = case.scene.performance.said_s
  return ladder_row.Row(
    identity=identity,
    condition=case.cell['condition'],
    distance_m=case.cell['distance_m'],
    angle_deg=case.cell['bearing_deg'],
    sent=expected(case.scene),
    pixels=read,
    tracks=tracks,
    late_s=None if read_s is None else round(read_s - said_s, 3),
    track=watched.track,
    pixels_s=round(pixels_s, 4),
    tracks_s=round(tracks_s, 4),
    renderer=renderer,
  )


def expected(scene: scenario.Scenario) -> str:
  """What is sent to the first observer; empty for nothing."""
  return evaluator.expected_bits(scene, 1) or ''


def message(
  events: Sequence[receiver.Event],
) -> tuple[str | None, float | None]:
  """The first message of an observer's events, and when it was read."""
  for event in events:
    if event.message is not None:
      return event.message.bits, event.time_s
  return None, None
