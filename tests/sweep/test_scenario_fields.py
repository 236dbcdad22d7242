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


def test_every_number_of_a_scenario_has_a_name_and_its_sentence() -> None:
  names = {
    (field.part, field.name): field.text
    for field in scenario_fields.table().values()
  }
  assert all(text.endswith('.') and len(text) > 10 for text in names.values())
  for field in dataclasses.fields(scenario.Scenario):
    part, owner = field.name, type(field.default)
    if owner is gestures.Codebook:
      assert (part, 'half_width_m') in names
    elif dataclasses.is_dataclass(owner):
      assert {(part, f.name) for f in dataclasses.fields(owner)} <= {*names}
    else:
      assert ('', part) in names


def test_a_sentence_lists_the_choices_that_its_docstring_names() -> None:
  table = scenario_fields.table()
  assert 'one of honeycomb, plain, clutter' in table['floor'].text
  assert 'full' in table['camera'].text
  assert all(each in table['control'].text for each in scenario.CONTROLS)


def test_two_values_of_one_name_are_refused_naming_both_owners() -> None:
  @dataclasses.dataclass(frozen=True)
  class Gust:
    """A group that has a name of the scenario's own."""

    stop_s: float = 1.0

  @dataclasses.dataclass(frozen=True)
  class Rest:
    """A group that has a name of another group."""

    gap_s: float = 1.0

  for name, group in (('stop_s', Gust()), ('gap_s', Rest())):
    kind = dataclasses.make_dataclass(
      'Windy', [('gust', type(group), group)], bases=(scenario.Scenario,),
      frozen=True,
    )  # fmt: skip
    owner = type(group).__name__
    error = f'`{name}` must be the name of one value: \\w+ and {owner} have it'
    with pytest.raises(errors.WaggleError, match=error):
      scenario_fields.table(kind)


def test_a_value_that_is_changed_leaves_all_others() -> None:
  scene = scenario_fields.make({'noise_sigma': 5.0, 'gap_s': 2.5, 'seed': 3})
  made = scenario_fields.changed(scene, {'photons': 50.0, 'gesture_s': 8.0})
  assert (made.sensor.noise_sigma, made.sensor.photons) == (5.0, 50.0)
  assert (made.pauses.gap_s, made.seed) == (2.5, 3)
  assert made.codebook == gestures.v_codebook(duration_s=8.0)


def test_a_number_of_gestures_that_are_no_vs_is_refused() -> None:
  usual = gestures.v_codebook().gestures
  own = gestures.Codebook(
    tuple(
      dataclasses.replace(each, corners_m=((0, 0), (0.2, 0.1), (0, 0)))
      if each.symbol == 'END'
      else each
      for each in usual
    )
  )
  scene = scenario.Scenario(codebook=own)
  error = '`gesture_s` must not be given for gestures that are no Vs'
  with pytest.raises(errors.WaggleError, match=error):
    scenario_fields.changed(scene, {'gesture_s': 8.0})


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
