"""Rows of suites that nobody flew."""

from waggle_tasks.experiments.studies import case_rows


def make(**values: object) -> case_rows.SuiteRow:
  """A row of some values; nothing is to be told of the others."""
  usual = {
    'case': 'a', 'group': 'own', 'label': '', 'identity': 'a',
    'receiver': 'klt', 'expecting': values['observers'], 'simulated_s': 100.0,
    'published': None, 'outcomes': (), 'scenario': {},
  }  # fmt: skip
  return case_rows.SuiteRow(**(usual | values))
