"""Where the vehicles of a scenario begin, and where its message leads them."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from waggle_tasks import doors, errors
from waggle_tasks.arenas import bounds, layouts
from waggle_tasks.protocol import checks, flight
from waggle_tasks.tasks import safety

if TYPE_CHECKING:
  from waggle_tasks import scenario

LAYOUTS = ('arc', 'line')
_DETOUR_M = 0.3  # How far those who avoid come from their ways, about.


def poses(scene: 'scenario.Scenario') -> dict[str, layouts.Pose]:
  """See `Scenario.poses`."""
  out = {'performer': layouts.performer_pose()}
  places = layout(scene).poses(scene.observers)
  if len(places) != scene.observers:
    raise errors.ScenarioError(
      f'`layout` must give {scene.observers} poses: got {len(places)}'
    )
  out |= dict(zip(layouts.names(scene.observers), places, strict=True))
  for name, pose in out.items():
    pose = pose.settled(scene.hover_height_m)
    if name != 'performer':
      pose = pose.moved(scene.above_m, math.radians(scene.aside_deg))
    out[name] = pose
    bounds.check_inside(name, pose)
  # Two neighbours can come closer by the jitter of both, along x and y, and by
  # the drift and the errors of both.
  nearer_m = 2 * math.hypot(scene.jitter_m, scene.jitter_m) + scene.wander_m
  layouts.check_spacing(out, safety.MINIMUM_SPACING_M + nearer_m)
  return out


def layout(scene: 'scenario.Scenario') -> layouts.Layout:
  """What places the observers of a scenario.

  Raises:
    ScenarioError: if it is not known, or no layout.
    DoorError: if a package offers its name and it cannot be used.
  """
  named = scene.layout
  if isinstance(named, str) and named not in LAYOUTS:
    named = _offered(named)
  if not isinstance(named, str) and callable(getattr(named, 'poses', None)):
    return named
  checks.choice('layout', named, LAYOUTS, errors.ScenarioError)
  if named == 'arc':
    return layouts.Arc(
      scene.distance_m,
      math.radians(scene.half_span_deg),
      math.radians(scene.bearing_deg),
    )
  return layouts.Line(scene.distance_m, scene.spacing_m)


def _offered(name: str) -> layouts.Layout:
  """A layout from outside: one that a package offers, or what makes one."""
  found: Any = doors.find('layouts', name, LAYOUTS)
  if found is None:
    checks.choice(
      'layout', name, [*LAYOUTS, *doors.names('layouts')], errors.ScenarioError
    )
  made = found() if isinstance(found, type) else found
  if callable(getattr(made, 'poses', None)):
    return made
  raise errors.ScenarioError(
    f'`layout` {name!r} must be a layout with poses(count): its package offers'
    f' {found!r}'
  )


def reach_m(scene: 'scenario.Scenario') -> float:
  """How far from its place a message can lead an observer."""
  out_m = scene.units.reach_m
  if scene.units.meaning == 'place':
    away_m = [math.hypot(*p.position_m[:2]) for p in poses(scene).values()]
    out_m += scene.units.slot_m + max(away_m)
  return out_m + (_DETOUR_M if scene.safety == 'avoid' else 0.0)


def check_slots(scene: 'scenario.Scenario') -> None:
  """Refuses slots about a place that are too near to each other.

  Raises:
    ScenarioError: naming the field, the rule and the value.
    layouts.LayoutError: if one is outside of the room.
  """
  if scene.units.meaning != 'place' or scene.bits:
    return
  displacement_m = scene.message.displacement_m(scene.units)
  slots = {}
  for name, pose in poses(scene).items():
    if name == 'performer':
      continue
    slot_m = flight.goal_m(
      np.array(pose.position_m), displacement_m, scene.agreement
    )
    slots[name] = layouts.Pose(tuple(slot_m), pose.yaw_rad)
    bounds.check_inside(name, slots[name])
  # A slot turns by twice the angle by which jitter moves its vehicle.
  try:
    layouts.check_spacing(slots, scene.kept_m)
  except layouts.LayoutError as error:
    raise errors.ScenarioError(
      f'`slot_m` must be such that slots are {scene.kept_m:.3f} m apart, wider'
      f' or for fewer observers: got {scene.units.slot_m!r} ({error})'
    ) from None
