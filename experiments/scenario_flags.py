"""Flags for every choice of a scenario, and the scenario that they make."""

import dataclasses
import inspect
import math

from absl import flags

from waggle_tasks import appearance, scenario
from waggle_tasks.entities import observer
from waggle_tasks.protocol import gestures, payload, timing

# Flags defined here belong to the launcher that asks for them.
flags.disclaim_key_flags()

_HELP = {
  'control': 'What is sent, and to whom.',
  'observers': 'How many observers.',
  'layout': 'Where observers stand.',
  'distance_m': 'Radius of the arc, or distance of the line, in m.',
  'half_span_deg': 'Angle from the middle of the arc to its end, in degrees.',
  'spacing_m': 'Distance between neighbours in a line, in m.',
  'payload': 'Six bits: one of direction, three of heading, two of distance.',
  'jitter_m': 'Bound of the initial x and y offset of each vehicle, in m.',
  'seed': 'Seed of the environment.',
  'black_observer': 'Who sees black images with --control=black_input.',
  'stop_s': 'When sending stops with --control=interrupted, in s.',
  'duration_s': 'Longest episode, in s; unset, what the control needs.',
  'camera': 'How images are rendered; the picture is the same.',
  'eye_offset_m': "How far an eye is ahead of its vehicle's centre, in m.",
  'floor': 'The floor of the room.',
  'brightness': 'Brightness of every light, 1 as designed.',
  'shadows': 'Whether lights cast shadows; slower.',
  'initial_hover_s': 'Stillness before START, in s.',
  'settle_s': 'Stillness after a gesture, in s.',
  'gap_s': 'Hover gap between gestures, in s.',
  'lead_in_s': 'Stillness before a gesture, in s.',
  'half_width_m': 'Half width, and height, of a V, in m.',
  'start_height_m': 'How far START climbs, in m.',
  'gesture_s': 'Time that a gesture takes, in s.',
  'heading_step_deg': 'Angle of one heading count, in degrees.',
  'distance_unit_m': 'Length of one distance count, in m.',
}
_CHOICES = {
  'control': scenario.CONTROLS,
  'layout': scenario.LAYOUTS,
  'camera': observer.CAMERAS,
  'floor': appearance.FLOORS,
}
_GROUPS = {'pauses': timing.Timing, 'appearance': appearance.Appearance}


def _defaults() -> dict[str, object]:
  """Every flag and its default, those of the dataclasses."""
  out = {}
  for field in dataclasses.fields(scenario.Scenario):
    if field.name in _GROUPS:
      out |= dataclasses.asdict(field.default)
    elif field.name not in ('codebook', 'units'):
      out[field.name] = field.default
  signature = inspect.signature(gestures.v_codebook)
  gesture = {n: p.default for n, p in signature.parameters.items()}
  gesture['gesture_s'] = gesture.pop('duration_s')
  units = payload.Units()
  return {
    **out,
    **gesture,
    'heading_step_deg': math.degrees(units.heading_step_rad),
    'distance_unit_m': units.distance_unit_m,
  }


def define() -> None:
  """Defines the flags for the launcher that calls this."""
  for name, default in _defaults().items():
    text = _HELP[name]
    if name in _CHOICES:
      text = f'{text} One of {", ".join(_CHOICES[name])}.'
    match default:
      case bool():
        flags.DEFINE_boolean(name, default, text)
      case str():
        flags.DEFINE_string(name, default, text)
      case int():
        flags.DEFINE_integer(name, default, text)
      case _:
        flags.DEFINE_float(name, default, text)


def read() -> scenario.Scenario:
  """The scenario that the flags make.

  Raises:
    WaggleError: if a value breaks a rule of the scenario.
  """
  values = {name: flags.FLAGS[name].value for name in _defaults()}
  codebook = gestures.v_codebook(
    values.pop('half_width_m'),
    values.pop('start_height_m'),
    values.pop('gesture_s'),
  )
  units = payload.Units(
    math.radians(values.pop('heading_step_deg')), values.pop('distance_unit_m')
  )
  groups = {}
  for group, kind in _GROUPS.items():
    names = [field.name for field in dataclasses.fields(kind)]
    groups[group] = kind(**{name: values.pop(name) for name in names})
  return scenario.Scenario(**values, **groups, codebook=codebook, units=units)
