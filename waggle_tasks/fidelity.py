"""How much of an episode is made: its pictures, its tracks, or its words.

`pixels` renders everything. `tracks` has the dance as a camera would see it,
with the errors of a tracker that were measured on pictures, and receivers read
from there on. `symbols` draws whether a frame is read from a table that was
measured on pictures. What was not measured is refused.
"""

import dataclasses
from typing import TYPE_CHECKING

from waggle_tasks import errors
from waggle_tasks.protocol import checks

if TYPE_CHECKING:
  from waggle_tasks import scenario

PIXELS, TRACKS, SYMBOLS = 'pixels', 'tracks', 'symbols'
FIDELITIES = PIXELS, TRACKS, SYMBOLS
# What a scenario without pictures may say of itself; of a group some fields.
_FREE = {
  'control', 'observers', 'layout', 'distance_m', 'half_span_deg',
  'bearing_deg', 'spacing_m', 'payload', 'jitter_m', 'seed', 'black_observer',
  'stop_s', 'duration_s', 'language', 'bits', 'repeat', 'tolerance', 'units',
  'safety', 'camera', 'fidelity',
}  # fmt: skip
_PARTS = {
  'drift': {'performer_hover', 'observer_hover'},
  'sensor': {
    'noise_sigma', 'blackout_s', 'blackout_length_s', 'blackout_every_s',
    'repeated_share', 'freeze_s', 'freeze_length_s', 'late_frames',
    'dropped_share',
  },
}  # fmt: skip


def check(scene: 'scenario.Scenario') -> None:
  """Refuses a scenario that its fidelity knows nothing of.

  Raises:
    ScenarioError: naming the field, the rule and the value.
  """
  checks.choice('fidelity', scene.fidelity, FIDELITIES, errors.ScenarioError)
  if scene.fidelity == PIXELS:
    return
  for field in dataclasses.fields(scene):
    value = getattr(scene, field.name)
    if field.name in _FREE:
      continue
    if type(value) is not type(field.default) or not dataclasses.is_dataclass(
      value
    ):
      _check_usual(scene, field.name, value, field.default)
      continue
    for part in dataclasses.fields(value):
      if part.name not in _PARTS.get(field.name, ()):
        given, usual = (
          getattr(each, part.name) for each in (value, field.default)
        )
        _check_usual(scene, part.name, given, usual)
  drift, hovers = scene.drift, ('none', 'mocap')
  if (
    drift.performer_hover != drift.observer_hover
    or drift.performer_hover not in hovers
  ):
    raise errors.ScenarioError(
      f'`performer_hover` and `observer_hover` must be one of {hovers}, both'
      f' the same, at fidelity {scene.fidelity!r}: got'
      f' {drift.performer_hover!r} and {drift.observer_hover!r}'
    )


def _check_usual(
  scene: 'scenario.Scenario', name: str, value: object, usual: object
) -> None:
  if value != usual:
    raise errors.ScenarioError(
      f'`{name}` must be {usual!r} at fidelity {scene.fidelity!r}, for which'
      f' nothing else was measured: got {value!r}; choose {PIXELS!r}'
    )


def check_rendered(scene: 'scenario.Scenario') -> None:
  """Refuses to make an environment of what has no pictures.

  Raises:
    ScenarioError: naming the field, the rule and the value.
  """
  if scene.fidelity != PIXELS:
    raise errors.ScenarioError(
      f'`fidelity` must be {PIXELS!r} for an environment, which draws pictures:'
      f' got {scene.fidelity!r}, which `waggle sweep` and `waggle link` take'
    )
