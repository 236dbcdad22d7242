"""When a receiver had the dancer: what it tells beside what is true."""

import math

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.entities import airframe
from waggle_tasks.experiments.record import episode, traces

# It holds the target when its track is so near to it for so long.
HELD_S = 0.4
# How wide a Crazyflie is: its motors are at the corners of a square.
_SPAN_M = math.sqrt(2) * airframe.ARM_M + 2 * airframe.ROTOR_RADIUS_M
_LEAST_PX = 8.0


def acquired_s(
  scene: scenario.Scenario, rollout: episode.Rollout, name: str
) -> float | None:
  """How long after the first motion an observer held the dancer.

  It holds it from when its track is valid and within the width that the
  vehicle has in its picture, 8 pixels at least, and stays so for 0.4 s.

  Args:
    scene: The scenario.
    rollout: Its episode.
    name: The observer.

  Returns:
    Seconds, 0 where it was held before; None where nothing moved, where it
    never was, or where the receiver does not tell of a track.
  """
  slots = scene.performance.schedule.slots
  trace = rollout.traces[name]
  if not slots or not len(trace.times_s):
    return None
  begin_s = slots[0].begin_s
  held = _held(scene, rollout, name, trace)
  frames = max(1, round(HELD_S / scene.agreement.frame_s))
  kept = np.convolve(held, np.ones(frames), 'valid') == frames
  after = kept & (trace.times_s[: len(kept)] >= begin_s)
  if not after.any():
    return None
  return round(float(trace.times_s[np.argmax(after)]) - begin_s, 3)


def _held(
  scene: scenario.Scenario,
  rollout: episode.Rollout,
  name: str,
  trace: traces.Trace,
) -> np.ndarray:
  """(T,) bool, whether the track is on the dancer in each image."""
  agreed = scene.agreement
  frame = np.rint(trace.times_s / agreed.frame_s).astype(int)
  frame = np.clip(frame, 0, len(rollout.times_s) - 1)
  apart_m = np.linalg.norm(
    rollout.positions_m[name][frame] - rollout.positions_m['performer'][frame],
    axis=1,
  )
  near_px = np.maximum(_LEAST_PX, agreed.camera.focal_px * _SPAN_M / apart_m)
  off_px = np.linalg.norm(
    trace.centre_px - rollout.targets_px[name][frame], axis=1
  )
  return trace.valid & (off_px <= near_px)
