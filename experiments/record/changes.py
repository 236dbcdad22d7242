"""Every choice of a scenario that is not the usual one, in words."""

from collections.abc import Container, Mapping
import dataclasses
import json
import math
from typing import Any

from waggle_tasks import scenario
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import gestures
from waggle_tasks.protocol.symbols import Symbol

Fields = Mapping[str, Any]


def of(scene: scenario.Scenario, told: Container[str] = ()) -> list[str]:
  """Such as ['noise_sigma=5', 'bystanders=2'], by the names of flags.

  Args:
    scene: The scenario.
    told: Names of those that need not be said.
  """
  return among(_plain(scene), told)


def among(fields: Fields, told: Container[str] = ()) -> list[str]:
  """The same, of the fields of a scenario as config.json has them."""
  usual = _plain(scenario.Scenario())
  out: dict[str, Any] = {}
  for name, value in fields.items():
    if value == usual.get(name):
      continue
    if name == 'codebook':
      out |= _codebook(value)
    elif name == 'units':
      out |= _units(value, usual[name])
    elif name in scenario_fields.GROUPS:
      out |= {k: v for k, v in value.items() if v != usual[name].get(k)}
    elif isinstance(value, (str, int, float)):
      out[name] = value
    else:  # A layout of one's own.
      out[name] = next(iter(value), 'own') if value else 'none'
  return [f'{n}={_text(v)}' for n, v in out.items() if n not in told]


def _text(value: object) -> str:
  if isinstance(value, bool):
    return str(value).lower()
  return f'{value:g}' if isinstance(value, float) else str(value)


def _plain(scene: scenario.Scenario) -> dict[str, Any]:
  """Its fields as JSON holds them."""
  fields = dataclasses.asdict(scene)
  if not isinstance(scene.layout, str):
    fields['layout'] = {type(scene.layout).__name__: {}}
  return json.loads(json.dumps(fields))


def _units(value: Fields, usual: Fields) -> dict[str, Any]:
  out = {k: v for k, v in value.items() if v != usual[k]}
  if 'heading_step_rad' in out:
    out['heading_step_deg'] = math.degrees(out.pop('heading_step_rad'))
  return out


def _codebook(value: Fields) -> dict[str, Any]:
  """The numbers that make a codebook of Vs, or that it is another."""
  made = {each['symbol']: each for each in value['gestures']}
  width_m = max(x for x, _ in made[Symbol.END]['corners_m'])
  height_m = max(z for _, z in made[Symbol.START]['corners_m'])
  sizes = width_m, height_m, made[Symbol.START]['duration_s']
  same = gestures.v_codebook(*sizes)
  if json.loads(json.dumps(dataclasses.asdict(same))) != value:
    return {'codebook': 'own'}
  names = 'half_width_m', 'start_height_m', 'gesture_s'
  usual = scenario_fields.defaults()
  return {
    name: size
    for name, size in zip(names, sizes, strict=True)
    if size != usual[name]
  }
