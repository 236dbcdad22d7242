"""A scenario as a flat table: names, parsing, and flags that make it again."""

import dataclasses
import re

import pytest

from waggle_tasks import errors, scenario
from waggle_tasks.experiments.record import scenario_fields
from waggle_tasks.protocol import gestures


def test_the_defaults_make_the_default_scenario() -> None:
  made = scenario_fields.make(scenario_fields.defaults())
  assert made == scenario.Scenario()


def test_no_field_of_a_group_hides_another() -> None:
  plain = [
    field.name
    for field in dataclasses.fields(scenario.Scenario)
    if field.name not in scenario.PARTS
  ]
  grouped = [
    field.name
    for kind in scenario_fields.GROUPS.values()
    for field in dataclasses.fields(kind)
  ]
  made = [
    'half_width_m', 'start_height_m', 'gesture_s', 'heading_step_deg',
    'distance_unit_m', 'heading_bits', 'distance_bits',
  ]  # fmt: skip
  names = [*plain, *grouped, *made]
  assert len(set(names)) == len(names)
  assert {*names} == {*scenario_fields.defaults()}


@pytest.mark.parametrize(
  ('name', 'text', 'value'),
  [
    ('distance_m', '1', 1.0),
    ('observers', '3', 3),
    ('shadows', 'true', True),
    ('shadows', 'False', False),
    ('duration_s', '4', 4.0),
    ('payload', '000010', '000010'),
    ('noise_sigma', '5', 5.0),
    ('gap_s', '2.5', 2.5),
    ('half_width_m', '0.2', 0.2),
  ],
)
def test_a_text_becomes_a_value_of_the_fields_own_type(
  name: str, text: str, value: object
) -> None:
  parsed = scenario_fields.parse(name, text)
  assert (parsed, type(parsed)) == (value, type(value))


@pytest.mark.parametrize(
  ('name', 'text', 'error'),
  [
    ('distanc_m', '1', 'Did you mean distance_m'),
    ('distance_m', 'far', "`distance_m` must be of type float: got 'far'"),
    ('distance_m', '', "`distance_m` must be of type float: got ''"),
    ('observers', '1.5', "`observers` must be of type int: got '1.5'"),
    ('shadows', 'yes', "`shadows` must be of type bool: got 'yes'"),
  ],
)
def test_what_is_no_value_is_refused(name: str, text: str, error: str) -> None:
  with pytest.raises(errors.WaggleError, match=re.escape(error)):
    scenario_fields.parse(name, text)


def test_flags_make_the_same_scenario_again() -> None:
  values = scenario_fields.defaults() | {
    'payload': '110011', 'distance_m': 0.1 + 0.7, 'shadows': True, 'seed': 7,
    'duration_s': 12.0, 'noise_sigma': 5.0, 'half_width_m': 0.2,
    'control': 'no_send',
  }  # fmt: skip
  given = scenario_fields.flags(values)
  assert len(given) == 8
  pairs = [flag.removeprefix('--').split('=') for flag in given]
  read = {name: scenario_fields.parse(name, text) for name, text in pairs}
  assert scenario_fields.defaults() | read == values
  made = scenario_fields.make(values)
  assert made.codebook == gestures.v_codebook(half_width_m=0.2)
  assert made.sensor.noise_sigma == 5.0


def test_the_default_scenario_needs_no_flag() -> None:
  assert scenario_fields.flags(scenario_fields.defaults()) == []
