"""Scenarios by name, as values that need no simulator."""

import dataclasses
from typing import Any

from waggle_tasks import scenario
from waggle_tasks.protocol import checks, decoys

SCENARIOS = {
  'broadcast': scenario.Scenario(),
  'no_send': scenario.Scenario(control='no_send'),
  'black_input': scenario.Scenario(control='black_input'),
  'interrupted': scenario.Scenario(control='interrupted'),
  **{name: scenario.Scenario(control=name) for name in decoys.DECOYS},
}


def find(name: str, **changes: object) -> scenario.Scenario:
  """The scenario of a name, with some of its fields changed.

  Args:
    name: One of `SCENARIOS`.
    **changes: Fields of `Scenario` and their new values.

  Raises:
    ScenarioError: if the name or a field is not known, with the close ones,
      or if a value breaks a rule.
  """
  error = scenario.ScenarioError
  checks.choice('task', name, [*SCENARIOS], error)
  fields = [field.name for field in dataclasses.fields(scenario.Scenario)]
  values: dict[str, Any] = changes
  for field in values:
    checks.choice('field', field, fields, error)
  return dataclasses.replace(SCENARIOS[name], **values)
