"""Scenarios by name, as values that need no simulator."""

import dataclasses
from typing import Any

from waggle_tasks import doors, scenario
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
    name: One of `SCENARIOS`, or one that a package offers, see `doors`.
    **changes: Fields of `Scenario` and their new values.

  Raises:
    ScenarioError: if the name or a field is not known, with the close ones,
      or if a value breaks a rule.
  """
  error = scenario.ScenarioError
  usual = SCENARIOS[name] if name in SCENARIOS else _offered(name)
  fields = [field.name for field in dataclasses.fields(scenario.Scenario)]
  values: dict[str, Any] = changes
  for field in values:
    checks.choice('field', field, fields, error)
  return dataclasses.replace(usual, **values)


def _offered(name: str) -> scenario.Scenario:
  """A scenario from outside."""
  found = doors.find('scenarios', name, SCENARIOS)
  if isinstance(found, scenario.Scenario):
    return found
  error = scenario.ScenarioError
  if found is not None:
    raise error(
      f'`task` {name!r} must be a Scenario: its package offers {found!r}'
    )
  checks.choice('task', name, [*SCENARIOS, *doors.names('scenarios')], error)
  raise error(f'`task` must be known: got {name!r}')
