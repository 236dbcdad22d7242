"""Every choice of a scenario that is not the usual one, in words."""

from collections.abc import Container, Mapping
from typing import Any

from waggle_tasks import eyes, plain, scenario
from waggle_tasks.experiments.record import eye_fields, scenario_fields


def of(scene: scenario.Scenario, told: Container[str] = ()) -> list[str]:
  """Such as ['noise_sigma=5', 'bystanders=2'], by the names of flags.

  Args:
    scene: The scenario.
    told: Names of those that need not be said.
  """
  return among(plain.to_plain(scene), told)


def among(fields: Mapping[str, Any], told: Container[str] = ()) -> list[str]:
  """The same, of the fields of a scenario as config.json has them."""
  values = scenario_fields.flat(fields)
  usual = scenario_fields.defaults() | eye_fields.of(values)
  usual['eye'] = eyes.IDEAL
  return [
    f'{name}={_text(value)}'
    for name, value in values.items()
    if name not in told and value != usual.get(name)
  ]


def _text(value: object) -> str:
  if isinstance(value, bool):
    return str(value).lower()
  if isinstance(value, str) and value.startswith('{'):
    return 'own'  # A value of its own has no room here.
  return f'{value:g}' if isinstance(value, float) else str(value)
