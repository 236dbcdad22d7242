"""What the values of a scenario must be, each alone and beside the others."""

from collections.abc import Sequence
import dataclasses
from typing import TYPE_CHECKING

from waggle_tasks import doors, errors, fidelity, placement, spoken
from waggle_tasks.arenas import bounds
from waggle_tasks.entities import optics
from waggle_tasks.protocol import checks, controls, limits
from waggle_tasks.protocol import payload as payload_lib
from waggle_tasks.tasks import estimators, safety

if TYPE_CHECKING:
  from waggle_tasks import scenario

_MOST_OBSERVERS = 64
_SIDE_PX = (64, 2048)  # Of an image.
_CLEAR_M = 0.1  # From the highest point of a gesture to the ceiling.
_CHOICES = {
  'control': controls.CONTROLS,
  'dynamics': limits.DYNAMICS,
  'estimator': estimators.ESTIMATORS,
  'safety': safety.SAFETIES,
  'camera': optics.CAMERAS,
}


def check(scene: 'scenario.Scenario') -> None:
  """Refuses a value that breaks a rule, and keeps numbers as plain ones.

  Raises:
    WaggleError: naming the field, the rule, the value and the choices.
  """
  for each in dataclasses.fields(scene):
    value, usual = getattr(scene, each.name), each.default
    if dataclasses.is_dataclass(usual) and type(value) is not type(usual):
      raise errors.ScenarioError(
        f'`{each.name}` must be a {type(each.default).__name__}: got {value!r}'
      )
  for field, choices in _CHOICES.items():
    _check_choice(field, getattr(scene, field), choices)
  _check_dynamics(scene)
  _check_numbers(scene)
  limits.check_motions(scene.agreement.motions, limits.LIMITS[scene.dynamics])
  _check_height(scene)
  payload_lib.Payload.from_bits(scene.payload, scene.units)
  scene.surroundings.check(scene.poses(), placement.reach_m(scene))
  placement.check_slots(scene)
  fidelity.check(scene)


def _check_choice(field: str, value: str, choices: Sequence[str]) -> None:
  """Refuses what is none of the choices, also where a package offers it."""
  try:
    checks.choice(field, value, choices, errors.ScenarioError)
  except errors.ScenarioError as error:
    more = doors.closed(field, str(value)) if field == 'dynamics' else ''
    raise errors.ScenarioError(f'{error}{more}') from None


def _check_numbers(scene: 'scenario.Scenario') -> None:
  """Refuses numbers out of range, and settles those that are in it."""
  counts = {
    'observers': (1, _MOST_OBSERVERS),
    'seed': (0, 2**32 - 1),
    'camera_width_px': _SIDE_PX,
    'camera_height_px': _SIDE_PX,
    'camera_fovy_deg': (10.0, 120.0),
    'repeat': (1, 100),
  }
  checks.settle_numbers(scene, counts, errors.ScenarioError)
  spoken.check(scene)
  agreed = scene.agreement  # Which checks itself.
  for name in ('rate_hz', 'hover_height_m'):
    checks.settle(scene, name, getattr(agreed, name))
  _check_exposure(scene, agreed.frame_s)
  ranges = {
    'black_observer': (1, scene.observers),
    'distance_m': (0.2, 4.0),
    'half_span_deg': (0.0, 180.0),
    'bearing_deg': (-180.0, 180.0),
    'spacing_m': (0.0, 4.0),
    'aside_deg': (-30.0, 30.0),
    'above_m': (-1.0, 1.0),
    'jitter_m': (0.0, 0.1),
    'stop_s': (0.0, 600.0),
    'eye_offset_m': (-0.1, 0.1),
    'duration_s': (agreed.frame_s, 600.0),
  }
  if scene.control != 'black_input':
    del ranges['black_observer']
  if scene.duration_s is None:
    del ranges['duration_s']
  checks.settle_numbers(scene, ranges, errors.ScenarioError)


def _check_dynamics(scene: 'scenario.Scenario') -> None:
  """Refuses what ideal forces, which are told the truth, do not feel."""
  asked = {
    'estimator': scene.estimator != 'none',
    'wind_mps': bool(scene.air.wind_mps),
    'downwash': scene.air.downwash,
  }
  for field, is_asked in asked.items():
    if is_asked and scene.dynamics != 'rotors':
      raise errors.ScenarioError(
        f'`{field}` must not be given with `dynamics` {scene.dynamics!r}: no'
        " air is felt and the truth is known there; choose 'rotors'"
      )


def _check_exposure(scene: 'scenario.Scenario', frame_s: float) -> None:
  """Refuses one that takes longer than from one image to the next."""
  if scene.sensor.exposure_s > frame_s:
    raise errors.ScenarioError(
      f'`exposure_s` must be at most {frame_s:g} s, the time from one image to'
      f' the next at {scene.rate_hz:g} Hz: got {scene.sensor.exposure_s!r}'
    )


def _check_height(scene: 'scenario.Scenario') -> None:
  """Refuses gestures that leave the room."""
  most_m = bounds.HEIGHT_M - _CLEAR_M - scene.agreement.highest_m
  if scene.hover_height_m > most_m:
    raise errors.ScenarioError(
      f'`hover_height_m` must be at most {most_m:g}, so that gestures stay'
      f' {_CLEAR_M:g} m under the ceiling: got {scene.hover_height_m!r}'
    )
