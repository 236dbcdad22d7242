"""Whether images come often enough for a receiver to follow a dance."""

from collections.abc import Sequence
import functools
import math

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.agents import receivers
from waggle_tasks.protocol import gestures

_MOMENTS = 400  # Of a gesture.


def flaw(
  scene: scenario.Scenario, receiver_name: str, observer: str | None = None
) -> str | None:
  """Why a dance is too fast for a receiver at a scenario's rate, or None.

  Args:
    scene: The scenario.
    receiver_name: As `receivers.make` takes it.
    observer: Who looks on; None for the nearest.
  """
  agreement = scene.agreement
  reach_px = receivers.describe(receiver_name, agreement).reach_px
  if reach_px is None:
    return None
  places_m = {name: pose.position_m for name, pose in scene.poses().items()}
  dancer_m = places_m.pop('performer')
  near_m = [places_m[observer]] if observer else places_m.values()
  distance_m = min(math.dist(dancer_m, place_m) for place_m in near_m)
  fastest_mps = max(_speed_mps(each) for each in agreement.codebook.gestures)
  speed_px_s = fastest_mps * agreement.camera.focal_px / distance_m
  step_px = speed_px_s * agreement.frame_s
  if step_px <= reach_px:
    return None
  return (
    f'at a `rate_hz` of {agreement.rate_hz:g} the dance goes up to'
    f' {step_px:.1f} px from one image to the next, of which {receiver_name}'
    f' can follow {reach_px:g} px; it takes {speed_px_s / reach_px:.3g} Hz'
  )


def note(scenes: Sequence[scenario.Scenario], receiver_name: str) -> str:
  """What people should know before such dances are flown; mostly nothing."""
  sent = [scene for scene in scenes if scene.performance.message is not None]
  flaws = [why for scene in sent if (why := flaw(scene, receiver_name))]
  if not flaws:
    return ''
  return f'{len(flaws)} of {len(scenes)} scenarios may not be read: {flaws[0]}'


@functools.cache
def _speed_mps(gesture: gestures.Gesture) -> float:
  """The fastest that a gesture is."""
  times_s = np.linspace(0.0, gesture.duration_s, _MOMENTS + 1)
  return max(math.hypot(*gesture.motion(time_s)[1]) for time_s in times_s)
