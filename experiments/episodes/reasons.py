"""Why a message was not read: what its reader can say, and what truth can.

A receiver knows only what it saw. Whether the dancer was where it should have
been, and the target where its reader looked, is known here.
"""

import math

import numpy as np

from waggle_tasks import scenario
from waggle_tasks.experiments.episodes import rollout as rollout_lib
from waggle_tasks.experiments.record import nulls, reach
from waggle_tasks.experiments.record import traces as traces_lib
from waggle_tasks.protocol import agreement as agreement_lib
from waggle_tasks.protocol import camera, levels, schedule

# What can be flown is flown within 4 mm, and by rotors within 30 mm.
_OFF_PATH_M = {'ideal': 0.02, 'rotors': 0.03}
# A track may wander about the target, which is wider than this when it is near;
# all in pixels of the paper's camera.
_OFF_TARGET_PX = 40.0
# Half the square in which the paper's receiver finds it, and less.
_ASIDE_PX = 20.0
# Receivers pass over shorter losses.
_LOSS_S = 0.4
# A pause that has less to spare may have been too short.
_SPARE_S = 0.2
# Gestures are flown in a plane, which is a line from the side.
_WIDEST_DEG, _ROUNDING_DEG = 85.0, 1e-6


def find(
  scene: scenario.Scenario, rollout: rollout_lib.Rollout, name: str
) -> list[str]:
  """What stood in the way of reading, as far as truth can tell.

  Args:
    scene: The scenario.
    rollout: Its episode.
    name: Who did not read.

  Returns:
    Failures: a dancer beside its path, pauses that are too short, images that
    come too seldom, a view from behind, and a target that was not found, lost,
    or not what was followed.
  """
  out = _dance(scene, rollout)
  if rollout.receiver and (
    why := nulls.flaw(scene, rollout.receiver, _SPARE_S)
  ):
    out.append(f'pause: {why}')
  if rollout.receiver and (why := reach.flaw(scene, rollout.receiver, name)):
    out.append(f'rate: {why}')
  out += _view(scene, name)
  trace = rollout.traces.get(name)
  if trace is not None and len(trace.times_s) and name in rollout.targets_px:
    agreement = scene.agreement
    frames = np.rint(trace.times_s * agreement.rate_hz).astype(int)
    places_px = rollout.targets_px[name]
    frames = np.clip(frames, 0, len(places_px) - 1)
    out += _sight(trace, places_px[frames], agreement)
  return out


def _dance(scene: scenario.Scenario, rollout: rollout_lib.Rollout) -> list[str]:
  """Whether the performer was beside its path."""
  flown_m = rollout.steady_m('performer')
  yaw_rad = scene.poses()['performer'].yaw_rad
  performance = scene.performance
  dance, until_s = performance.schedule, performance.end_s
  times_s = rollout.times_s[rollout.times_s <= until_s]
  wanted_m = np.array(
    [
      flown_m[0] + offset @ schedule.axes(yaw_rad)[: len(offset)]
      for offset in (dance.motion(time_s)[0] for time_s in times_s)
    ]
  )
  off_m = np.linalg.norm(flown_m[: len(times_s)] - wanted_m, axis=1)
  most_m = _OFF_PATH_M[scene.dynamics]
  if off_m.max(initial=0.0) <= most_m:
    return []
  first_s = times_s[(off_m > most_m).argmax()]
  return [
    f'dance: the performer was up to {off_m.max() * 1e3:.0f} mm off its path,'
    f' first at {first_s:.2f} s'
  ]


def _view(scene: scenario.Scenario, name: str) -> list[str]:
  """Whether a dance was watched from where its plane is not to be seen."""
  language = scene.agreement.language
  if language and isinstance(language.alphabet, levels.Levels):
    return []  # Which look the same from all around.
  x_m, y_m, _ = scene.poses()[name].position_m
  angle_deg = abs(math.degrees(math.atan2(x_m, -y_m)))
  if angle_deg <= _WIDEST_DEG + _ROUNDING_DEG:
    return []
  where = 'from behind' if angle_deg > 180 - _WIDEST_DEG else 'edge-on'
  return [
    f'view: {angle_deg:.0f} degrees from the front, {where}; gestures are read'
    f' up to {_WIDEST_DEG:.0f} degrees'
  ]


def _sight(
  trace: traces_lib.Trace,
  target_px: np.ndarray,
  agreement: agreement_lib.Agreement,
) -> list[str]:
  """Whether a receiver followed the target, which was at (T, 2)."""
  times_s, valid = trace.times_s, trace.valid
  seen_with = agreement.camera
  if not valid.any():
    return [
      f'sight: no target was found; it was {_place(target_px[0], seen_with)}'
      f'{_aside(target_px[0], seen_with)}'
    ]
  out = []
  outside = ~np.array([_is_inside(each, seen_with) for each in target_px])
  if outside.any():
    first = int(outside.argmax())
    out.append(
      f'sight: the target was {_place(target_px[first], seen_with)}, first at'
      f' {times_s[first]:.2f} s'
    )
  begin = int(valid.argmax())
  losses = _stretches(times_s[begin:], ~valid[begin:], agreement.frame_s)
  if losses:
    since_s, length_s = max(losses, key=lambda each: each[1])
    place = _place(target_px[np.searchsorted(times_s, since_s)], seen_with)
    often = f' {len(losses)} times, longest' if len(losses) > 1 else ''
    out.append(
      f'sight: the target was lost{often} at {since_s:.2f} s for'
      f' {length_s:.2f} s, when it was {place}'
    )
  off_px = np.linalg.norm(trace.centre_px - target_px, axis=1)
  astray = valid & ~(off_px <= _OFF_TARGET_PX * seen_with.zoom)
  if astray.any():
    first = int(astray.argmax())
    x_px, y_px = trace.centre_px[first]
    out.append(
      f'sight: followed {x_px:.0f}, {y_px:.0f} px at {times_s[first]:.2f} s,'
      f' when the target was {_place(target_px[first], seen_with)}'
    )
  return out


def _stretches(
  times_s: np.ndarray, holds: np.ndarray, frame_s: float
) -> list[tuple[float, float]]:
  """Begin and length of each stretch of time that is long enough to count."""
  edges = np.flatnonzero(np.diff(np.pad(holds.astype(int), 1)))
  ends_s = np.append(times_s, times_s[-1] + frame_s)
  found = [
    (float(ends_s[a]), float(ends_s[b] - ends_s[a]))
    for a, b in edges.reshape(-1, 2)
  ]
  return [each for each in found if each[1] > _LOSS_S + 1e-6]


def _is_inside(target_px: np.ndarray, seen_with: camera.Camera) -> bool:
  """Whether a place, (2,), is in the picture."""
  return bool((target_px >= 0).all() and (target_px < seen_with.size).all())


def _place(target_px: np.ndarray, seen_with: camera.Camera) -> str:
  """A place in a picture, in words."""
  if np.isnan(target_px).any():
    return 'behind the camera'
  (x_px, y_px), (width_px, height_px) = target_px, seen_with.size
  outside = (
    '' if _is_inside(target_px, seen_with) else 'outside of the picture, '
  )
  # Rounded to an int, as a float can be -0.
  place = f'at {round(x_px)}, {round(y_px)} px of {width_px} x {height_px}'
  return f'{outside}{place}'


def _aside(target_px: np.ndarray, seen_with: camera.Camera) -> str:
  """A word where a place, (2,), is not where a target is looked for."""
  off_px = np.linalg.norm(target_px - np.array(seen_with.size) / 2)
  if off_px < _ASIDE_PX * seen_with.zoom:
    return ''
  return ', and is looked for around the middle'
