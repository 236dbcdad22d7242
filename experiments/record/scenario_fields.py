"""A scenario as a flat table of plain values: what flags and grids speak of.

Fields of a scenario that are values of their own are spread out: the fields of
its groups under their own names, its codebook and units as the numbers that
they are made from.
"""

from collections.abc import Mapping
import dataclasses
import inspect
import math
from typing import Any

from waggle_tasks import scenario
from waggle_tasks.protocol import checks, gestures, payload

Values = Mapping[str, Any]

# Those that are made from other numbers than their fields.
_MADE = ('codebook', 'units')
GROUPS = {
  name: kind for name, kind in scenario.PARTS.items() if name not in _MADE
}
_WORDS = {'true': True, 'false': False}


def defaults() -> dict[str, Any]:
  """Every flat name and its default, those of the dataclasses."""
  out: dict[str, Any] = {}
  for field in dataclasses.fields(scenario.Scenario):
    if field.name in GROUPS:
      out |= dataclasses.asdict(scenario.PARTS[field.name]())
    elif field.name not in _MADE:
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
    'heading_bits': units.heading_bits,
    'distance_bits': units.distance_bits,
  }


def make(values: Values) -> scenario.Scenario:
  """The scenario of a whole table of values.

  Args:
    values: A value for each name of `defaults`.

  Raises:
    WaggleError: if a value breaks a rule of the scenario.
  """
  rest = dict(values)
  codebook = gestures.v_codebook(
    rest.pop('half_width_m'), rest.pop('start_height_m'), rest.pop('gesture_s')
  )
  units = payload.Units(
    math.radians(rest.pop('heading_step_deg')),
    rest.pop('distance_unit_m'),
    rest.pop('heading_bits'),
    rest.pop('distance_bits'),
  )
  groups: dict[str, Any] = {}
  for group, kind in GROUPS.items():
    names = [*inspect.signature(kind).parameters]
    groups[group] = kind(**{name: rest.pop(name) for name in names})
  return scenario.Scenario(**rest, **groups, codebook=codebook, units=units)


def parse(name: str, text: str) -> object:
  """The value that a text gives to a field, of the type of its default.

  Raises:
    ScenarioError: if the name is not known or the text is no such value.
  """
  known, error = defaults(), scenario.ScenarioError
  checks.choice('field', name, [*known], error)
  kind = float if known[name] is None else type(known[name])
  try:
    return _WORDS[text.lower()] if kind is bool else kind(text)
  except (KeyError, ValueError):
    raise error(
      f'`{name}` must be of type {kind.__name__}: got {text!r}'
    ) from None


def flags(values: Values) -> list[str]:
  """The flags that make a scenario: those that differ from their default."""
  usual = defaults()
  return [
    f'--{name}={_text(value)}'
    for name, value in values.items()
    if value != usual[name]
  ]


def _text(value: object) -> str:
  return str(value).lower() if isinstance(value, bool) else str(value)
