"""The paper's evaluation as data: its scenarios and what it published.

Paper, Table 2 (nominal broadcasts), Table 3 (controls) and section 'Controls
and supplemental suite'.
"""

from collections.abc import Mapping, Sequence
import dataclasses
import re
from typing import Any

from waggle_tasks import errors, plain, scenarios
from waggle_tasks import scenario as scenario_lib
from waggle_tasks.protocol import checks

_NAME = re.compile(r'[a-z0-9][a-z0-9_-]{0,63}')


class SuiteError(errors.WaggleError):
  """A suite that cannot be run."""


@dataclasses.dataclass(frozen=True)
class Published:
  """What a case is known to give.

  Attributes:
    correct: How many observers read the message.
    passed: Whether the whole group passed.
  """

  correct: int
  passed: bool


@dataclasses.dataclass(frozen=True)
class Case:
  """One episode of a suite.

  Attributes:
    name: Unique in its suite: lower case letters, digits, '-' and '_'.
    group: What it is counted with, named alike; groups are never pooled.
    label: Its configuration, for tables.
    scene: Its scenario.
    published: What the paper gives for it, or None.
  """

  name: str
  group: str
  label: str
  scene: scenario_lib.Scenario
  published: Published | None = None

  def __post_init__(self) -> None:
    for field in ('name', 'group'):
      value = getattr(self, field)
      if not isinstance(value, str) or not _NAME.fullmatch(value):
        raise SuiteError(
          f'`{field}` of a case must be lower case letters, digits, - and _,'
          f' 64 at most: got {value!r}'
        )
    if not isinstance(self.label, str):
      raise SuiteError(f'`label` of a case must be text: got {self.label!r}')


# name, label, correct, passed, changes
_STANDARD: tuple[tuple[str, str, int, bool, dict[str, Any]], ...] = (
  ('default', 'Default, forward', 3, True, {}),
  ('heading-45', '000110, heading 45 deg', 3, True, {'payload': '000110'}),
  ('heading-90', '001010, heading 90 deg', 3, True, {'payload': '001010'}),
  ('backward', '100010, backward', 3, True, {'payload': '100010'}),
  ('one-observer', 'One observer, front view', 1, True, {'observers': 1}),
  ('two-observers', 'Two observers', 2, True, {'observers': 2}),
  ('span-35', 'Half-span 35 deg', 4, True,
   {'observers': 4, 'half_span_deg': 35.0}),
  ('span-40', 'Half-span 40 deg, forward', 3, False,
   {'observers': 5, 'half_span_deg': 40.0}),
  ('line', 'Line layout', 3, True, {'layout': 'line'}),
  ('distance-1.0', 'Distance 1.0 m', 0, False, {'distance_m': 1.0}),
  ('distance-1.6', 'Distance 1.6 m', 3, True, {'distance_m': 1.6}),
  ('span-15', 'Half-span 15 deg', 3, True, {'half_span_deg': 15.0}),
  ('span-45', 'Half-span 45 deg', 1, False, {'half_span_deg': 45.0}),
  ('jitter-0', 'j = 0.01, seed 0', 3, True, {'jitter_m': 0.01}),
  ('jitter-1', 'j = 0.01, seed 1', 3, True, {'jitter_m': 0.01, 'seed': 1}),
  ('line-jitter', 'Line, j = 0.01, seed 1, 000110', 3, True,
   {'layout': 'line', 'jitter_m': 0.01, 'seed': 1, 'payload': '000110'}),
  ('span-40-backward', 'Half-span 40 deg, 100010', 3, False,
   {'observers': 5, 'half_span_deg': 40.0, 'payload': '100010'}),
)  # fmt: skip
_SUPPLEMENTAL: tuple[tuple[str, str, int, bool, dict[str, Any]], ...] = (
  ('four-forward', 'Default geometry, forward', 4, True, {'observers': 4}),
  ('five-forward', 'Default geometry, forward', 5, True, {'observers': 5}),
  ('five-backward', 'Default geometry, 100010', 5, True,
   {'observers': 5, 'payload': '100010'}),
)  # fmt: skip
_CONTROLS = (
  ('no-send', 'Static, no send, 10 s', 0, 'no_send'),
  ('black-input', 'Black input at observer 2', 2, 'black_input'),
  ('interrupted', 'Transmission stopped at 26 s', 0, 'interrupted'),
)


def _cases() -> dict[str, tuple[Case, ...]]:
  suites = {
    group: tuple(
      Case(
        name.replace('.', '-'),
        group,
        label,
        scenarios.find('broadcast', **changes),
        Published(correct, passed),
      )
      for name, label, correct, passed, changes in table
    )
    for group, table in (
      ('standard', _STANDARD),
      ('supplemental', _SUPPLEMENTAL),
    )
  }
  suites['controls'] = tuple(
    Case(
      name, 'controls', label, scenarios.find(task), Published(correct, True)
    )
    for name, label, correct, task in _CONTROLS
  )  # fmt: skip
  suites['paper'] = tuple(case for cases in suites.values() for case in cases)
  return suites


SUITES = _cases()


def find(name: str) -> tuple[Case, ...]:
  """The cases of a named suite.

  Raises:
    SuiteError: if the name is not known, with the close ones.
  """
  checks.choice('suite', name, [*SUITES], SuiteError)
  return SUITES[name]


def from_rows(rows: Sequence[Mapping[str, Any]]) -> tuple[Case, ...]:
  """The cases of a user's own suite.

  Args:
    rows: For each case a `name`, optionally a `task` of `scenarios.SCENARIOS`
      ('broadcast' by default), a `group` ('own') and a `label`, and any
      fields of `Scenario` that differ from the task's.

  Raises:
    WaggleError: if a field is not known, a value breaks a rule, a name comes
      twice or there is no case.
  """
  cases = []
  for number, row in enumerate(rows, 1):
    if not isinstance(row, Mapping) or 'name' not in row:
      raise SuiteError(
        f'case {number} must be a table with a `name`: got {row!r}'
      )
    changes = dict(row)
    name = changes.pop('name')
    task = changes.pop('task', 'broadcast')
    group = changes.pop('group', 'own')
    label = changes.pop('label', '')
    text = ', '.join(f'{key} = {value}' for key, value in changes.items())
    try:
      eye = changes.get('eye')
      if isinstance(eye, str):  # A name, for all that it sets.
        del changes['eye']
      values = plain.fields(scenario_lib.Scenario, changes)
      values |= {'eye': eye} if isinstance(eye, str) else {}
      scene = scenarios.find(task, **values)
      cases.append(Case(name, group, label or text or task, scene))
    except errors.WaggleError as error:
      raise SuiteError(f'case {number} ({name}): {error}') from None
  names = [case.name for case in cases]
  if not names or len(set(names)) < len(names):
    raise SuiteError(
      f'`name` of each case must be its own, and one case the least: {names}'
    )
  return tuple(cases)
